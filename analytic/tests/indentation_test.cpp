#include "analytic/indentation.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>

#include "analytic/elliptic.hpp"
#include "analytic/punch_superposition.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

using namespace ::testing;

constexpr double kTolerance = 2e-15;

/// Displacement of the surface at r (over a) by Boussinesq's point load round the axis (Johnson 1985, section
/// 3.8): 4/(pi E*) integral p s/(r + s) K ds, K's complementary modulus |r - s|/(r + s). In units of p0 a/E*.
double displacement(const Profile& profile, double r) {
  const auto rings = [&](double distance, double direction) {
    const auto integrand = [&](double v) {
      // v^4 smooths K's logarithm at s = r, v near 1 the square root at the edge.
      const double share = std::pow(std::sin(pi / 2 * v), 4);
      const double from_end = 1 - share;
      const double d = distance * share;
      const double s = direction > 0 && from_end < 0.5 ? 1 - distance * from_end : r + direction * d;
      if (d == 0 || s <= 0 || s >= 1) return 0.0;
      const double k = complete_elliptic(d / (r + s)).k;
      return profile.pressure(s) * s / (r + s) * k * distance * 4 * std::pow(std::sin(pi / 2 * v), 3) *
             std::cos(pi / 2 * v) * pi / 2;
    };
    return gsl::integral(integrand, 0, 1);
  };
  return 4 / pi * (rings(r, -1) + rings(1 - r, 1));
}

/// The condition of a rigid body: within the contact the surface lies the gap below the approach.
void expect_fit(const Indentation& contact, const Profile& profile, const std::function<double(double)>& gap) {
  const double unit = contact.reference_pressure * contact.contact_radius / kModulus;
  for (const double r : {0.05, 0.3, 0.6, 0.9, 0.99})
    EXPECT_NEAR(displacement(profile, r) * unit / (contact.approach - gap(r * contact.contact_radius)), 1,
                1e-7)  // a flat punch's edge costs half the digits
        << profile.name() << ", r = " << r;
  EXPECT_NEAR(profile.load() * contact.reference_pressure * contact.contact_radius * contact.contact_radius / kLoad, 1,
              1e-13)
      << profile.name();
}

TEST(Indentation, FitsTheBody) {
  expect_fit(indent_sphere(kLoad, kRadius, kModulus), hertz_profile(), [](double r) { return r * r / (2 * kRadius); });
  expect_fit(indent_cone(kLoad, 0.02, kModulus), cone_profile(), [](double r) { return 0.02 * r; });
  expect_fit(indent_flat_punch(kLoad, 1e-3, kModulus), flat_punch_profile(), [](double) { return 0; });
  for (const double n : {1.5, 3.0, 4.0, 20.0}) {
    const double coefficient = 1e-5 / std::pow(1e-3, n);
    expect_fit(indent_power(kLoad, n, coefficient, kModulus), *power_profile(n),
               [&](double r) { return coefficient * std::pow(r, n); });
  }
  for (const double b : {1e-5, 2e-4, 1e-3}) {
    const auto punch = indent_rounded_punch(kLoad, b, kRadius, kModulus);
    expect_fit(punch.contact, *rounded_punch_profile(punch.flat_ratio),
               [&](double r) { return r > b ? (r - b) * (r - b) / (2 * kRadius) : 0; });
  }
}

void expect_same(const Indentation& contact, const Indentation& expected, double tolerance) {
  EXPECT_NEAR(contact.contact_radius / expected.contact_radius, 1, tolerance);
  EXPECT_NEAR(contact.approach / expected.approach, 1, tolerance);
  EXPECT_NEAR(contact.reference_pressure / expected.reference_pressure, 1, tolerance);
}

TEST(Indentation, OfASphereAndAConeIsThatOfAPowerAndOfARoundedPunch) {
  expect_same(indent_power(kLoad, 1, 0.02, kModulus), indent_cone(kLoad, 0.02, kModulus), kTolerance);
  for (const double load : {1e-30, 1e-3, kLoad, 1e30}) {
    const Indentation expected = indent_sphere(load, kRadius, kModulus);
    expect_same(indent_power(load, 2, 1 / (2 * kRadius), kModulus), expected, kTolerance);
    auto rounded = indent_rounded_punch(load, 0, kRadius, kModulus);
    EXPECT_EQ(rounded.flat_ratio, 0);
    rounded.contact.reference_pressure *= 1.5;  // from the mean to the peak
    expect_same(rounded.contact, expected, kTolerance);
  }
}

/// Sneddon 1965: W = 2 E* n/(n + 1) a d, d = kappa B a^n, with kappa = 1 * 2 * 4 ... n/(1 * 3 ... (n - 1)) for even n.
TEST(Indentation, OfEvenPowersIsSneddons) {
  double kappa = 1;
  for (int i = 2; i <= 240; i += 2) {
    kappa *= i / (i - 1.0);
    const double n = i;
    const double coefficient = 0.3;
    const auto contact = indent_power(kLoad, n, coefficient, kModulus);
    const double a = contact.contact_radius;
    EXPECT_NEAR(kappa * coefficient * std::pow(a, n) / contact.approach, 1, 1e-15 * (10 + 2 * n)) << n;
    EXPECT_NEAR(2 * kModulus * n / (n + 1) * a * contact.approach / kLoad, 1, kTolerance) << n;
    EXPECT_NEAR(contact.reference_pressure * 2 * pi / (n + 1) * a * a / kLoad, 1, kTolerance) << n;
  }
}

/// The corner's reach s for s << b: W = 2 E* s^3/(3 R), s^2 = a^2 - b^2.
TEST(Indentation, OfARoundedPunchKnowsAShallowCorner) {
  const double b = 1;
  const auto punch = indent_rounded_punch(kLoad, b, kRadius, kModulus);
  const double s = std::cbrt(3 * kLoad * kRadius / (2 * kModulus));
  EXPECT_NEAR((punch.contact.contact_radius - b) / (s * s / 2), 1, 1e-5);
  EXPECT_NEAR((1 - punch.flat_ratio) / (s * s / 2), 1, 1e-5);
  const auto flat = indent_flat_punch(kLoad, b, kModulus);
  EXPECT_NEAR(punch.contact.approach / flat.approach, 1, 1e-6);
}

/// The two forms of the corner's integral meet at s = b/2.
TEST(Indentation, OfARoundedPunchIsSmoothWhereItsFormsMeet) {
  const auto ratio = [](double b) { return indent_rounded_punch(kLoad, b, kRadius, kModulus).flat_ratio; };
  for (const double s_over_b : {0.49, 0.4999, 0.5, 0.5001, 0.51}) {
    // From s/b to the load, exactly, and back.
    const double t = s_over_b;
    const double power = 2.0 / 3 * t * t * t - ((1 + t * t) * std::atan(t) - t) / 2;  // W R/(2 E* b^3)
    const double b = std::cbrt(kLoad * kRadius / (2 * kModulus * power));
    EXPECT_NEAR(ratio(b) * std::hypot(1, t), 1, kTolerance) << t;
  }
}

TEST(Indentation, LastsToExtremeMagnitudes) {
  const auto expect_finite = [](const Indentation& contact) {
    for (const double value : {contact.contact_radius, contact.approach, contact.reference_pressure})
      EXPECT_TRUE(std::isnormal(value) && value > 0) << value;
  };
  for (const double load : {1e-30, 1e30})
    for (const double size : {1e-12, 1.0, 1e12}) {
      expect_finite(indent_sphere(load, size, kModulus));
      expect_finite(indent_cone(load, size, kModulus));
      expect_finite(indent_flat_punch(load, size, kModulus));
      for (const double n : {0.01, 2.0, 1000.0}) expect_finite(indent_power(load, n, size, kModulus));
      for (const double b : {0.0, 1e-30, 1e30}) expect_finite(indent_rounded_punch(load, b, size, kModulus).contact);
    }
  // a^(n + 1) beyond the range of a double.
  expect_finite(indent_power(1e30, 1000, 1e-300, 1));
  EXPECT_NEAR(indent_power(1e30, 1000, 1e-300, 1).contact_radius / indent_power(1e30, 1000, 1e-250, 1).contact_radius,
              std::pow(10, 50.0 / 1001), 1e-13);
}

TEST(Indentation, RefusesWhatIsNotPositive) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL})
    for (const int place : {0, 1, 2, 3}) {
      const auto at = [&](int i) { return i == place ? bad : 1.0; };
      if (place < 3) {
        EXPECT_THROW(indent_sphere(at(0), at(1), at(2)), std::domain_error) << place;
        EXPECT_THROW(indent_cone(at(0), at(1), at(2)), std::domain_error) << place;
        EXPECT_THROW(indent_flat_punch(at(0), at(1), at(2)), std::domain_error) << place;
      }
      EXPECT_THROW(indent_power(at(0), at(1), at(2), at(3)), std::domain_error) << place;
      EXPECT_THROW(hertz_ellipse(at(0), at(1), at(2), at(3)), std::domain_error) << place;
      if (place != 1 || at(1) != 0) {  // a rounded punch may have no flat
        EXPECT_THROW(indent_rounded_punch(at(0), at(1), at(2), at(3)), std::domain_error) << place;
      }
    }
  EXPECT_THAT([] { indent_cone(1, -2, 1); },
              ThrowsMessage<std::domain_error>(HasSubstr("slope = -2; allowed: positive and finite")));
  EXPECT_THAT([] { indent_rounded_punch(1, -2, 1, 1); },
              ThrowsMessage<std::domain_error>(HasSubstr("flat radius = -2; allowed: >= 0")));
}

/// Johnson 1985, Eqs. (4.26), in D = (K - E)/e^2 and B = K - D, which do not cancel: 1/R_1 = 2 p0 b/(E* a^2) D, 1/R_2 =
/// 2 p0/(E* b) B, approach p0 b K/E*; by means, where the contact itself is found by Carlson's forms.
TEST(HertzEllipse, HasTheCurvaturesOfTheGapAtAnyRatio) {
  for (const double ratio : {1.0, 1.0 + 1e-15, 1.0 + 1e-12, 1.0 + 1e-6, 1.01, 2.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6}) {
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

/// Gross slip about the axis: mu times the integral of p r. Along each direction p is a half ellipse, and r^2 p
/// integrates to pi/16 of peak times the cubed radius of the edge; the trapezoidal rule over the directions.
TEST(HertzEllipse, HasTheFrictionArmOfItsPressure) {
  constexpr int kDirections = 4000;
  for (const double ratio : {1.0, 1.0 + 1e-9, 3.0, 20.0, 1.0 / 20, 1e3}) {
    const auto contact = hertz_ellipse(kLoad, kRadius, kRadius / ratio, kModulus);
    double sum = 0;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * pi * i / kDirections;
      const double edge = 1 / std::hypot(std::cos(angle) / contact.semi_axis_1, std::sin(angle) / contact.semi_axis_2);
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

}  // namespace
}  // namespace slipstick::analytic
