// Facts of statics and friction that hold for any profile. Pressure, load, moments and tractions come from
// separate formulas, closed, superposed or interpolated.

#include <fmt/core.h>

#include "analytic/punch_superposition.hpp"
#include "analytic/shear_bounds.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

struct AnyProfile {
  std::shared_ptr<const Profile> profile;
  double roughness = 1;  ///< factor of the tolerances: quadrature and differences meet a table's kinks
};

AnyProfile tabulated(const char* name, double (*pressure)(double), int intervals, bool graded) {
  return {.profile = tabulated_profile(name, testing::sample(pressure, intervals, graded)).profile, .roughness = 100};
}

const std::vector<AnyProfile>& every_profile() {
  static const std::vector<AnyProfile> all = [] {
    std::vector<AnyProfile> list;
    for (const Profile* const closed : {&hertz_profile(), &cone_profile()})
      list.push_back({.profile = {closed, [](const Profile*) {}}});
    for (const double n : {0.01, 0.5, 1.5, 4.0, 30.0, 1000.0}) list.push_back({.profile = power_profile(n)});
    for (const double b : {0.0, 0.001, 0.5, 0.95, 1 - 1e-9}) list.push_back({.profile = rounded_punch_profile(b)});
    list.push_back({.profile = {&constant_bound_profile(), [](const Profile*) {}}});
    for (const double cap : {0.05, 0.3, 0.9, 1.0}) list.push_back({.profile = capped_hertz_profile(cap)});
    for (const double n : {0.1, 2.0 / 3, 1.0, 1.5, 3.0}) list.push_back({.profile = power_of_hertz_profile(n)});
    list.push_back(tabulated("linear", testing::linear, 20, false));
    list.push_back(tabulated("hertz", testing::hertz, 50, true));
    list.push_back(tabulated(
        "with an edge", [](double r) { return 2 - r * r; }, 17, false));
    return list;
  }();
  return all;
}

/// 2 pi integral p r^power dr; r = sin(t) makes the edge smooth, a power of t the centre of n < 1.
double moment_of_pressure(const Profile& profile, double power) {
  const auto integrand = [&](double v) {
    const double t = pi / 2 * v * v * v;
    const double r = std::sin(t);
    return profile.pressure(r) * std::pow(r, power) * std::cos(t) * pi / 2 * 3 * v * v;
  };
  return 2 * pi * gsl::integral(integrand, 0, 1);
}

TEST(AnyProfile, HasTheLoadOfItsPressure) {
  for (const auto& [profile, roughness] : every_profile()) {
    SCOPED_TRACE(profile->name());
    EXPECT_NEAR(moment_of_pressure(*profile, 1) / profile->load(), 1, 1e-9 * roughness);
    EXPECT_NEAR(moment_of_pressure(*profile, 2) / profile->load() / profile->moment_limit(), 1, 1e-9 * roughness);
  }
}

/// H(c) = integral_c^1 p(r)/sqrt(r^2 - c^2) dr, with r^2 = c^2 + (1 - c^2) sin(t)^2.
TEST(AnyProfile, HasTheTwistOfItsDefinition) {
  for (const auto& [profile, roughness] : every_profile())
    for (const double c : {0.05, 0.5, 0.95}) {
      const double end = std::sqrt((1 - c) * (1 + c));
      const auto integrand = [&](double t) {
        const double r = std::min(1.0, std::hypot(c, end * std::sin(t)));
        return profile->pressure(r) * end * std::cos(t) / r;
      };
      EXPECT_NEAR(gsl::integral(integrand, 0, pi / 2) / profile->twist_integral(at(c)), 1,
                  profile->kinks().empty() ? 1e-13 : 1e-9 * roughness)
          << profile->name() << ", c = " << c;
    }
}

TEST(AnyProfile, HasTheMomentOfItsTractions) {
  for (const auto& [each, roughness] : every_profile())
    for (const double c : {0.05, 0.5, 0.9}) {
      const Profile& profile = *each;
      const auto stick = [&](double t) {
        const double r = c * std::sin(t);
        const double inward = 2 * c * std::pow(std::sin((pi / 2 - t) / 2), 2);
        return inward > 0 ? profile.stick_traction(at(c), r, inward) * r * r * c * std::cos(t) : 0;
      };
      const auto slip = [&](double t) {
        const double r = std::sin(t);
        return profile.pressure(r) * r * r * std::cos(t);
      };
      const double moment = 2 * pi * (gsl::integral(stick, 0, pi / 2) + gsl::integral(slip, std::asin(c), pi / 2));
      EXPECT_NEAR(moment / (profile.moment_share(at(c)).excess * profile.moment_limit() * profile.load()), 1,
                  1e-9 * roughness)
          << profile.name() << ", c = " << c;
    }
}

/// dM/dphi = 16/3 G a_s^3, as for a bonded punch of radius a_s; and -c H' is the slope of H.
TEST(AnyProfile, HasTheTangentStiffnessOfItsStickArea) {
  for (const auto& [each, roughness] : every_profile())
    for (const double c : {0.05, 0.3, 0.7, 0.93}) {
      const Profile& profile = *each;
      SCOPED_TRACE(fmt::format("{}, c = {}", profile.name(), c));
      const double step = 1e-3 * c * (1 - c);
      const auto difference = [&](auto f) {  // of fourth order
        return (8 * (f(at(c + step)) - f(at(c - step))) - (f(at(c + 2 * step)) - f(at(c - 2 * step)))) / (12 * step);
      };
      const double slope = difference([&](StickRadius s) { return profile.twist_integral(s); });
      const double moment = difference(
          [&](StickRadius s) { return profile.moment_share(s).excess * profile.moment_limit() * profile.load(); });
      EXPECT_NEAR(-c * slope / profile.twist_slope(at(c)), 1, 1e-7 * roughness);
      EXPECT_NEAR(moment / slope / (8.0 / 3 * c * c * c), 1, 1e-6 * roughness);
    }
}

TEST(AnyProfile, KeepsTractionsBelowFrictionAndContinuous) {
  for (const auto& [profile, roughness] : every_profile())
    for (const double c : {1e-100, 1e-9, 0.01, 0.5, 0.9, 0.999}) {
      SCOPED_TRACE(fmt::format("{}, c = {}", profile->name(), c));
      EXPECT_EQ(profile->stick_traction(at(c), 0, c), 0);
      double before = 0;
      for (const double f : {0.999, 0.9, 0.6, 0.3, 0.1, 0.01, 1e-5, 1e-13}) {
        const double r = c - c * f;
        const double q = profile->stick_traction(at(c), r, c * f);
        EXPECT_GT(q, 0) << r;
        EXPECT_LE(q, profile->pressure(r) * (1 + 8 * kEps * roughness)) << r;
        before = q;
      }
      EXPECT_NEAR(before / profile->pressure(c), 1, 2e-5 * roughness);
    }
}

TEST(AnyProfile, IsMonotoneAndFiniteAtTheExtremes) {
  std::vector<StickRadius> sticks;
  for (const double c : {1e-100, 1e-60, 1e-20, 1e-12, 1e-6, 0.01, 0.2, 0.5, 0.8, 0.99}) sticks.push_back(at(c));
  for (const double w : {1e-6, 1e-12, 1e-30, 1e-100}) sticks.push_back({.ratio = 1 - w, .complement = w});
  for (const auto& [profile, roughness] : every_profile()) {
    double twist = std::numeric_limits<double>::infinity();
    double deficit = 0;
    for (const auto& c : sticks) {
      SCOPED_TRACE(fmt::format("{}, c = {}, 1 - c = {}", profile->name(), c.ratio, c.complement));
      const auto share = profile->moment_share(c);
      EXPECT_LT(profile->twist_integral(c), twist);
      EXPECT_GT(profile->twist_integral(c), 0);
      EXPECT_GE(share.deficit, deficit * (1 - 8 * kEps * roughness));
      EXPECT_GE(share.deficit, 0);
      EXPECT_GT(share.excess, 0);
      EXPECT_GT(profile->twist_slope(c), 0);
      for (const double f : {1e-13, 0.3, 1 - 1e-12}) {
        const double q = profile->stick_traction(c, c.ratio - c.ratio * f, c.ratio * f);
        EXPECT_TRUE(std::isfinite(q) && q > 0) << f;
      }
      twist = profile->twist_integral(c);
      deficit = share.deficit;
    }
    const StickRadius whole{.ratio = 1, .complement = 0};
    EXPECT_EQ(profile->twist_integral(whole), 0) << profile->name();
    EXPECT_EQ(profile->moment_share(whole).excess, 0) << profile->name();
  }
}

}  // namespace
}  // namespace slipstick::analytic
