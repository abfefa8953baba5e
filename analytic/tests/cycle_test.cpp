#include "analytic/cycle.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

using namespace ::testing;

LoadingHistory loaded(const std::vector<double>& moments, const Profile& profile = hertz_profile()) {
  LoadingHistory history(profile);
  for (const double moment : moments) history.load_to(moment);
  return history;
}

/// The same to the last bit, but for the energy that got lost on the way.
void expect_same(const LoadingHistory& a, const LoadingHistory& b) {
  EXPECT_EQ(a.turning_points(), b.turning_points());
  EXPECT_EQ(a.state().moment_ratio, b.state().moment_ratio);
  EXPECT_EQ(a.state().moment, b.state().moment);
  EXPECT_EQ(a.state().twist, b.state().twist);
  EXPECT_EQ(a.state().stick_ratio, b.state().stick_ratio);
  EXPECT_EQ(a.state().tangent_stiffness, b.state().tangent_stiffness);
  for (const double r : {0.0, 0.3, 0.7, 0.9, 0.99}) EXPECT_EQ(a.traction(r), b.traction(r)) << r;
}

TEST(LoadingHistory, BeginsOnTheCurveOfFirstLoading) {
  for (const Profile* profile : testing::kClosedForms)
    for (const double m : {1e-100, 1e-9, 1e-3, 0.1, 0.5, 0.88, 0.99, 1 - 1e-12})
      for (const double sign : {1.0, -1.0}) {
        const auto history = loaded({sign * m}, *profile);
        const auto first = from_moment_ratio(m, *profile);
        const auto state = history.state();
        EXPECT_EQ(state.moment_ratio, sign * m);
        EXPECT_NEAR(state.moment / first.moment, sign, 2 * kEps);
        EXPECT_NEAR(state.twist / first.twist, sign, 8 * kEps) << profile->name() << ' ' << m;
        EXPECT_EQ(state.stick_ratio, first.stick_ratio);
        EXPECT_EQ(state.tangent_stiffness, first.tangent_stiffness);
        EXPECT_NEAR(state.dissipated, energy_lost_per_cycle(m, *profile) / 4, kEps * state.dissipated);
        EXPECT_THAT(history.turning_points(), IsEmpty());
        for (const double r : {0.0, 0.5, 0.95})
          EXPECT_EQ(history.traction(r), sign * traction(first, r, *profile)) << profile->name() << ' ' << r;
      }
}

TEST(LoadingHistory, RemembersOpenReversals) {
  EXPECT_THAT(loaded({0.6, -0.3, 0.2, 0.1}).turning_points(), ElementsAre(0.6, -0.3, 0.2));
  EXPECT_THAT(loaded({0.6, -0.3, -0.2, -0.25, 0.1}).turning_points(), ElementsAre(0.6, -0.3));
  EXPECT_THAT(loaded({0.6, -0.3, 0.2, -0.3}).turning_points(), ElementsAre(0.6));
  EXPECT_THAT(loaded({0.6, -0.3, 0.6}).turning_points(), IsEmpty());
  EXPECT_THAT(loaded({0.6, -0.6}).turning_points(), IsEmpty());
  EXPECT_THAT(loaded({0.6, -0.7, 0.5}).turning_points(), ElementsAre(-0.7));
  EXPECT_THAT(loaded({0.6, 0.6, 0.0, 0.0, 0.3}).turning_points(), ElementsAre(0.6, 0.0));
}

TEST(LoadingHistory, FollowsMasingsRuleOnABranch) {
  for (const Profile* profile : testing::kClosedForms)
    for (const double m : {0.5, 0.9, -0.4}) {
      const auto at = [&](double moment) { return from_moment_ratio(moment, *profile); };
      const auto history = loaded({0.95, m}, *profile);
      const double half = (0.95 - m) / 2;
      EXPECT_NEAR(history.state().twist, at(0.95).twist - 2 * at(half).twist, 4 * kEps) << profile->name();
      EXPECT_EQ(history.state().stick_ratio, at(half).stick_ratio);
      EXPECT_EQ(history.state().tangent_stiffness, at(half).tangent_stiffness);
      for (const double r : {0.1, 0.5, 0.8})
        EXPECT_NEAR(history.traction(r), traction(at(0.95), r, *profile) - 2 * traction(at(half), r, *profile),
                    4 * kEps)
            << profile->name() << ' ' << r;
    }
}

TEST(LoadingHistory, IsAsItsShortestPathToTheLastBit) {
  struct Case {
    const char* fact;
    std::vector<double> path, shortest;
  };
  for (const auto& [fact, path, shortest] :
       {Case{"a loop closes", {0.95, -0.9, 0.95}, {0.95}}, Case{"a loop closes", {1e-3, 0, 1e-3}, {1e-3}},
        Case{"a loop closes", {0.5, 0.35, 0.5}, {0.5}},
        Case{"inner loops leave nothing", {0.9, -0.2, 0.4, 0.1, 0.2, 0.0, 0.3, -0.5}, {0.9, -0.5}},
        Case{"inner loops leave nothing", {0.9, -0.5, 0.3, -0.1, 0.3, 0.6}, {0.9, -0.5, 0.6}},
        Case{"the largest moment so far wipes all out", {0.5, -0.4, 0.3, -0.2, 0.8}, {0.8}},
        Case{"the largest moment so far wipes all out", {0.5, -0.4, 0.3, -0.2, -0.8}, {-0.8}},
        Case{"stops on the way do not count", {0.3, 0.9, 0.5, -0.1, -0.7, 0.0, 0.9, 0.92, 0.95}, {0.9, -0.7, 0.95}},
        Case{"standing still changes nothing", {0.9, -0.5, 0.1, 0.1}, {0.9, -0.5, 0.1}}})
    for (const Profile* profile : testing::kClosedForms) {
      SCOPED_TRACE(fmt::format("{}: {}, {} moments", fact, profile->name(), path.size()));
      expect_same(loaded(path, *profile), loaded(shortest, *profile));
    }
  const auto lost = [](const std::vector<double>& moments) { return loaded(moments).state().dissipated; };
  EXPECT_EQ(lost({0.9, -0.5, -0.5}), lost({0.9, -0.5}));
  EXPECT_NEAR(lost({0.3, 0.9, 0.5, -0.1, -0.7, 0.0, 0.9, 0.92, 0.95}) / lost({0.9, -0.7, 0.95}), 1, 8 * kEps);
}

TEST(LoadingHistory, MeetsTheFirstLoadingCurveOnTheOtherSide) {
  for (const Profile* profile : testing::kClosedForms)
    for (const double m : {1e-3, 0.5, 0.95}) {
      const auto mirrored = loaded({m, -m}, *profile);
      const auto start = loaded({m}, *profile);
      EXPECT_EQ(mirrored.state().twist, -start.state().twist);
      for (const double r : {0.1, 0.5, 0.9, 0.99}) EXPECT_EQ(mirrored.traction(r), -start.traction(r));
      // Just before, the branch is on, and on its own formula.
      const auto before = loaded({m, -m * (1 - 1e-12)}, *profile);
      EXPECT_THAT(before.turning_points(), ElementsAre(m));
      EXPECT_NEAR(before.state().twist / mirrored.state().twist, 1, 1e-10) << profile->name() << ' ' << m;
      EXPECT_NEAR(before.state().dissipated, mirrored.state().dissipated, 1e-10 * mirrored.state().dissipated);
      EXPECT_NEAR(before.traction(0.5) / mirrored.traction(0.5), 1, 1e-10);
    }
}

TEST(LoadingHistory, LeavesATwistBehindWithAllItsDigits) {
  // (9/64) M^2 - 2 (9/64) (M/2)^2, the second order of the first-loading curve.
  for (const double m : {1e-6, 1e-9, 1e-100}) {
    const auto state = loaded({m, 0}).state();
    const double moment = m * hertz_profile().moment_limit();
    EXPECT_EQ(state.moment, 0);
    EXPECT_NEAR(state.twist / (9.0 / 128 * moment * moment), 1, m + 8 * kEps) << m;
  }
}

TEST(LoadingHistory, StaysWithinCoulombsBoundAndReachesItInItsSlipRing) {
  for (const Profile* profile : testing::kClosedForms) {
    LoadingHistory history(*profile);
    std::mt19937 twister{20240607};  // the same on every machine
    for (int i = 0; i < 100; ++i) {
      const double before = history.moment_ratio();
      history.load_to(0.99 * (2 * static_cast<double>(twister()) / std::mt19937::max() - 1));
      const double sign = history.moment_ratio() > before ? 1 : -1;
      const double front = history.state().stick_ratio;
      for (const double r : {0.01, 0.2, 0.4, 0.6, 0.8, 0.9, 0.99}) {
        const double bound = profile->pressure(r);
        EXPECT_LE(std::abs(history.traction(r)), bound * (1 + 8 * kEps)) << profile->name() << ' ' << r;
        if (r > front) {
          EXPECT_EQ(history.traction(r), sign * bound) << profile->name() << ' ' << r;
        }
      }
    }
  }
}

TEST(LoadingCurve, GoesThroughItsTurningPoints) {
  const auto curve = loading_curve({0.8, -0.5, 0.8}, 10);
  ASSERT_EQ(curve.size(), 31u);
  EXPECT_EQ(curve[0].twist, 0);
  EXPECT_EQ(curve[10].twist, loaded({0.8}).state().twist);
  EXPECT_EQ(curve[20].twist, loaded({0.8, -0.5}).state().twist);
  EXPECT_EQ(curve[30].twist, curve[10].twist);
  // Where start + (end - start) is not the end.
  EXPECT_EQ(loading_curve({0.1, -0.7, 0.3}, 7).back().moment_ratio, 0.3);
  EXPECT_EQ(loading_curve({0.1, -0.7, 0.3}, 7)[14].moment_ratio, -0.7);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    EXPECT_EQ(curve[i].moment_ratio > curve[i - 1].moment_ratio, i <= 10 || i > 20) << i;
    EXPECT_EQ(curve[i].twist > curve[i - 1].twist, i <= 10 || i > 20) << i;
    EXPECT_GT(curve[i].dissipated, curve[i - 1].dissipated) << i;
  }
}

TEST(CycleRange, NamesGrossSlip) {
  LoadingHistory history;
  for (const double bad : {1.0, -1.0, 1.2, -HUGE_VAL})
    EXPECT_THAT([&] { history.load_to(bad); },
                ThrowsMessage<std::domain_error>(AllOf(HasSubstr("gross slip"), HasSubstr("-1 < M/M_lim < 1"))))
        << bad;
  EXPECT_THAT([&] { history.load_to(-1.2); }, ThrowsMessage<std::domain_error>(HasSubstr("-1.2")));
}

TEST(CycleRange, RefusesWhatLiesOutside) {
  LoadingHistory history;
  EXPECT_THROW(history.load_to(kNan), std::domain_error);
  history.load_to(0.5);
  EXPECT_THROW(history.load_to(1.0), std::domain_error);
  expect_same(history, loaded({0.5}));
  for (const double bad : {-0.1, 1.1, kNan}) EXPECT_THROW(history.traction(bad), std::domain_error) << bad;
  EXPECT_THROW(loaded({0.5, 0.0}, flat_punch_profile()).traction(1), std::domain_error);
  EXPECT_THROW(loading_curve({0.5}, 0), std::domain_error);
  EXPECT_THROW(loading_curve({0.5, kNan}, 2), std::domain_error);
  for (const double bad : {-0.1, 1.0, kNan}) {
    EXPECT_THROW(energy_lost_per_cycle(bad), std::domain_error) << bad;
    EXPECT_THROW(energy_lost_per_small_cycle(bad), std::domain_error) << bad;
  }
  EXPECT_THROW(energy_lost_per_small_cycle(0.1, flat_punch_profile()), std::domain_error);
}

/// The loop by Masing's rule: 8 integral M dphi - 4 M phi over the first loading.
TEST(EnergyLost, IsTheAreaOfTheLoop) {
  for (const Profile* profile : testing::kClosedForms)
    for (const double m : {0.3, 0.6, 0.9, 0.99}) {
      const auto twist = [&](double ratio) { return from_moment_ratio(ratio, *profile).twist; };
      const double corner = std::min(m, profile->full_stick());
      const double below =
          (gsl::integral(twist, 0, corner) + gsl::integral(twist, corner, m)) * profile->moment_limit();
      const double product = from_moment_ratio(m, *profile).moment * twist(m);
      EXPECT_NEAR(energy_lost_per_cycle(m, *profile), 4 * product - 8 * below, 32 * kEps * product)
          << profile->name() << ' ' << m;
    }
}

TEST(EnergyLost, GoesLikeTheCubeOfSmallMoments) {
  for (const Profile* profile : {&hertz_profile(), &cone_profile()})
    for (const double m : {1e-2, 1e-3, 1e-6, 1e-12, 1e-90}) {
      const double ratio = energy_lost_per_cycle(m, *profile) / energy_lost_per_small_cycle(m, *profile);
      EXPECT_NEAR(ratio, 1, 2 * m + 16 * kEps) << profile->name() << ' ' << m;
      EXPECT_GT(ratio, 1 - 16 * kEps) << profile->name() << ' ' << m;
    }
  const double moment = 0.1 * hertz_profile().moment_limit();
  EXPECT_NEAR(energy_lost_per_small_cycle(0.1), 3.0 / 16 * std::pow(moment, 3), 4 * kEps);
  const double cone = 0.1 * cone_profile().moment_limit();
  EXPECT_NEAR(energy_lost_per_small_cycle(0.1, cone_profile()), 9.0 / 32 * std::pow(cone, 3), 4 * kEps);
}

/// Then c is small, and the loop a parallelogram: M_lim up and down, phi to and fro.
TEST(EnergyLost, GoesLikeTheTwistNearGrossSlip) {
  for (const Profile* profile : testing::kClosedForms) {
    const auto lost = [&](double c) { return energy_lost_per_cycle(from_stick_ratio(c, *profile), *profile); };
    const auto twist = [&](double c) { return from_stick_ratio(c, *profile).twist; };
    for (const double c : {1e-6, 1e-30, 1e-90})
      EXPECT_NEAR((lost(c) - lost(1e-5)) / (twist(c) - twist(1e-5)), 4 * profile->moment_limit(), 1e-9)
          << profile->name() << ' ' << c;
  }
}

TEST(EnergyLost, IsNothingWhileAllSticks) {
  const auto& punch = flat_punch_profile();
  EXPECT_EQ(energy_lost_per_cycle(0.0), 0);
  for (const double m : {0.0, 1e-3, 0.5, 0.84}) EXPECT_EQ(energy_lost_per_cycle(m, punch), 0) << m;
  EXPECT_GT(energy_lost_per_cycle(0.86, punch), 0);
}

/// There H(c) is H(1) to many digits. With w = 1 - c, H = (pi/2) (1 + w/2 + 5 w^2/16), and the loss follows.
TEST(EnergyLost, KeepsItsDigitsWhereAFlatPunchBeginsToSlip) {
  const auto& punch = flat_punch_profile();
  for (const double w : {1e-6, 1e-7, 1e-9, 1e-15, 1e-100}) {
    const double expansion = w * w / 4 * (1 + w / 3);
    EXPECT_NEAR(energy_lost_per_cycle(from_stick_complement(w, punch), punch) / expansion, 1, w * w + 16 * kEps) << w;
  }
}

}  // namespace
}  // namespace slipstick::analytic
