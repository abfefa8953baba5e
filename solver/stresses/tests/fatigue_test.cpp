#include "solver/stresses/fatigue.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <random>

#include "solver/stresses/smallest_ball.hpp"

namespace slipstick::solver {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

Tensor random_tensor(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Tensor any = Tensor::NullaryExpr([&] { return uniform(random); });
  return any + any.transpose();
}

Tensor random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

double tresca_shear(const Tensor& stress) {
  const Eigen::Vector3d principal = stress.selfadjointView<Eigen::Lower>().eigenvalues();
  return 0.5 * (principal[2] - principal[0]);
}

/// Every point lies within, and no half-space holds all points of the sphere without the centre.
TEST(SmallestBall, HoldsAllPointsAndCannotBeMovedInward) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const std::size_t size : {1U, 2U, 3U, 5U, 12U, 40U}) {
    using Point = Eigen::Matrix<double, 3, 1>;
    std::vector<Point> points(size);
    for (Point& point : points) point = Point::NullaryExpr([&] { return normal(random); });
    points.insert(points.end(), points.begin(), points.begin() + static_cast<long>((size + 1) / 2));
    const SmallestBall<3> ball(points);
    std::vector<Point> touching;
    for (const Point& point : points) {
      const double distance = (point - ball.center()).norm();
      EXPECT_LE(distance, ball.radius() * (1.0 + 1e-9));
      if (distance >= ball.radius() * (1.0 - 1e-9)) touching.push_back(point - ball.center());
    }
    for (int trial = 0; trial < 1000; ++trial) {
      const Point direction = Point::NullaryExpr([&] { return normal(random); });
      double least = std::numeric_limits<double>::infinity();
      for (const Point& point : touching) least = std::min(direction.dot(point), least);
      EXPECT_LE(least, 1e-9) << size;
    }
  }
}

TEST(Fatigue, ARepeatedStateHasNoAmplitude) {
  std::mt19937_64 random(2);
  const Tensor state = random_tensor(random);
  const std::vector<Tensor> states(4, state);
  const double hydrostatic = state.trace() / 3.0;
  const DangVan found = dang_van(states, 0.3);
  EXPECT_NEAR(found.shear, 0.0, 1e-14);
  EXPECT_NEAR(found.value, 0.3 * hydrostatic, 1e-14);
  const Eigen::Vector3d principal = state.selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_NEAR(findley(states, 0.25, kNone)->value, 0.25 * principal[2], 2e-5);
}

/// m + c A with c from -1 to 1 has the amplitude A.
TEST(Fatigue, ProportionalLoadingHasTheAmplitudeOfItsRange) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Tensor mean = random_tensor(random), range = random_tensor(random);
    const std::vector<Tensor> states{mean - range, mean + 0.3 * range, mean + range, mean - 0.6 * range};
    const double alpha = 0.4, hydrostatic = mean.trace() / 3.0, alternating = std::abs(range.trace()) / 3.0;
    const DangVan found = dang_van(states, alpha);
    EXPECT_NEAR(found.value, tresca_shear(range) + alpha * (hydrostatic + alternating), 1e-9);
    EXPECT_NEAR(found.hydrostatic_mean, hydrostatic, 1e-14);
    EXPECT_NEAR(found.hydrostatic_largest, hydrostatic + alternating, 1e-14);
  }
}

/// On any number of states, with a constant stress added.
TEST(Fatigue, AShearStressThatTurnsHasItsSizeAsAmplitude) {
  std::mt19937_64 random(4);
  for (const int states : {3, 4, 7, 30}) {
    const Tensor turned = random_rotation(random), constant = random_tensor(random);
    std::vector<Tensor> cycle;
    for (int i = 0; i < states; ++i) {
      const double angle = 2.0 * M_PI * i / states;
      Tensor shear = Tensor::Zero();
      shear(0, 2) = shear(2, 0) = 2.5 * std::cos(angle);
      shear(1, 2) = shear(2, 1) = 2.5 * std::sin(angle);
      cycle.emplace_back(constant + turned * shear * turned.transpose());
    }
    EXPECT_NEAR(dang_van(cycle, 0.0).value, 2.5, 1e-9) << states;
    EXPECT_NEAR(findley(cycle, 0.0, kNone)->value, 2.5, 3e-5) << states;
  }
}

/// With the amplitude a and the largest stress b on the axis, a plane at the angle t to it has the sum
/// a sin t cos t + k b cos^2 t, whose maximum is (k b + sqrt(a^2 + k^2 b^2))/2. Torsion of amplitude a has
/// a sqrt(1 + k^2).
TEST(Fatigue, FindleyHasTheClosedFormsOfAxialLoadingAndTorsion) {
  std::mt19937_64 random(5);
  const double amplitude = 1.3;
  for (const double k : {0.0, 0.25, 1.0}) {
    for (const double mean : {-1.0, 0.0, 2.0}) {
      const Tensor turned = random_rotation(random);
      const Tensor axial = turned.col(0) * turned.col(0).transpose();
      const double most = mean + amplitude;
      const auto found =
          findley(std::vector<Tensor>{(mean - amplitude) * axial, most * axial}, k, kNone).value();
      EXPECT_NEAR(found.value, 0.5 * (k * most + std::hypot(amplitude, k * most)), 2e-5);
      EXPECT_NEAR(found.shear + k * found.normal_stress, found.value, 1e-14);
      const double cosine = turned.col(0).dot(Eigen::Vector3d(found.normal.data()));
      EXPECT_NEAR(cosine * cosine, 0.5 * (1.0 + k * most / std::hypot(amplitude, k * most)), 2e-3);
    }
    const Tensor turned = random_rotation(random);
    const Tensor half = turned.col(0) * turned.col(1).transpose();
    const Tensor torsion = amplitude * (half + half.transpose());
    EXPECT_NEAR(findley(std::vector<Tensor>{torsion, -torsion}, k, kNone)->value,
                amplitude * std::sqrt(1.0 + k * k), 3e-5);
  }
}

TEST(Fatigue, DoesNotDependOnTheAxes) {
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 10; ++trial) {
    const Tensor turn = random_rotation(random);
    std::vector<Tensor> states, turned;
    for (int i = 0; i < 6; ++i) {
      states.push_back(random_tensor(random));
      turned.emplace_back(turn * states.back() * turn.transpose());
    }
    EXPECT_NEAR(dang_van(states, 0.3).value, dang_van(turned, 0.3).value, 1e-9);
    EXPECT_NEAR(findley(states, 0.3, kNone)->value, findley(turned, 0.3, kNone)->value, 5e-5);
  }
}

/// Bounds leave out no cell.
TEST(LargestFatigue, IsThatOfAllCells) {
  std::mt19937_64 random(7);
  const Grid grid{6, 7, 1.0, 0.5};
  std::vector<StressPlane> states(3, StressPlane{2.0, {}});
  for (StressPlane& plane : states)
    for (Eigen::ArrayXd& stress : plane.stress) stress = Eigen::ArrayXd::Random(grid.cells());
  LargestFatigue largest;
  largest.include(states, {.dang_van = 0.3, .findley = 0.25}, grid);
  double shear = kNone, hydrostatic = kNone, normal = kNone;
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    std::vector<Tensor> cycle;
    for (const StressPlane& plane : states) {
      const auto& [s11, s22, s33, s12, s13, s23] = plane.stress;
      cycle.emplace_back(Tensor{{s11[cell], s12[cell], s13[cell]},
                                {s12[cell], s22[cell], s23[cell]},
                                {s13[cell], s23[cell], s33[cell]}});
    }
    shear = std::max(shear, dang_van(cycle, 0.0).value);
    hydrostatic = std::max(hydrostatic, dang_van(cycle, 0.3).value);
    normal = std::max(normal, findley(cycle, 0.25, kNone)->value);
  }
  EXPECT_DOUBLE_EQ(largest.shear.found.value, shear);
  EXPECT_DOUBLE_EQ(largest.dang_van.found.value, hydrostatic);
  EXPECT_NEAR(largest.findley.found.value, normal, 3e-5);
  states[1].stress[k12][3] = std::numeric_limits<double>::quiet_NaN();
  largest.include(states, {.dang_van = 0.3, .findley = 0.25}, grid);
  for (const double value :
       {largest.shear.found.value, largest.dang_van.found.value, largest.findley.found.value})
    EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace slipstick::solver
