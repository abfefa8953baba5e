#include "analytic/tangential_history.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "analytic/cattaneo_mindlin.hpp"
#include "analytic/elliptic.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic::tangential {
namespace {

using namespace ::testing;

constexpr double kRounding = 1e-14;  // some ten steps' errors of 1e-15 each

const SelfSimilarIndenter kBall;
const SelfSimilarIndenter kFlat(kInfinity);
const std::vector<SelfSimilarIndenter> kRound{SelfSimilarIndenter(1), kBall, SelfSimilarIndenter(3.5)};
const std::vector<SelfSimilarIndenter> kIndenters{kRound[0], kRound[1], kRound[2], kFlat};

struct Loads {
  double normal;
  double tangential;
};

TangentialHistory loaded(const std::vector<Loads>& path, const SelfSimilarIndenter& indenter = kBall) {
  TangentialHistory history(indenter);
  for (const auto [normal, tangential] : path) history.load_to(normal, tangential);
  return history;
}

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
      const auto history = loaded({{1, 0}, {1, f}}, indenter);
      const auto ring = [&](double r) { return r > 0 ? 2 * pi * r * history.traction(r) : 0; };
      const double force = testing::integral_between_roots(ring, 0, state.stick_ratio) +
                           testing::integral_between_roots(ring, state.stick_ratio, 1);
      EXPECT_NEAR(force / indenter.profile().load(), f, 1e-13) << indenter.radius_power();
      for (const double share : {0.01, 0.5, 0.99}) {
        const double slipping = std::lerp(state.stick_ratio, 1, share);
        EXPECT_EQ(history.traction(slipping), indenter.profile().pressure(slipping));
        const double sticking = share * state.stick_ratio;
        EXPECT_LT(history.traction(sticking), indenter.profile().pressure(sticking));
      }
    }
}

/// The potential of the tractions at r: integral q/distance dA, ring by ring.
double potential(const TangentialHistory& history, double stick_ratio, double r) {
  const auto ring = [&](double s) {
    if (s == 0 || s == r) return 0.0;
    return 4 * s / (r + s) * complete_elliptic(std::abs(r - s) / (r + s)).k * history.traction(s);
  };
  std::vector<double> ends{0, r, stick_ratio, 1};
  std::sort(ends.begin(), ends.end());
  double sum = 0;
  for (std::size_t i = 1; i < ends.size(); ++i) sum += testing::integral_between_roots(ring, ends[i - 1], ends[i]);
  return sum;
}

TEST(CattaneoMindlin, MovesTheStickAreaAsOnePieceAndTheRingLess) {
  // Cerruti at nu = 0: u = integral q/distance dA/(2 pi G).
  for (const auto& indenter : {SelfSimilarIndenter(1), kBall})
    for (const double f : {0.3, 0.9}) {
      const auto state = from_force_ratio(f, indenter);
      const auto history = loaded({{1, 0}, {1, f}}, indenter);
      const double unit = 2 * pi * indenter.profile().load();
      for (const double share : {0.2, 0.95})
        EXPECT_NEAR(potential(history, state.stick_ratio, share * state.stick_ratio) / unit, state.displacement,
                    1e-9);  // the rings' logarithms cost the rest
      double before = state.displacement;
      for (const double share : {0.2, 0.8}) {
        const double moved = potential(history, state.stick_ratio, std::lerp(state.stick_ratio, 1, share)) / unit;
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
    EXPECT_NEAR(loaded({{1, 0}, {1, f}}, kFlat).traction(0.6), f / 0.8, 4 * kEps);
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
  for (const double bad : {-0.1, 1.0, kNan}) EXPECT_THROW(from_force_ratio(bad, kBall), std::domain_error) << bad;
  for (const double bad : {0.0, -2.0, -kInfinity, kNan})
    EXPECT_THROW(SelfSimilarIndenter{bad}, std::domain_error) << bad;
}

// ---------------------------------------------------------------- histories

void expect_near(const TangentialHistory& a, const TangentialHistory& b, double tolerance) {
  const auto s = a.state();
  const auto t = b.state();
  EXPECT_NEAR(s.normal_load, t.normal_load, tolerance);
  EXPECT_NEAR(s.force, t.force, tolerance);
  EXPECT_NEAR(s.stick_radius, t.stick_radius, tolerance);
  EXPECT_NEAR(s.displacement, t.displacement, tolerance);
  EXPECT_NEAR(s.dissipated, t.dissipated, tolerance);
  for (const double r : {0.1, 0.35, 0.6, 0.8}) EXPECT_NEAR(a.traction(r), b.traction(r), tolerance) << r;
}

/// Loads up and down at random, the same on every machine; every third step keeps W.
std::vector<Loads> random_path(int steps) {
  std::mt19937 twister(20240607);
  const auto next = [&] { return static_cast<double>(twister()) / std::mt19937::max(); };
  std::vector<Loads> path;
  double normal = 1;
  for (int i = 0; i < steps; ++i) {
    if (i % 3 != 0) normal = 0.7 + 0.6 * next();
    path.push_back({.normal = normal, .tangential = 0.6 * (2 * next() - 1)});
  }
  return path;
}

TEST(TangentialHistory, BeginsAsCattaneoAndMindlinSay) {
  for (const auto& indenter : kIndenters)
    for (const double f : {0.1, 0.5, 0.95}) {
      const auto history = loaded({{1, 0}, {1, f}}, indenter);
      const auto expected = from_force_ratio(f, indenter);
      const auto state = history.state();
      EXPECT_NEAR(state.displacement, expected.displacement, kRounding);
      EXPECT_NEAR(state.stick_radius, expected.stick_ratio, kRounding);
      EXPECT_NEAR(state.tangent_stiffness, expected.tangent_stiffness, 4 * kRounding);
      EXPECT_NEAR(state.dissipated, energy_lost_per_cycle(expected, indenter) / 4, kRounding);
    }
}

TEST(TangentialHistory, ObeysMasingsRuleUnderAConstantLoad) {
  for (const auto& indenter : kIndenters)
    for (const double back : {0.5, 0.0, -0.6}) {
      const double most = 0.8;
      const auto up = from_force_ratio(most, indenter);
      const auto down = from_force_ratio((most - back) / 2, indenter);
      const auto first = loaded({{1, 0}, {1, most}}, indenter);
      const auto half = loaded({{1, 0}, {1, (most - back) / 2}}, indenter);
      auto history = loaded({{1, 0}, {1, most}, {1, back}}, indenter);
      EXPECT_NEAR(history.state().displacement, up.displacement - 2 * down.displacement, kRounding);
      EXPECT_NEAR(history.state().stick_radius, down.stick_ratio, kRounding);
      for (const double r : {0.1, 0.5, 0.9})
        EXPECT_NEAR(history.traction(r), first.traction(r) - 2 * half.traction(r), kRounding);
      for (const double force : {back + 0.2, back + 0.1, most}) history.load_to(1, force);
      EXPECT_NEAR(history.state().displacement, up.displacement, kRounding);  // both loops are closed
      const double lost = energy_lost_per_cycle(up, indenter) / 4 + energy_lost_per_cycle(down, indenter) +
                          energy_lost_per_cycle(from_force_ratio(0.05, indenter), indenter);
      EXPECT_NEAR(history.state().dissipated, lost, kRounding);
    }
}

TEST(TangentialHistory, DoesNotSlipWhileForcesRiseAndFallTogether) {
  for (const auto& indenter : kIndenters)
    for (const double k : {0.3, -0.9}) {
      auto history = loaded({{1, k}}, indenter);
      EXPECT_EQ(history.state().dissipated, 0);
      EXPECT_NEAR(history.state().displacement, k * indenter.approach(1) / 2, kRounding);
      EXPECT_EQ(history.state().stick_radius, 1);
      for (const double r : {0.2, 0.7, 0.95}) EXPECT_NEAR(history.traction(r), k * indenter.pressure(1, r), kRounding);
      history.load_to(0.4, 0.4 * k);
      EXPECT_NEAR(history.state().dissipated, 0, kRounding);
      EXPECT_NEAR(history.state().displacement, k * indenter.approach(0.4) / 2, kRounding);
    }
}

TEST(TangentialHistory, LocksWhatItHasWhileOnlyTheLoadRises) {
  const auto before = loaded({{1, 0}, {1, 0.5}});
  auto after = loaded({{1, 0}, {1, 0.5}, {2, 0.5}});
  EXPECT_EQ(after.state().displacement, before.state().displacement);
  EXPECT_EQ(after.state().dissipated, before.state().dissipated);
  EXPECT_NEAR(after.state().stick_radius, std::cbrt(2.0), kRounding);
  for (const double r : {0.1, 0.6, 0.9}) EXPECT_NEAR(after.traction(r), before.traction(r), kRounding);
  // A little more force slips at the new edge: the ring that was there stays as it was.
  after.load_to(2, 0.6);
  EXPECT_NEAR(after.state().stick_radius, std::cbrt(1.9), kRounding);
  // Beyond the force of a contact of the larger size from the start, the history has no effect.
  after.load_to(2, 1.7);
  EXPECT_NEAR(after.state().displacement, loaded({{2, 0}, {2, 1.7}}).state().displacement, kRounding);
}

TEST(TangentialHistory, SlipsOnAsTheLoadFallsUntilItSlides) {
  for (const auto& indenter : kIndenters) {
    auto history = loaded({{1, 0}, {1, 0.3}}, indenter);
    double lost = history.state().dissipated;
    for (const double normal : {0.8, 0.5, 0.31}) {
      history.load_to(normal, 0.3);
      const auto alone = loaded({{normal, 0}, {normal, 0.3}}, indenter);
      EXPECT_NEAR(history.state().displacement, alone.state().displacement, kRounding);
      EXPECT_NEAR(history.state().stick_radius, alone.state().stick_radius, kRounding);
      EXPECT_GE(history.state().dissipated, lost);
      lost = history.state().dissipated;
    }
    EXPECT_THAT([&] { history.load_to(0.3, 0.3); },
                ThrowsMessage<std::domain_error>(AllOf(HasSubstr("gross slip"), HasSubstr("W/W_0 = 0.3"))));
  }
}

TEST(TangentialHistory, ForgetsHowASteepRiseWasShared) {
  // Mindlin and Deresiewicz 1953: dF > mu dW is as if all of W had come first.
  for (const auto& indenter : kIndenters) {
    const auto together = loaded({{1, 0}, {1.5, 0.8}}, indenter);
    const auto apart = loaded({{1.5, 0}, {1.5, 0.8}}, indenter);
    EXPECT_NEAR(together.state().displacement, apart.state().displacement, kRounding);
    for (const double r : {0.1, 0.6, 0.9}) EXPECT_NEAR(together.traction(r), apart.traction(r), kRounding);
    if (indenter.radius_power() > 0) {
      EXPECT_LT(together.state().dissipated, apart.state().dissipated);
    }
  }
}

TEST(TangentialHistory, DoesNotDependOnStopsOnAStraightWay) {
  for (const auto& indenter : kIndenters) {
    TangentialHistory direct(indenter);
    TangentialHistory slow(indenter);
    Loads before{.normal = 0, .tangential = 0};
    for (const auto& loads : random_path(400)) {
      direct.load_to(loads.normal, loads.tangential);
      for (const double share : {0.1, 0.45, 0.8})
        slow.load_to(std::lerp(before.normal, loads.normal, share),
                     std::lerp(before.tangential, loads.tangential, share));
      slow.load_to(loads.normal, loads.tangential);
      auto standing = direct;
      standing.load_to(loads.normal, loads.tangential);
      expect_near(standing, direct, 0);
      expect_near(slow, direct, 100 * kRounding);  // a thousand steps' errors
      before = loads;
    }
  }
}

TEST(TangentialHistory, HasTheForceOfItsTractionsWithinCoulombsBound) {
  for (const auto& indenter : {SelfSimilarIndenter(1), kBall}) {
    TangentialHistory history(indenter);
    for (const auto& [normal, tangential] : random_path(20)) {
      history.load_to(normal, tangential);
      const auto state = history.state();
      double force = 0;
      constexpr int kRings = 2000;  // roots at every layer's edge: the rule's error is some kRings^(-3/2)
      for (int i = 0; i < kRings; ++i) {
        const double r = state.contact_radius * std::sqrt((i + 0.5) / kRings);
        const double q = history.traction(r);
        EXPECT_LE(std::abs(q), indenter.pressure(normal, r) + kRounding);
        force += q * pi * state.contact_radius * state.contact_radius / kRings;
      }
      EXPECT_NEAR(force / indenter.profile().load(), tangential, 2e-4);
    }
  }
}

TEST(TangentialHistory, LosesTheWorkThatDoesNotComeBack) {
  // Nearly out of contact at both ends, nothing is stored: all work of F is lost.
  constexpr double kNoLoad = 1e-7;
  constexpr int kSteps = 200;  // the sum's error is of the order of its square
  for (const auto& indenter : kIndenters) {
    auto path = random_path(12);
    path.push_back({.normal = kNoLoad, .tangential = 0});
    TangentialHistory history(indenter);
    history.load_to(kNoLoad, 0);
    Loads before{.normal = kNoLoad, .tangential = 0};
    auto state = history.state();
    double work = 0;
    for (const auto& loads : path) {
      for (int i = 1; i <= kSteps; ++i) {
        // Closer towards the ends, where the curve bends.
        const double share = std::pow(std::sin(pi / 2 * i / kSteps), 2);
        history.load_to(std::lerp(before.normal, loads.normal, share),
                        std::lerp(before.tangential, loads.tangential, share));
        const auto next = history.state();
        work += (state.force + next.force) / 2 * (next.displacement - state.displacement);
        state = next;
      }
      before = loads;
    }
    EXPECT_NEAR(state.dissipated, work, 3e-4 * work + kRounding) << indenter.radius_power();
  }
}

TEST(TangentialHistory, RefusesWhatLiesOutside) {
  auto history = loaded({{1, 0}, {1, 0.5}});
  for (const double bad : {0.0, -1.0, kInfinity, kNan}) EXPECT_THROW(history.load_to(bad, 0), std::domain_error) << bad;
  for (const double bad : {1.0, -1.0, kNan})
    EXPECT_THAT([&] { history.load_to(1, bad); }, ThrowsMessage<std::domain_error>(HasSubstr("|F| < mu W"))) << bad;
  expect_near(history, loaded({{1, 0}, {1, 0.5}}), 0);
  EXPECT_THROW(history.traction(-0.1), std::domain_error);
  EXPECT_THROW(history.traction(kNan), std::domain_error);
  EXPECT_EQ(history.traction(1.1), 0);
  EXPECT_THROW(loaded({{1, 0}, {1, 0.5}}, SelfSimilarIndenter(1)).traction(0), std::domain_error);
}

}  // namespace
}  // namespace slipstick::analytic::tangential
