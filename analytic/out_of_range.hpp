#pragma once

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

namespace slipstick::analytic {

/// Throws std::domain_error with the number's name, value and allowed range.
[[noreturn]] inline void out_of_range(std::string_view name, double value, std::string_view allowed) {
  throw std::domain_error(fmt::format("{} = {}; allowed: {}", name, value, allowed));
}

inline void require_positive(std::string_view name, double value) {
  if (!(value > 0 && std::isfinite(value))) out_of_range(name, value, "positive and finite");
}

}  // namespace slipstick::analytic
