#include "analytic/stresses/stress_field.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <stdexcept>

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
  for (const BodyPoint at :
       {BodyPoint{-0.1, 0.1}, BodyPoint{0.1, -0.1}, BodyPoint{0.1, NAN}, BodyPoint{1e61, 0}})
    EXPECT_THROW(sphere.by_torsion(at), std::domain_error);
  EXPECT_THROW(sphere.by_pressure({0, 0}, 0.51), std::domain_error);
  const StressField punch(from_moment_ratio(0.9, flat_punch_profile()), flat_punch_profile());
  EXPECT_THROW(punch.by_pressure({1, 0}, 0.3), std::domain_error);
}

}  // namespace
}  // namespace slipstick::analytic
