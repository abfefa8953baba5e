#include "convergence/extrapolation.hpp"

#include <cmath>
#include <limits>

namespace slipstick::convergence {
namespace {

constexpr double kLeastOrder = 0.5;  // of quantities of a singular contact with a front told by counting
constexpr double kMostOrder = 3.0;   // piecewise constant fields give 2, with luck somewhat more

}  // namespace

Extrapolation extrapolate(const std::array<double, 3>& values, const std::array<double, 3>& sizes) {
  const auto& [coarse, middle, fine] = values;
  const double coarser = sizes[0] / sizes[2];
  const double finer = sizes[1] / sizes[2];
  // (coarse - middle)/(middle - fine), as an order says; grows with the order.
  const auto ratio_at = [&](double order) {
    return (std::pow(coarser, order) - std::pow(finer, order)) / (std::pow(finer, order) - 1.0);
  };
  const double ratio = (coarse - middle) / (middle - fine);
  if (!(ratio >= ratio_at(kLeastOrder) && ratio <= ratio_at(kMostOrder))) {
    return {fine, std::abs(fine - middle), std::nullopt};
  }
  double low = kLeastOrder;
  double high = kMostOrder;
  for (int halving = 0; halving < std::numeric_limits<double>::digits; ++halving) {
    const double order = 0.5 * (low + high);
    (ratio_at(order) < ratio ? low : high) = order;
  }
  const double left = (middle - fine) / (std::pow(finer, high) - 1.0);
  return {fine - left, std::abs(left), high};
}

}  // namespace slipstick::convergence
