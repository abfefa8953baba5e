// Contact laws against the exact law, at points that no fit has seen.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "analytic/elliptic.hpp"
#include "analytic/named_profile.hpp"
#include "analytic/torsion.hpp"
#include "convergence/laws/contact_law.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/tests/scratch_folder.hpp"

namespace slipstick::convergence {
namespace {

using analytic::Profile;
using analytic::TorsionState;

const std::vector<const Profile*> kLawProfiles{&analytic::hertz_profile(), &analytic::cone_profile(),
                                               &analytic::flat_punch_profile()};

/// Twists from rest to a little short of the last one, spread evenly and, near either end, by powers.
std::vector<double> twists_to(double last, int count) {
  std::vector<double> twists;
  for (int i = 0; i < count / 2; ++i) {
    const double part = (i + 0.5) / (count / 2);
    twists.push_back(last * part);
    twists.push_back(last * std::pow(10.0, -9.0 * part));
  }
  return twists;
}

void expect_law_within(const Profile& profile, double error, int count) {
  const TwistLaw law = fit_twist_law(profile, error);
  double moment_error = 0.0;
  for (const double t : twists_to(law.last_twist, count)) {
    const TorsionState state = analytic::from_twist(t, profile);
    moment_error = std::max(moment_error, std::abs(law.moment_ratio_at(t) / state.moment_ratio - 1.0));
  }
  EXPECT_LE(moment_error, error) << profile.name();
}

TEST(TwistLaw, IsWithinItsStatedError) {
  for (const Profile* profile : kLawProfiles) {
    expect_law_within(*profile, 1e-6, 10000);
    for (const double error : {1e-2, 1e-10}) expect_law_within(*profile, error, 1000);
  }
  expect_law_within(*analytic::find_profile("rounded_punch:0.5").profile, 1e-3, 50);
}

TEST(TwistLaw, EndsAtTheLimit) {
  const TwistLaw law = fit_twist_law(analytic::hertz_profile(), 1e-6);
  EXPECT_EQ(law.moment_ratio_at(2.0 * law.last_twist), 1.0);
  EXPECT_EQ(law.moment_ratio_at(-2.0 * law.last_twist), -1.0);
  EXPECT_EQ(law.moment_ratio_at(0.0), 0.0);
  EXPECT_EQ(law.moment_ratio_at(-0.1), -law.moment_ratio_at(0.1));
}

TEST(FitChebyshev, RefusesWhatIsNoNumber) {
  const auto hole = [](double x) { return std::abs(x - 0.3) < 0.02 ? std::nan("") : 1.0 + x; };
  EXPECT_THROW(fit_chebyshev(hole, {0.0, 1.0}, 1e-3), std::domain_error);
  EXPECT_THROW(fit_chebyshev([](double) { return std::nan(""); }, {0.0, 1.0}, 1e-3), std::domain_error);
}

TEST(TwistLaw, RefusesErrorsOutOfRange) {
  for (const double error : {0.0, 1e-12, 0.1, std::nan("")}) {
    EXPECT_THROW(fit_twist_law(analytic::hertz_profile(), error), std::domain_error) << error;
  }
}

/// m of first loading, between the rows.
double interpolated(const StateTable& table, double twist) {
  const auto above = std::find_if(table.rows.begin() + 1, table.rows.end() - 1,
                                  [&](const TorsionState& row) { return row.twist >= twist; });
  const TorsionState& low = *(above - 1);
  const double part = (twist - low.twist) / (above->twist - low.twist);
  return std::min(1.0, part) * (above->moment_ratio - low.moment_ratio) + low.moment_ratio;
}

/// The largest distance of a law's m from the exact one, up to a twist.
template <class Law>
double largest_error(const Profile& profile, double last, int count, const Law& moment_ratio_at) {
  double largest = 0.0;
  for (const double t : twists_to(last, count)) {
    largest = std::max(largest, std::abs(moment_ratio_at(t) - analytic::from_twist(t, profile).moment_ratio));
  }
  return largest;
}

/// Whether a stated error is the largest that there is.
void expect_error(double largest, double stated, const Profile& profile) {
  EXPECT_LE(largest, stated * (1.0 + 1e-6)) << profile.name();
  EXPECT_GE(largest, 0.9 * stated) << profile.name();
}

TEST(StateTable, IsWithinItsErrorAndNoFinerThanThat) {
  for (const Profile* profile : kLawProfiles) {
    for (const double error : {1e-2, 1e-5}) {
      const StateTable table = tabulate(*profile, error);
      expect_error(largest_error(*profile, 2.0 * table.rows.back().twist, 2000,
                                 [&](double t) { return interpolated(table, t); }),
                   error, *profile);
    }
  }
}

TEST(ParallelElements, AreWithinTheirErrorOnFirstLoading) {
  for (const Profile* profile : kLawProfiles) {
    for (const double error : {0.1, 1e-2, 1e-4}) {
      const ParallelElements found = parallel_elements(*profile, error);
      double slip = 0.0;
      for (const JenkinsElement& element : found.elements) {
        EXPECT_GT(element.stiffness, 0.0);
        slip += element.slip;
      }
      EXPECT_NEAR(slip, 1.0, 1e-12);
      expect_error(largest_error(*profile, 1.0, 4000, [&](double t) { return found.moment_ratio_at(t); }),
                   error, *profile);
    }
  }
}

TEST(ParallelElements, GiveMoreForMore) {
  double before = 1.0;
  for (const int count : {1, 2, 4, 8, 16, 200}) {
    const ParallelElements found = parallel_elements(analytic::hertz_profile(), count);
    EXPECT_EQ(found.elements.size(), static_cast<std::size_t>(count));
    EXPECT_LT(found.error, 0.5 * before);
    before = found.error;
  }
  EXPECT_THROW(parallel_elements(analytic::hertz_profile(), 0), std::domain_error);
  EXPECT_THROW(parallel_elements(analytic::hertz_profile(), 1e-6), std::domain_error);
}

/// Force and moment of a turning sphere's contact by a sum over rings and angles.
LimitLoad summed(double centre) {
  constexpr int kRings = 1000;
  constexpr int kAngles = 240;
  LimitLoad load{centre, 0.0, 0.0};
  double weight = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double x = (i + 0.5) / kRings;  // r^2
    const double r = std::sqrt(x);
    const double p = std::sqrt(1.0 - x);
    for (int k = 0; k < kAngles; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kAngles;
      const double along = centre - r * std::cos(angle);
      const double speed = std::hypot(along, r * std::sin(angle));
      load.force += p * along / speed;
      load.moment += p * (x - centre * r * std::cos(angle)) / speed;
      weight += p;
    }
  }
  return {centre, load.force / weight, load.moment / weight / (3.0 * std::numbers::pi / 16.0)};
}

TEST(LimitSurface, IsTheSumOfFrictionAboutAPoint) {
  const LimitSurface surface = limit_surface(analytic::hertz_profile(), 9);
  EXPECT_NEAR(surface.loads.front().moment, 1.0, 1e-12);
  EXPECT_NEAR(surface.loads.front().force, 0.0, 1e-12);
  EXPECT_NEAR(surface.loads.back().force, 1.0, 1e-12);
  EXPECT_NEAR(surface.loads.back().moment, 0.0, 1e-12);
  for (std::size_t i = 1; i + 1 < surface.loads.size(); ++i) {
    const LimitLoad& load = surface.loads[i];
    const LimitLoad sum = summed(load.centre);
    EXPECT_NEAR(load.force, sum.force, 1e-4) << load.centre;
    EXPECT_NEAR(load.moment, sum.moment, 1e-4) << load.centre;
  }
}

/// The load of each motion supports the surface: no other load lies beyond it.
TEST(LimitSurface, IsConvexWithItsMotionsAsNormals) {
  for (const Profile* profile : kLawProfiles) {
    const LimitSurface surface = limit_surface(*profile, 17);
    const double arm = profile->moment_limit();
    for (const LimitLoad& load : surface.loads) {
      if (std::isinf(load.centre)) continue;
      const double support = load.force * load.centre + load.moment * arm;
      for (const LimitLoad& other : surface.loads) {
        EXPECT_LE(other.force * load.centre + other.moment * arm, support * (1.0 + 1e-9)) << profile->name();
      }
    }
  }
}

TEST(BestSpring, NoSpringWithACapIsBetter) {
  for (const Profile* profile : kLawProfiles) {
    const ContactLaw law = make_contact_law({"x", {profile, [](const Profile*) {}}, {}}, {.limit_loads = 3});
    const auto error_of = [&](double stiffness) {
      const double at_cap = 1.0 - analytic::from_twist(1.0 / stiffness, *profile).moment_ratio;
      return std::max(
          at_cap, largest_error(*profile, 1.5, 1000, [&](double t) { return std::min(1.0, stiffness * t); }));
    };
    const SpringAndCap& best = law.best_spring;
    EXPECT_NEAR(error_of(best.stiffness), best.error, 1e-4);
    EXPECT_GE(error_of(0.95 * best.stiffness), best.error);
    EXPECT_GE(error_of(1.05 * best.stiffness), best.error);
    EXPECT_NEAR(error_of(law.rest_spring.stiffness), law.rest_spring.error, 1e-4);
  }
}

TEST(LawContact, IsTheScenesInSi) {
  const ContactLaw law =
      make_contact_law(law_contact(example("paper", {"load.normal=500"})), {.limit_loads = 3});
  const OracleAnswer exact = find_oracle(example("paper", {"load.normal=500"}));
  EXPECT_NEAR(law.limit_moment() / exact.oracle->friction.moment_limit, 1.0, 1e-13);
  EXPECT_NEAR(law.law.moment_ratio_at(exact.oracle->twist_angle / law.rotation_unit()), 0.9, 1e-6);
}

}  // namespace
}  // namespace slipstick::convergence
