#include "analytic/stresses/stress_field.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "analytic/gsl.hpp"
#include "analytic/stresses/largest_stress.hpp"

namespace slipstick::analytic {
namespace {

// The rest of the facts is in interfaces/python/tests/test_stresses.py.

TEST(StressField, HasTheStressesOfTorsionThatQuadratureGives) {
  struct Known {
    BodyPoint at;
    double tz;
    double rt;
  };
  // By 30-digit quadrature over rigid discs, M/M_lim = 0.9.
  constexpr std::array kKnown{Known{{0.5, 0.25}, 0.310030637218207, -0.114794653099116},
                              Known{{0.8, 0.1}, 0.427151030273768, -0.418178612053512},
                              Known{{0.3, 0.5}, 0.103475355189715, -0.0217159538450339},
                              Known{{1.2, 0.2}, 0.0565132462292529, -0.175180470713968}};
  const StressField field(from_moment_ratio(0.9), hertz_profile());
  for (const auto& [at, tz, rt] : kKnown) {
    const TorsionStress stress = field.by_torsion(at);
    EXPECT_NEAR(stress.tz, tz, 2e-15);
    EXPECT_NEAR(stress.rt, rt, 2e-15);
  }
}

TEST(StressField, RefusesPointsOutsideTheBodyAndInfiniteStresses) {
  const StressField sphere(from_moment_ratio(0.9), hertz_profile());
  for (const BodyPoint at : {BodyPoint{-0.1, 0.1}, BodyPoint{0.1, -0.1}, BodyPoint{0.1, NAN}, BodyPoint{1e61, 0}})
    EXPECT_THROW(sphere.by_torsion(at), std::domain_error);
  EXPECT_THROW(sphere.by_pressure({0, 0}, 0.51), std::domain_error);
  const StressField punch(from_moment_ratio(0.9, flat_punch_profile()), flat_punch_profile());
  EXPECT_THROW(punch.by_pressure({1, 0}, 0.3), std::domain_error);
}

// Hertz's pressure: von Mises' stress on the axis has a closed form (Huber 1904), and its largest value is where the
// slope of that form is zero. Torsion adds nothing on the axis.
TEST(LargestStress, IsThatOnTheAxisUnderASphereWithoutFriction) {
  const auto on_axis = [](double z) { return 1.5 / (1 + z * z) - 1.3 * (1 - z * std::atan(1 / z)); };
  const auto slope = [](double z) {
    const double part = z / (1 + z * z);
    return 1.3 * (std::atan(1 / z) - part) - 3 * part / (1 + z * z);
  };
  const double depth = gsl::root(slope, 0.3, 0.6);
  const StressField field(from_moment_ratio(0.9), hertz_profile());
  for (const double friction : {0.0, 0.3}) {
    const LargestStress found = largest_stress(field, &Severity::von_mises, friction, 0.3, 0.496);
    EXPECT_NEAR(found.value, on_axis(depth), 1e-12);
    EXPECT_NEAR(found.at.depth, depth, 1e-6);
    EXPECT_NEAR(found.at.radius, 0, 1e-6);
  }
}

// At gross slip the surface next to the axis has sigma_tz = mu p0, sigma_rt = -mu p0/2 and the principal
// stresses of the pressure there, so that von Mises' stress is p0 sqrt((1/2 - nu)^2 + 15 mu^2/4).
TEST(LargestStress, GoesToTheSurfaceNextToTheAxisTowardsGrossSlip) {
  const double friction = 0.6;
  const double limit = std::sqrt(0.04 + 3.75 * friction * friction);
  double before = 1;
  for (const double deficit : {1e-3, 1e-6, 1e-9}) {
    const TorsionState state = from_moment_deficit(deficit);
    const LargestStress found =
        largest_stress({state, hertz_profile()}, &Severity::von_mises, friction, 0.3, state.stick_ratio);
    EXPECT_EQ(found.at.depth, 0);
    const double distance = std::abs(found.value / limit - 1);
    EXPECT_LT(distance, before);
    before = distance / 2;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(LargestStress, IsRefusedWhereItIsInfiniteOrUnknown) {
  for (const Profile* profile : {&flat_punch_profile(), &cone_profile()}) {
    const TorsionState state = from_moment_ratio(0.9, *profile);
    EXPECT_THROW(largest_stress({state, *profile}, &Severity::von_mises, 0.3, 0.3, state.stick_ratio),
                 std::domain_error);
  }
}

}  // namespace
}  // namespace slipstick::analytic
