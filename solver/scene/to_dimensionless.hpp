#pragma once

#include <cmath>

namespace slipstick::solver {

/// A value over its unit, as models hold it: rounded to 40 bits. Twelve digits are more than any scene's data have, and
/// the roundings that came in with the scene's units, which conjugate gradients would amplify, are gone.
inline double to_dimensionless(double value, double unit) {
  constexpr int kBits = 40;
  int exponent = 0;
  const double mantissa = std::frexp(value / unit, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(mantissa, kBits)), exponent - kBits);
}

}  // namespace slipstick::solver
