#include "solver/scene/to_dimensionless.hpp"

#include <cmath>

namespace slipstick::solver {

double to_dimensionless(double value, double unit) {
  constexpr int bits = 40;
  int exponent = 0;
  const double mantissa = std::frexp(value / unit, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(mantissa, bits)), exponent - bits);
}

}  // namespace slipstick::solver
