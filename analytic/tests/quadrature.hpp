#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "analytic/gsl.hpp"

namespace slipstick::analytic::testing {

/// The integral of f over [low, high], with square-root ends made smooth.
inline double integral_between_roots(const std::function<double(double)>& f, double low, double high) {
  return gsl::integral(
      [&](double t) {
        return f(low + (high - low) * std::pow(std::sin(t), 2)) * (high - low) * std::sin(2 * t);
      },
      0, std::numbers::pi / 2);
}

}  // namespace slipstick::analytic::testing
