#include "analytic/indentation.hpp"

#include <algorithm>
#include <stdexcept>

#include "analytic/elliptic.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

/// Johnson 1985, Eqs. (4.26), in D = (K - E)/e^2 and B = K - D, which do not cancel: 1/R_1 = 2 p0 b/(E* a^2)
/// D, 1/R_2 = 2 p0/(E* b) B, approach p0 b K/E*; by means, where the contact itself is found by Carlson's
/// forms.
TEST(HertzEllipse, HasTheCurvaturesOfTheGapAtAnyRatio) {
  for (const double ratio :
       {1.0, 1.0 + 1e-15, 1.0 + 1e-12, 1.0 + 1e-6, 1.01, 2.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6}) {
    const double load = kLoad * ratio;  // of any size
    const auto contact = hertz_ellipse(load, kRadius, kRadius / ratio, kModulus);
    const double a = contact.semi_axis_1;
    const double b = contact.semi_axis_2;
    const auto [k, e, d] = complete_elliptic(std::min(b / a, 1.0));
    const double unit = 2 * contact.peak_pressure / kModulus;
    constexpr double kTolerance = 1e-14;
    EXPECT_NEAR(unit * b / (a * a) * d * kRadius, 1, kTolerance) << ratio;
    EXPECT_NEAR(unit / b * (k - d) * kRadius / ratio, 1, kTolerance) << ratio;
    EXPECT_NEAR(unit / 2 * b * k / contact.approach, 1, kTolerance) << ratio;
    EXPECT_NEAR(2.0 / 3 * contact.peak_pressure * pi * a * b / load, 1, kTolerance) << ratio;
  }
}

/// Gross slip about the axis: mu times the integral of p r. Along each direction p is a half ellipse, and r^2
/// p integrates to pi/16 of peak times the cubed radius of the edge; the trapezoidal rule over the
/// directions.
TEST(HertzEllipse, HasTheFrictionArmOfItsPressure) {
  constexpr int kDirections = 4000;
  for (const double ratio : {1.0, 1.0 + 1e-9, 3.0, 20.0, 1.0 / 20, 1e3}) {
    const auto contact = hertz_ellipse(kLoad, kRadius, kRadius / ratio, kModulus);
    double sum = 0;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * pi * i / kDirections;
      const double edge =
          1 / std::hypot(std::cos(angle) / contact.semi_axis_1, std::sin(angle) / contact.semi_axis_2);
      sum += pi / 16 * contact.peak_pressure * edge * edge * edge;
    }
    EXPECT_NEAR(sum * 2 * pi / kDirections / kLoad / contact.friction_arm, 1, 1e-13) << ratio;
  }
}

/// The mean distance from the middle of a line that carries 1 - x^2: 3/8 of half its length.
TEST(HertzEllipse, TendsToALine) {
  const auto contact = hertz_ellipse(kLoad, kRadius, kRadius / 1e9, kModulus);
  EXPECT_NEAR(contact.friction_arm / contact.semi_axis_1, 3.0 / 8, 1e-9);
}

TEST(HertzEllipse, TurnsWithItsAxes) {
  for (const double ratio : {1.5, 20.0, 1e3}) {
    const auto one = hertz_ellipse(kLoad, kRadius, kRadius * ratio, kModulus);
    const auto other = hertz_ellipse(kLoad, kRadius * ratio, kRadius, kModulus);
    EXPECT_LT(one.semi_axis_1, one.semi_axis_2) << "the longer axis lies where the curvature is smaller";
    EXPECT_EQ(one.semi_axis_1, other.semi_axis_2);
    EXPECT_EQ(one.semi_axis_2, other.semi_axis_1);
    EXPECT_EQ(one.approach, other.approach);
    EXPECT_EQ(one.friction_arm, other.friction_arm);
  }
}

TEST(HertzEllipse, RefusesWhatIsNotPositive) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL})
    for (const int place : {0, 1, 2, 3}) {
      const auto at = [&](int i) { return i == place ? bad : 1.0; };
      EXPECT_THROW(hertz_ellipse(at(0), at(1), at(2), at(3)), std::domain_error) << bad << ' ' << place;
    }
}

}  // namespace
}  // namespace slipstick::analytic
