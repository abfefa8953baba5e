// Energy lost in cycles of the twisting moment.

#include <algorithm>

#include "analytic/cycle.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

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
    const auto lost = [&](double c) {
      return energy_lost_per_cycle(from_stick_ratio(c, *profile), *profile);
    };
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
    EXPECT_NEAR(energy_lost_per_cycle(from_stick_complement(w, punch), punch) / expansion, 1,
                w * w + 16 * kEps)
        << w;
  }
}

/// From the moment it is the small difference to full stick that counts, 8/(3 pi) of the limit. Values by 30
/// digits of the integrals (mpmath), of these very doubles.
TEST(EnergyLost, KeepsTheDigitsOfAMomentJustBeyondFullStick) {
  struct Known {
    double moment_ratio, stick_complement, energy;
  };
  const auto& punch = flat_punch_profile();
  for (const auto& known : {Known{0.85, 0.002772036329860887973, 1.9228249682955457334e-6},
                            Known{0.86, 0.026959534347403746851, 0.0001833693634847616249},
                            Known{0.9, 0.13635684050612670018, 0.0048828889370936979207}}) {
    // Half a unit in the share of slip, 0.15, costs this in addition to the 8 units of all members.
    const double excess = known.moment_ratio - punch.full_stick();
    const double share = kEps / 16 / excess;
    EXPECT_NEAR(from_moment_ratio(known.moment_ratio, punch).stick_complement / known.stick_complement, 1,
                8 * kEps + share);
    EXPECT_NEAR(energy_lost_per_cycle(known.moment_ratio, punch) / known.energy, 1, 8 * kEps + 2 * share);
  }
}

}  // namespace
}  // namespace slipstick::analytic
