#include "analytic/indentation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "analytic/elliptic.hpp"

namespace slipstick::analytic {
namespace {

using std::numbers::pi;

constexpr double kLoadOfEllipse = 1000;        // N
constexpr double kModulusOfEllipse = 115.4e9;  // Pa
constexpr double kRadiusOfEllipse = 0.018;     // m

/// Surface displacement at (x1, x2) inside the contact under a semi-ellipsoidal pressure, from Boussinesq's
/// point load integrated along chords: along each p is a half ellipse, over whose length its integral is
/// elementary; over the directions the trapezoidal rule converges geometrically.
double displacement(const HertzEllipse& contact, double modulus, double x1, double x2) {
  constexpr int kDirections = 4000;
  const double a2 = contact.semi_axis_1 * contact.semi_axis_1;
  const double b2 = contact.semi_axis_2 * contact.semi_axis_2;
  const double inside = 1 - x1 * x1 / a2 - x2 * x2 / b2;
  double sum = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = pi * i / kDirections;
    const double n1 = std::cos(angle);
    const double n2 = std::sin(angle);
    const double square = n1 * n1 / a2 + n2 * n2 / b2;
    const double linear = n1 * x1 / a2 + n2 * x2 / b2;
    // p/p0 = sqrt(inside - 2 linear t - square t^2): half an ellipse of this height over this half chord.
    const double height = std::sqrt(inside + linear * linear / square);
    const double half_chord = height / std::sqrt(square);
    sum += pi / 2 * height * half_chord;
  }
  return contact.peak_pressure * sum * (pi / kDirections) / (pi * modulus);
}

TEST(HertzEllipse, OfEqualRadiiIsTheCircle) {
  const auto circle = indent_sphere(kLoadOfEllipse, kRadiusOfEllipse, kModulusOfEllipse);
  const auto ellipse = hertz_ellipse(kLoadOfEllipse, kRadiusOfEllipse, kRadiusOfEllipse, kModulusOfEllipse);
  EXPECT_NEAR(ellipse.semi_axis_1 / circle.contact_radius, 1, 1e-15);
  EXPECT_NEAR(ellipse.semi_axis_2 / circle.contact_radius, 1, 1e-15);
  EXPECT_NEAR(ellipse.peak_pressure / circle.reference_pressure, 1, 1e-15);
  EXPECT_NEAR(ellipse.approach / circle.approach, 1, 1e-15);
  EXPECT_NEAR(ellipse.friction_arm / (3 * pi / 16 * circle.contact_radius), 1, 1e-15);
}

TEST(HertzEllipse, DisplacesTheSurfaceByApproachLessGap) {
  for (const double ratio : {1.0, 1.0 + 1e-9, 1.3, 4.0, 20.0, 1.0 / 20, 1e3, 1e-3}) {
    const double radius_2 = kRadiusOfEllipse / ratio;
    const auto contact = hertz_ellipse(kLoadOfEllipse, kRadiusOfEllipse, radius_2, kModulusOfEllipse);
    for (const auto& [f1, f2] : {std::pair{0.0, 0.0}, {0.5, 0.0}, {0.0, 0.5}, {0.6, -0.7}, {0.95, 0.1}}) {
      const double x1 = f1 * contact.semi_axis_1;
      const double x2 = f2 * contact.semi_axis_2;
      const double expected = contact.approach - x1 * x1 / (2 * kRadiusOfEllipse) - x2 * x2 / (2 * radius_2);
      EXPECT_NEAR(displacement(contact, kModulusOfEllipse, x1, x2) / contact.approach,
                  expected / contact.approach, 1e-13)
          << ratio << " at " << f1 << ", " << f2;
    }
  }
}

/// Johnson 1985, Eqs. (4.26), in D = (K - E)/e^2 and B = K - D, which do not cancel: 1/R_1 = 2 p0 b/(E* a^2)
/// D, 1/R_2 = 2 p0/(E* b) B, approach p0 b K/E*; by means, where the contact itself is found by Carlson's
/// forms.
TEST(HertzEllipse, HasTheCurvaturesOfTheGapAtAnyRatio) {
  for (const double ratio :
       {1.0, 1.0 + 1e-15, 1.0 + 1e-12, 1.0 + 1e-6, 1.01, 2.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6}) {
    const auto contact =
        hertz_ellipse(kLoadOfEllipse, kRadiusOfEllipse, kRadiusOfEllipse / ratio, kModulusOfEllipse);
    const double a = contact.semi_axis_1;
    const double b = contact.semi_axis_2;
    const auto [k, e, d] = complete_elliptic(std::min(b / a, 1.0));
    const double unit = 2 * contact.peak_pressure / kModulusOfEllipse;
    constexpr double kTolerance = 1e-14;
    EXPECT_NEAR(unit * b / (a * a) * d * kRadiusOfEllipse, 1, kTolerance) << ratio;
    EXPECT_NEAR(unit / b * (k - d) * kRadiusOfEllipse / ratio, 1, kTolerance) << ratio;
    EXPECT_NEAR(unit / 2 * b * k / contact.approach, 1, kTolerance) << ratio;
    EXPECT_NEAR(2.0 / 3 * contact.peak_pressure * pi * a * b / kLoadOfEllipse, 1, kTolerance) << ratio;
  }
}

/// Gross slip about the axis: mu times the integral of p r. Along each direction p is a half ellipse, and r^2
/// p integrates to pi/16 of peak times the cubed radius of the edge; the trapezoidal rule over the
/// directions.
TEST(HertzEllipse, HasTheFrictionArmOfItsPressure) {
  constexpr int kDirections = 4000;
  for (const double ratio : {1.0, 1.0 + 1e-9, 3.0, 20.0, 1.0 / 20, 1e3}) {
    const auto contact =
        hertz_ellipse(kLoadOfEllipse, kRadiusOfEllipse, kRadiusOfEllipse / ratio, kModulusOfEllipse);
    double sum = 0;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * pi * i / kDirections;
      const double edge =
          1 / std::hypot(std::cos(angle) / contact.semi_axis_1, std::sin(angle) / contact.semi_axis_2);
      sum += pi / 16 * contact.peak_pressure * edge * edge * edge;
    }
    EXPECT_NEAR(sum * 2 * pi / kDirections / kLoadOfEllipse / contact.friction_arm, 1, 1e-13) << ratio;
  }
}

/// The mean distance from the middle of a line that carries 1 - x^2: 3/8 of half its length.
TEST(HertzEllipse, TendsToALine) {
  const auto contact =
      hertz_ellipse(kLoadOfEllipse, kRadiusOfEllipse, kRadiusOfEllipse / 1e9, kModulusOfEllipse);
  EXPECT_NEAR(contact.friction_arm / contact.semi_axis_1, 3.0 / 8, 1e-9);
}

TEST(HertzEllipse, TurnsWithItsAxes) {
  for (const double ratio : {1.5, 20.0, 1e3}) {
    const auto one =
        hertz_ellipse(kLoadOfEllipse, kRadiusOfEllipse, kRadiusOfEllipse * ratio, kModulusOfEllipse);
    const auto other =
        hertz_ellipse(kLoadOfEllipse, kRadiusOfEllipse * ratio, kRadiusOfEllipse, kModulusOfEllipse);
    EXPECT_LT(one.semi_axis_1, one.semi_axis_2) << "the longer axis lies where the curvature is smaller";
    EXPECT_EQ(one.semi_axis_1, other.semi_axis_2);
    EXPECT_EQ(one.semi_axis_2, other.semi_axis_1);
    EXPECT_EQ(one.approach, other.approach);
    EXPECT_EQ(one.friction_arm, other.friction_arm);
  }
}

TEST(HertzEllipse, ScalesWithLoadModulusAndSize) {
  const auto base = hertz_ellipse(kLoadOfEllipse, kRadiusOfEllipse, 5 * kRadiusOfEllipse, kModulusOfEllipse);
  const auto loaded =
      hertz_ellipse(8 * kLoadOfEllipse, kRadiusOfEllipse, 5 * kRadiusOfEllipse, kModulusOfEllipse);
  EXPECT_NEAR(loaded.semi_axis_1 / base.semi_axis_1, 2, 1e-14);
  EXPECT_NEAR(loaded.peak_pressure / base.peak_pressure, 2, 1e-14);
  EXPECT_NEAR(loaded.approach / base.approach, 4, 1e-14);
  const auto stiffer =
      hertz_ellipse(8 * kLoadOfEllipse, kRadiusOfEllipse, 5 * kRadiusOfEllipse, 8 * kModulusOfEllipse);
  EXPECT_NEAR(stiffer.semi_axis_2 / base.semi_axis_2, 1, 1e-14);
  const auto larger =
      hertz_ellipse(4 * kLoadOfEllipse, 2 * kRadiusOfEllipse, 10 * kRadiusOfEllipse, kModulusOfEllipse);
  EXPECT_NEAR(larger.semi_axis_2 / base.semi_axis_2, 2, 1e-14);
  EXPECT_NEAR(larger.peak_pressure / base.peak_pressure, 1, 1e-14);
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
