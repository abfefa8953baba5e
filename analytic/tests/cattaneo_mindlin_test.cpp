#include "analytic/cattaneo_mindlin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "analytic/elliptic.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic::tangential {
namespace {

using namespace ::testing;

const SelfSimilarIndenter kSphere;
const SelfSimilarIndenter kFlat(kInfinity);
const std::vector<SelfSimilarIndenter> kRound{SelfSimilarIndenter(1), kSphere, SelfSimilarIndenter(3.5)};

TEST(CattaneoMindlin, KeepsItsDigitsAtBothEnds) {
  for (const auto& indenter : kRound) {
    const double power = indenter.radius_power();
    const auto small = from_force_ratio(1e-100, indenter);
    EXPECT_NEAR(small.stick_complement / (power * 1e-100), 1, 4 * kEps);
    EXPECT_NEAR(small.displacement / 0.25e-100, 1, 4 * kEps);
    const auto large = from_force_ratio(1 - 0x1p-50, indenter);
    EXPECT_NEAR(large.stick_ratio / std::exp2(-50 * power), 1, 32 * kEps);  // ln 2^-50 has an ulp of 32 eps
    EXPECT_NEAR(large.force_deficit * 0x1p50, 1, 32 * kEps);
  }
}

TEST(CattaneoMindlin, HasTheForceOfItsTractionsAndCoulombsRing) {
  for (const auto& indenter : kRound)
    for (const double f : {0.1, 0.6, 0.99}) {
      const auto state = from_force_ratio(f, indenter);
      const auto ring = [&](double r) { return r > 0 ? 2 * pi * r * traction(state, r, indenter) : 0; };
      const double force = testing::integral_between_roots(ring, 0, state.stick_ratio) +
                           testing::integral_between_roots(ring, state.stick_ratio, 1);
      EXPECT_NEAR(force / indenter.profile().load(), f, 1e-13) << indenter.radius_power();
      for (const double share : {0.01, 0.5, 0.99}) {
        const double slipping = std::lerp(state.stick_ratio, 1, share);
        EXPECT_EQ(traction(state, slipping, indenter), indenter.profile().pressure(slipping));
        const double sticking = share * state.stick_ratio;
        EXPECT_LT(traction(state, sticking, indenter), indenter.profile().pressure(sticking));
      }
    }
}

/// The potential of the tractions at r: integral q/distance dA, ring by ring.
double potential(const TangentialState& state, const SelfSimilarIndenter& indenter, double r) {
  const auto ring = [&](double s) {
    if (s == 0 || s == r) return 0.0;
    return 4 * s / (r + s) * complete_elliptic(std::abs(r - s) / (r + s)).k * traction(state, s, indenter);
  };
  std::vector<double> ends{0, r, state.stick_ratio, 1};
  std::sort(ends.begin(), ends.end());
  double sum = 0;
  for (std::size_t i = 1; i < ends.size(); ++i) sum += testing::integral_between_roots(ring, ends[i - 1], ends[i]);
  return sum;
}

TEST(CattaneoMindlin, MovesTheStickAreaAsOnePieceAndTheRingLess) {
  // Cerruti at nu = 0: u = integral q/distance dA/(2 pi G).
  for (const auto& indenter : {SelfSimilarIndenter(1), kSphere})
    for (const double f : {0.3, 0.9}) {
      const auto state = from_force_ratio(f, indenter);
      const double unit = 2 * pi * indenter.profile().load();
      for (const double share : {0.2, 0.95})
        EXPECT_NEAR(potential(state, indenter, share * state.stick_ratio) / unit, state.displacement,
                    1e-9);  // the rings' logarithms cost the rest
      double before = state.displacement;
      for (const double share : {0.2, 0.8}) {
        const double moved = potential(state, indenter, std::lerp(state.stick_ratio, 1, share)) / unit;
        EXPECT_LT(moved, before);
        before = moved;
      }
    }
}

TEST(CattaneoMindlin, HasTheStiffnessOfItsStickArea) {
  for (const auto& indenter : kRound)
    for (const double f : {0.1, 0.9}) {
      constexpr double kStep = 1e-5;
      const double slope =
          2 * kStep /
          (from_force_ratio(f + kStep, indenter).displacement - from_force_ratio(f - kStep, indenter).displacement);
      EXPECT_NEAR(slope / from_force_ratio(f, indenter).tangent_stiffness, 1, 1e-7);
    }
}

TEST(CattaneoMindlin, SticksEverywhereUnderAFlatPunch) {
  for (const double f : {0.0, 0.4, 0.999}) {
    const auto state = from_force_ratio(f, kFlat);
    EXPECT_EQ(state.stick_ratio, 1);
    EXPECT_NEAR(state.displacement, f / 4, kEps);  // Mindlin 1949: a bonded circle
    EXPECT_EQ(state.tangent_stiffness, 4);
    EXPECT_NEAR(traction(state, 0.6, kFlat), f / 0.8, 4 * kEps);
    EXPECT_EQ(energy_lost_per_cycle(state, kFlat), 0);
  }
}

TEST(CattaneoMindlin, LosesTheAreaOfMasingsLoop) {
  for (const auto& indenter : kRound)
    for (const double f : {0.2, 0.95}) {
      const auto state = from_force_ratio(f, indenter);
      const double complement =
          gsl::integral([&](double force) { return from_force_ratio(force, indenter).displacement; }, 0, f);
      EXPECT_NEAR(energy_lost_per_cycle(state, indenter), 4 * f * state.displacement - 8 * complement, 1e-14);
    }
}

TEST(CattaneoMindlin, LosesTheCubeOfASmallForce) {
  // 8 integral F ddelta - 4 F delta with delta = F/4 + q F^2/8, c = (1 - F)^q.
  for (const auto& indenter : kRound)
    for (const double f : {1e-6, 1e-50})
      EXPECT_NEAR(
          energy_lost_per_cycle(from_force_ratio(f, indenter), indenter) / (indenter.radius_power() * f * f * f / 6), 1,
          2 * f + 1e-14);
}

TEST(CattaneoMindlin, RefusesWhatLiesOutside) {
  for (const double bad : {-0.1, 1.0, kNan}) EXPECT_THROW(from_force_ratio(bad, kSphere), std::domain_error) << bad;
  const auto state = from_force_ratio(0.5, kSphere);
  for (const double bad : {-0.1, 1.1, kNan}) EXPECT_THROW(traction(state, bad, kSphere), std::domain_error) << bad;
  EXPECT_THROW(traction(from_force_ratio(0.5, kFlat), 1, kFlat), std::domain_error);
  for (const double bad : {0.0, -2.0, -kInfinity, kNan})
    EXPECT_THROW(SelfSimilarIndenter{bad}, std::domain_error) << bad;
}

}  // namespace
}  // namespace slipstick::analytic::tangential
