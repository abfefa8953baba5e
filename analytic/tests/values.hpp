#pragma once

#include <limits>

#include "analytic/axisymmetric.hpp"

namespace slipstick::analytic {

inline constexpr double kEps = std::numeric_limits<double>::epsilon();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The front at a part c of the contact radius.
inline StickRadius at(double c) { return {.ratio = c, .complement = 1 - c}; }

}  // namespace slipstick::analytic
