// Frictions that do not follow the pressure, by closed cases and at both ends of the range of loads;
// profile_facts_test.cpp has their twist by its definition.

#include <fmt/core.h>

#include "analytic/cycle.hpp"
#include "analytic/references/references.hpp"
#include "analytic/shear_bounds.hpp"
#include "analytic/tests/values.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic {
namespace {

using testing::relative_error;

TEST(ShearBounds, AreHertzsWithoutACapAndWithTheFirstPower) {
  testing::expect_same(*capped_hertz_profile(1), hertz_profile(), 1, 20 * kEps);
  testing::expect_same(*power_of_hertz_profile(1), hertz_profile(), 1, 20 * kEps);
}

/// f = 1 - r^2 is elementary: H = (1 - c^2/2) arcosh(1/c) - sqrt(1 - c^2)/2 and -c H' = sqrt(1 - c^2) + c^2
/// arcosh(1/c).
TEST(ShearBounds, HaveTheClosedFormsOfTheSquare) {
  const auto square = power_of_hertz_profile(2);
  EXPECT_LE(relative_error(square->load(), pi / 2), 20 * kEps);
  EXPECT_LE(relative_error(square->moment_limit(), 8.0 / 15), 20 * kEps);
  for (const double c : {1e-9, 1e-3, 0.1, 0.4, 0.6}) {
    const double arcosh = std::acosh(1 / c);
    const double root = std::sqrt((1 - c) * (1 + c));
    EXPECT_LE(relative_error(square->twist_integral(at(c)), (1 - c * c / 2) * arcosh - root / 2), 40 * kEps) << c;
    EXPECT_LE(relative_error(square->twist_slope(at(c)), root + c * c * arcosh), 20 * kEps) << c;
  }
}

TEST(ShearBounds, GoForthAndBackByLoadDeficitAndTwist) {
  std::vector<std::unique_ptr<const Profile>> profiles;
  for (const double cap : {0.01, 0.5}) profiles.push_back(capped_hertz_profile(cap));
  for (const double n : {0.2, 2.0 / 3, 2.5}) profiles.push_back(power_of_hertz_profile(n));
  for (const auto& profile : profiles)
    for (const double m : {1e-6, 0.1, 0.5, 0.9, 0.999}) {
      const TorsionState state = from_moment_ratio(m, *profile);
      SCOPED_TRACE(fmt::format("{}, m = {}", profile->name(), m));
      EXPECT_LE(relative_error(from_twist(state.twist, *profile).moment_ratio, m), 1e-13);
      EXPECT_LE(relative_error(from_moment_deficit(state.moment_deficit, *profile).twist, state.twist),
                1e-13 + 4 * kEps / std::min(m, 1 - m));
      EXPECT_LE(relative_error(from_stick_complement(state.stick_complement, *profile).moment_ratio, m), 1e-13);
    }
}

TEST(ShearBounds, RefuseWhatIsOutOfRange) {
  for (const double cap : {0.0, -1.0, 1.5, kNan}) EXPECT_THROW(capped_hertz_profile(cap), std::domain_error);
  for (const double n : {0.0, -1.0, 3.5, kNan}) EXPECT_THROW(power_of_hertz_profile(n), std::domain_error);
}

}  // namespace
}  // namespace slipstick::analytic
