#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "analytic/axisymmetric.hpp"
#include "analytic/gsl.hpp"

namespace slipstick::analytic {

inline constexpr double kEps = std::numeric_limits<double>::epsilon();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The front at a part c of the contact radius.
inline StickRadius at(double c) { return {.ratio = c, .complement = 1 - c}; }

namespace testing {

/// The integral of f over [low, high], with square-root ends made smooth.
inline double integral_between_roots(const std::function<double(double)>& f, double low, double high) {
  return gsl::integral(
      [&](double t) {
        return f(low + (high - low) * std::pow(std::sin(t), 2)) * (high - low) * std::sin(2 * t);
      },
      0, std::numbers::pi / 2);
}

}  // namespace testing

}  // namespace slipstick::analytic
