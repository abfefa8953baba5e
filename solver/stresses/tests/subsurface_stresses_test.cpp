#include "solver/stresses/subsurface_stresses.hpp"

#include <gsl/gsl_integration.h>
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Tensor = std::array<double, kStresses>;

/// Of a unit force along x3, Boussinesq's point solution; of one along x1, Cerruti's (Johnson 1985, section
/// 3.2 and 3.6, times 2 pi there).
Tensor boussinesq(double x, double y, double z, double nu) {
  const double R = std::sqrt(x * x + y * y + z * z);
  const double r2 = x * x + y * y;
  const double s = (1.0 - 2.0 * nu) / r2;
  const double R3 = R * R * R;
  const double three = 3.0 * z / (R3 * R * R);
  const double c = (1.0 - z / R) / r2;
  return {s * (c * (x * x - y * y) + z * y * y / R3) - three * x * x,
          s * (c * (y * y - x * x) + z * x * x / R3) - three * y * y,
          -three * z * z,
          s * (2.0 * c - z / R3) * x * y - three * x * y,
          -three * x * z,
          -three * y * z};
}
Tensor cerruti(double x, double y, double z, double nu) {
  const double R = std::sqrt(x * x + y * y + z * z);
  const double R3 = R * R * R;
  const double s = 1.0 - 2.0 * nu;
  const double a = 1.0 / (R * (R + z) * (R + z));
  const double b = a / (R * R) + 2.0 * a / (R * (R + z));
  const double three = 3.0 * x / (R3 * R * R);
  return {-three * x * x + s * x * (1.0 / R3 - 3.0 * a + x * x * b),
          -three * y * y + s * x * (1.0 / R3 - a + y * y * b),
          -three * z * z,
          -three * x * y + s * y * (x * x * b - a),
          -three * x * z,
          -three * y * z};
}

/// Of a unit force along x2: cerruti() with x1 and x2 exchanged.
Tensor point_solution(std::size_t traction, double x, double y, double z, double nu) {
  if (traction == 0) return boussinesq(x, y, z, nu);
  if (traction == 1) return cerruti(x, y, z, nu);
  const Tensor s = cerruti(y, x, z, nu);
  return {s[k22], s[k11], s[k33], s[k12], s[k23], s[k13]};
}

/// Stresses of each traction from the kernels.
std::array<Tensor, kTractions> by_traction(const KernelValues& values) {
  std::array<Tensor, kTractions> result{};
  for (std::size_t k = 0; k < kStressKernels; ++k)
    for (std::size_t u = 0; u < kernels[k].count; ++u)
      result[kernels[k].influences[u].traction][kernels[k].influences[u].stress] = values[k];
  return result;
}

constexpr Grid kCell{1, 1, 0.8, 1.3};

/// Points inside and outside the cell's outline, on all sides.
const std::array<std::array<double, 3>, 6> kPoints{{{0.1, -0.2, 0.5},
                                                    {1.3, 0.4, 0.3},
                                                    {-0.7, 1.9, 1.1},
                                                    {-2.5, -3.1, 0.7},
                                                    {0.9, -1.2, 4.0},
                                                    {0.4, 0.65, 0.6}}};

TEST(CellStress, IsThePointSolutionIntegratedOverTheCell) {
  const std::unique_ptr<gsl_integration_glfixed_table, void (*)(gsl_integration_glfixed_table*)> gauss(
      gsl_integration_glfixed_table_alloc(128), gsl_integration_glfixed_table_free);
  const double nu = 0.27;
  for (const auto& [x, y, z] : kPoints) {
    const auto closed = by_traction(cell_stress(x, y, z, kCell, nu));
    for (std::size_t b = 0; b < kTractions; ++b) {
      Tensor sum{};
      for (std::size_t node = 0; node < 128 * 128; ++node) {
        double u, v, weight_u, weight_v;
        gsl_integration_glfixed_point(-0.5 * kCell.h1, 0.5 * kCell.h1, node / 128, &u, &weight_u,
                                      gauss.get());
        gsl_integration_glfixed_point(-0.5 * kCell.h2, 0.5 * kCell.h2, node % 128, &v, &weight_v,
                                      gauss.get());
        const Tensor point = point_solution(b, x - u, y - v, z, nu);
        for (std::size_t a = 0; a < kStresses; ++a)
          sum[a] += 0.5 * std::numbers::inv_pi * weight_u * weight_v * point[a];
      }
      for (std::size_t a = 0; a < kStresses; ++a)
        EXPECT_NEAR(closed[b][a], sum[a], 1e-12) << "traction " << b << ", stress " << a << " at " << x;
    }
  }
}

/// div sigma = 0, by central differences of second order, extrapolated to fourth.
TEST(CellStress, IsInEquilibrium) {
  const double nu = 0.4;
  for (const auto& [x, y, z] : kPoints) {
    for (std::size_t b = 0; b < kTractions; ++b) {
      const auto difference = [&](Stress a, std::size_t axis, double step) {
        const auto value = [&](double by) {
          std::array<double, 3> at{x, y, z};
          at[axis] += by;
          return by_traction(cell_stress(at[0], at[1], at[2], kCell, nu))[b][a];
        };
        return (value(step) - value(-step)) / (2.0 * step);
      };
      const auto derivative = [&](Stress a, std::size_t axis) {
        constexpr double kStep = 2e-3;
        return (4.0 * difference(a, axis, kStep) - difference(a, axis, 2.0 * kStep)) / 3.0;
      };
      EXPECT_NEAR(derivative(k11, 0) + derivative(k12, 1) + derivative(k13, 2), 0.0, 1e-8);
      EXPECT_NEAR(derivative(k12, 0) + derivative(k22, 1) + derivative(k23, 2), 0.0, 1e-8);
      EXPECT_NEAR(derivative(k13, 0) + derivative(k23, 1) + derivative(k33, 2), 0.0, 1e-8);
    }
  }
}

/// Random tractions on cells that are no squares.
SolutionFields random_fields(const Grid& grid) {
  SolutionFields fields;
  fields.grid = grid;
  fields.pressure = random_field(grid.cells(), 1) + 2.0;
  fields.traction = random_field(2 * grid.cells(), 2);
  return fields;
}

TEST(SubsurfaceStresses, AreTheSumOverAllCells) {
  for (const Grid grid : {Grid{7, 10, 0.8, 1.3}, Grid{6, 3, 1.0, 0.5}, Grid{1, 1, 0.8, 1.3}}) {
    const SolutionFields fields = random_fields(grid);
    for (const Body body : {Body::lower, Body::upper}) {
      const double sign = body == Body::lower ? 1.0 : -1.0;
      SubsurfaceStresses stresses(fields, 0.3, body, 2);
      for (const double depth : {0.4, 3.0}) {
        const StressPlane plane = stresses.at(depth);
        for (Index at = 0; at < grid.cells(); ++at) {
          Tensor sum{};
          for (Index from = 0; from < grid.cells(); ++from) {
            const auto cell =
                by_traction(cell_stress(grid.x1(at / grid.n2) - grid.x1(from / grid.n2),
                                        grid.x2(at % grid.n2) - grid.x2(from % grid.n2), depth, grid, 0.3));
            for (std::size_t a = 0; a < kStresses; ++a)
              sum[a] += fields.pressure[from] * cell[0][a] + sign * fields.traction[from] * cell[1][a] +
                        sign * fields.traction[grid.cells() + from] * cell[2][a];
          }
          for (std::size_t a = 0; a < kStresses; ++a)
            EXPECT_NEAR(plane.stress[a][at], sum[a], 1e-12) << a << " at cell " << at;
        }
      }
    }
  }
}

/// With the normal -x3 of the body's surface, the traction is (-s13, -s23, -s33).
TEST(SubsurfaceStresses, CarryTheTractionsJustBelowTheSurface) {
  const Grid grid{9, 8, 0.8, 1.3};
  const SolutionFields fields = random_fields(grid);
  const StressPlane plane = SubsurfaceStresses(fields, 0.3, Body::lower).at(1e-6);
  EXPECT_LT((plane.stress[k33] + fields.pressure).abs().maxCoeff(), 1e-4);
  EXPECT_LT((plane.stress[k13] + fields.traction.head(grid.cells())).abs().maxCoeff(), 1e-4);
  EXPECT_LT((plane.stress[k23] + fields.traction.tail(grid.cells())).abs().maxCoeff(), 1e-4);
}

/// The part (1 + (r/z)^2)^(-3/2) of a point force acts outside a circle of radius r.
TEST(SubsurfaceStresses, CarryTheNormalLoadThroughAPlane) {
  const Grid grid{128, 128, 1.0, 1.0};
  SolutionFields fields;
  fields.grid = grid;
  fields.traction = Eigen::ArrayXd::Zero(2 * grid.cells());
  fields.pressure = Eigen::ArrayXd::Zero(grid.cells());
  const Index middle = 64 * grid.n2 + 64;
  fields.pressure[middle] = 3.0;
  fields.traction[middle] = 2.0;
  const StressPlane plane = SubsurfaceStresses(fields, 0.3, Body::lower).at(2.0);
  EXPECT_NEAR(plane.stress[k33].sum(), -3.0, 3.0 * std::pow(1.0 + 31.0 * 31.0, -1.5));
}

TEST(SubsurfaceStresses, RefuseASurfaceAndAQuadrant) {
  SolutionFields fields = random_fields({4, 4, 1.0, 1.0});
  SubsurfaceStresses stresses(fields, 0.3, Body::lower);
  for (const double depth : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(stresses.at(depth), std::domain_error);
  fields.grid.quadrant = true;
  EXPECT_THROW(SubsurfaceStresses(fields, 0.3, Body::lower), std::invalid_argument);
}

/// Pure shear has von Mises' number sqrt(3) tau, Tresca's 2 tau; a hydrostatic stress has none.
TEST(Severity, OfPureShearAndOfPressure) {
  const Severity shear = severity({0.0, 0.0, 0.0, 0.0, 3.0, 0.0});
  EXPECT_NEAR(shear.von_mises, 3.0 * std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(shear.tresca, 6.0, 1e-14);
  EXPECT_NEAR(shear.tension, 3.0, 1e-14);
  const Severity pressed = severity({-2.0, -2.0, -2.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(pressed.von_mises, 0.0);
  EXPECT_EQ(pressed.tresca, 0.0);
  EXPECT_EQ(pressed.tension, -2.0);
}

TEST(LargestStresses, AreThoseOfAllCells) {
  const Grid grid{16, 12, 0.8, 1.3};
  SubsurfaceStresses stresses(random_fields(grid), 0.3, Body::lower);
  LargestStresses largest;
  Severity most{-1e9, -1e9, -1e9};
  for (const double depth : {2.0, 0.5, 1.0}) {
    const StressPlane plane = stresses.at(depth);
    largest.include(plane, grid);
    for (Index cell = 0; cell < grid.cells(); ++cell) {
      Tensor stress;
      for (std::size_t a = 0; a < kStresses; ++a) stress[a] = plane.stress[a][cell];
      const Severity here = severity(stress);
      most = {std::max(most.von_mises, here.von_mises), std::max(most.tresca, here.tresca),
              std::max(most.tension, here.tension)};
    }
  }
  EXPECT_EQ(largest.von_mises.value, most.von_mises);
  EXPECT_EQ(largest.tresca.value, most.tresca);
  EXPECT_EQ(largest.tension.value, most.tension);
  EXPECT_EQ(largest.von_mises.at[2], 0.5);
}

}  // namespace
}  // namespace slipstick::solver
