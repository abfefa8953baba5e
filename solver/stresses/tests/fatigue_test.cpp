#include "solver/stresses/fatigue.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <random>
#include <vector>

namespace slipstick::solver {
namespace {

// Against an independent evaluation in all cells: convergence/stresses/tests/stress_cycle_test.py.

Findley findley(const std::vector<Tensor>& states, double k) {
  Findley found;
  find_plane(states, k, found);
  return found;
}

Tensor random_tensor(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Tensor any = Tensor::NullaryExpr([&] { return uniform(random); });
  return any + any.transpose();
}

Tensor random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Eigen::Vector4d any = Eigen::Vector4d::NullaryExpr([&] { return normal(random); });
  return Eigen::Quaterniond(any.normalized()).toRotationMatrix();
}

Eigen::Vector3d principal(const Tensor& stress) { return stress.selfadjointView<Eigen::Lower>().eigenvalues(); }

TEST(Fatigue, ARepeatedStateHasNoAmplitude) {
  std::mt19937_64 random(2);
  const Tensor state = random_tensor(random);
  const std::vector<Tensor> states(4, state);
  EXPECT_NEAR(dang_van(states, 0.3).shear, 0.0, 1e-14);
  EXPECT_NEAR(dang_van(states, 0.3).value, 0.1 * state.trace(), 1e-14);
  EXPECT_NEAR(findley(states, 0.25).value, 0.25 * principal(state)[2], 2e-5);
}

/// m + c A with c from -1 to 1 has the amplitude A.
TEST(Fatigue, ProportionalLoadingHasTheAmplitudeOfItsRange) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Tensor mean = random_tensor(random), range = random_tensor(random);
    const std::vector<Tensor> states{mean - range, mean + 0.3 * range, mean + range, mean - 0.6 * range};
    const double alpha = 0.4, hydrostatic = mean.trace() / 3.0, alternating = std::abs(range.trace()) / 3.0;
    const DangVan found = dang_van(states, alpha);
    EXPECT_NEAR(found.shear, 0.5 * (principal(range)[2] - principal(range)[0]), 1e-9);
    EXPECT_NEAR(found.value, found.shear + alpha * (hydrostatic + alternating), 1e-9);
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
    EXPECT_NEAR(findley(cycle, 0.0).value, 2.5, 3e-5) << states;
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
      const auto found = findley(std::vector<Tensor>{(mean - amplitude) * axial, most * axial}, k);
      EXPECT_NEAR(found.value, 0.5 * (k * most + std::hypot(amplitude, k * most)), 2e-5);
      EXPECT_NEAR(found.shear + k * found.normal_stress, found.value, 1e-14);
      const double cosine = turned.col(0).dot(Eigen::Vector3d(found.normal.data()));
      EXPECT_NEAR(cosine * cosine, 0.5 * (1.0 + k * most / std::hypot(amplitude, k * most)), 2e-3);
    }
    const Tensor turned = random_rotation(random);
    const Tensor half = turned.col(0) * turned.col(1).transpose();
    const Tensor torsion = amplitude * (half + half.transpose());
    EXPECT_NEAR(findley(std::vector<Tensor>{torsion, -torsion}, k).value, amplitude * std::sqrt(1.0 + k * k), 3e-5);
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
    EXPECT_NEAR(findley(states, 0.3).value, findley(turned, 0.3).value, 5e-5);
  }
}

TEST(LargestFatigue, KeepsNaN) {
  const Grid grid{2, 2, 1.0, 1.0};
  StressPlane plane{1.0, {}};
  for (Eigen::ArrayXd& field : plane.stress) field.setOnes(4);
  std::vector<StressPlane> states(2, plane);
  states[0].stress[k12][1] = std::numeric_limits<double>::quiet_NaN();
  LargestFatigue largest;
  largest.include(states, {.dang_van = 0.3, .findley = 0.25}, grid);
  EXPECT_TRUE(std::isnan(largest.dang_van.value) && std::isnan(largest.findley.value));
}

}  // namespace
}  // namespace slipstick::solver
