#include "solver/scene/hertz_pressure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using std::numbers::pi;

/// Sums of some thousands of numbers round by less.
constexpr double kHertzRounding = 1e-12;

TEST(HertzContact, OfEqualRadiiIsTheSpheres) {
  for (const double radius : {1e-3, 0.018, 5.0}) {
    const HertzContact contact = hertz_contact(1000.0, radius, radius, 1.1e11);
    const double a = std::cbrt(0.75 * 1000.0 * radius / 1.1e11);
    EXPECT_NEAR(contact.semi_axis_1 / a, 1.0, 1e-14);
    EXPECT_NEAR(contact.semi_axis_2 / a, 1.0, 1e-14);
    EXPECT_NEAR(contact.peak_pressure / (1500.0 / (pi * a * a)), 1.0, 1e-14);
  }
  const double modulus = effective_modulus(paper_scene(1, 0.0));
  const HertzContact paper = hertz_contact(paper::kLoad, paper::kRadius, paper::kRadius, modulus);
  EXPECT_NEAR(paper.semi_axis_1 / paper::kContactRadius, 1.0, 1e-14);
  EXPECT_NEAR(paper.peak_pressure / paper::kPeakPressure, 1.0, 1e-14);
}

TEST(HertzAverages, SumToTheLoad) {
  const HertzContact contact{1.3, 0.6, 2.0};
  const double load = 2.0 / 3.0 * pi * 1.3 * 0.6 * 2.0;
  for (const Grid& grid :
       {Grid{40, 40, 0.1, 0.05}, Grid{7, 9, 0.5, 0.3}, Grid{1, 1, 4.0, 4.0}, Grid{512, 512, 6e-3, 3e-3}}) {
    EXPECT_NEAR(hertz_cell_averages(contact, grid).sum() * grid.cell_area() / load, 1.0, kHertzRounding);
  }
}

/// Against the integral over x2 in closed form and the midpoint rule over x1, in a variable that removes the
/// square roots at the ends.
double average_by_quadrature(const HertzContact& contact, double left, double right, double low, double high) {
  constexpr int kPoints = 200'000;
  const double from = std::max(left, -contact.semi_axis_1);
  const double to = std::min(right, contact.semi_axis_1);
  if (from >= to) return 0.0;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double theta = pi * (i + 0.5) / kPoints;
    const double x = 0.5 * (from + to) - 0.5 * (to - from) * std::cos(theta);
    const double root = std::sqrt(std::max(1.0 - std::pow(x / contact.semi_axis_1, 2), 0.0));
    const auto primitive = [&](double y) {
      const double s = std::clamp(y / (contact.semi_axis_2 * root), -1.0, 1.0);
      return 0.5 * root * root * contact.semi_axis_2 * (s * std::sqrt(1.0 - s * s) + std::asin(s));
    };
    sum += (primitive(high) - primitive(low)) * std::sin(theta);
  }
  const double integral = sum * pi / kPoints * 0.5 * (to - from);
  return contact.peak_pressure * integral / ((right - left) * (high - low));
}

TEST(HertzAverages, OfACellEqualQuadrature) {
  const HertzContact contact{1.3, 0.6, 2.0};
  const Grid grid{13, 11, 0.23, 0.13};
  const ArrayXd averages = hertz_cell_averages(contact, grid);
  int on_the_edge = 0;
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) {
      const double left = grid.x1(i) - 0.5 * grid.h1;
      const double low = grid.x2(j) - 0.5 * grid.h2;
      const double expected = average_by_quadrature(contact, left, left + grid.h1, low, low + grid.h2);
      // The midpoint rule over a kink where the ellipse leaves the cell: of second order in 1/200,000.
      EXPECT_NEAR(averages[i * grid.n2 + j], expected, 1e-9) << "cell (" << i << ", " << j << ")";
      if (expected == 0.0) {
        EXPECT_EQ(averages[i * grid.n2 + j], 0.0);
      }
      if (expected > 0.0 && expected < 0.3 * contact.peak_pressure) ++on_the_edge;
    }
  }
  EXPECT_GT(on_the_edge, 8);
}

TEST(HertzAtCentres, IsHertzsPressureThere) {
  const HertzContact contact{1.3, 0.6, 2.0};
  const Grid grid{5, 3, 0.5, 0.5};
  const ArrayXd pressure = hertz_at_centres(contact, grid);
  EXPECT_DOUBLE_EQ(pressure[2 * 3 + 1], 2.0);
  EXPECT_DOUBLE_EQ(pressure[3 * 3 + 2], 2.0 * std::sqrt(1.0 - 0.25 / 1.69 - 0.25 / 0.36));
  EXPECT_EQ(pressure[0], 0.0);
}

}  // namespace
}  // namespace slipstick::solver
