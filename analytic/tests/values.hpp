#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "analytic/axisymmetric.hpp"
#include "analytic/gsl.hpp"
#include "analytic/shear_bounds.hpp"
#include "analytic/tabulated_pressure.hpp"

namespace slipstick::analytic {

using std::numbers::pi;

inline constexpr double kEps = std::numeric_limits<double>::epsilon();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline constexpr double kLoad = 1000;        // N
inline constexpr double kModulus = 115.4e9;  // Pa
inline constexpr double kRadius = 0.018;     // m

/// The front at a part c of the contact radius.
inline StickRadius at(double c) { return {.ratio = c, .complement = 1 - c}; }
inline StickRadius before_edge(double complement) { return {.ratio = 1 - complement, .complement = complement}; }

namespace testing {

/// The integral of f over [low, high], with square-root ends made smooth.
inline double integral_between_roots(const std::function<double(double)>& f, double low, double high) {
  return gsl::integral(
      [&](double t) { return f(low + (high - low) * std::pow(std::sin(t), 2)) * (high - low) * std::sin(2 * t); }, 0,
      pi / 2);
}

inline const std::vector<const Profile*> kClosedForms{&hertz_profile(), &cone_profile(), &flat_punch_profile(),
                                                      &constant_bound_profile()};

/// Sampled at equal steps, or (graded) closer and closer towards the edge.
inline std::vector<PressurePoint> sample(const std::function<double(double)>& pressure, int intervals,
                                         bool graded = false) {
  std::vector<PressurePoint> points;
  for (int i = 0; i < intervals; ++i) {
    const double share = static_cast<double>(i) / intervals;
    const double radius = graded ? std::sin(pi / 2 * share) : share;
    points.push_back({.radius = radius, .pressure = pressure(radius)});
  }
  points.push_back({.radius = 1, .pressure = pressure(1)});
  return points;
}

inline double linear(double r) { return 1 - r; }
inline double hertz(double r) { return std::sqrt((1 - r) * (1 + r)); }

/// Everything from 1e-12 to 1 - 1e-12, where both c and 1 - c are exact enough.
inline const std::vector<StickRadius> kSticks{
    at(1e-12), at(1e-9), at(1e-6), at(1e-3), at(0.01), at(0.1),   at(0.2),           at(0.4),
    at(0.5),   at(0.6),  at(0.8),  at(0.9),  at(0.99), at(0.999), before_edge(1e-6), before_edge(1e-12)};

/// Functions of H, M and q that agree between two profiles, one over a p0 `scale` times the other's.
inline void expect_same(const Profile& profile, const Profile& expected, double scale, double tolerance) {
  EXPECT_NEAR(profile.load() / expected.load() / scale, 1, tolerance);
  EXPECT_NEAR(profile.moment_limit() / expected.moment_limit(), 1, tolerance);
  EXPECT_EQ(profile.edge(), 0);
  for (const auto& c : kSticks) {
    const auto near = [&](double value, double reference, const char* name) {
      EXPECT_NEAR(value / reference, 1, tolerance) << profile.name() << ", " << name << " at c = " << c.ratio;
    };
    near(profile.twist_integral(c), scale * expected.twist_integral(c), "H");
    near(profile.twist_slope(c), scale * expected.twist_slope(c), "-c H'");
    near(profile.moment_share(c).excess, expected.moment_share(c).excess, "M");
    near(profile.moment_share(c).deficit, expected.moment_share(c).deficit, "M_lim - M");
    near(profile.pressure(c.ratio), scale * expected.pressure(c.ratio), "p");
    for (const double f : {1e-13, 1e-6, 1e-3, 0.1, 0.5, 0.99, 1 - 1e-6, 1 - 1e-12}) {
      const double inward = c.ratio * f;
      near(profile.stick_traction(c, c.ratio - inward, inward),
           scale * expected.stick_traction(c, c.ratio - inward, inward), "q");
    }
  }
}

}  // namespace testing

}  // namespace slipstick::analytic
