#include "solver/input/file_precision.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace slipstick::solver {
namespace {

/// Digits that distinguish every double.
constexpr int kDigitsOfDouble = 17;
/// Numbers with no more digits may be in single precision by chance.
constexpr int kDigitsOfSingle = 7;
/// Numbers that need more decimals were not written with a fixed count of them.
constexpr int kMaxDecimals = 20;

/// The fewest places, from the first count on, with which write(value, places) gives each value; `most`: no fewer.
template <typename Write>
int places_needed(const Eigen::ArrayXd& values, int first, int most, const Write& write) {
  for (const double value : values) {
    while (first < most && std::strtod(write(value, first).c_str(), nullptr) != value) ++first;
  }
  return first;
}

bool is_single(const Eigen::ArrayXd& values) { return (values == values.cast<float>().cast<double>()).all(); }

}  // namespace

FilePrecision find_precision(const Eigen::ArrayXd& values) {
  if ((values == 0.0).all()) return {0.0, 0.0};  // zeros say nothing of decimals, in any unit
  const int digits = places_needed(values, 1, kDigitsOfDouble,
                                   [](double x, int places) { return fmt::format("{:.{}e}", x, places - 1); });
  if (digits > kDigitsOfSingle && is_single(values)) {
    return {0.5 * static_cast<double>(std::numeric_limits<float>::epsilon()), 0.0};
  }
  if (digits == kDigitsOfDouble) return {0.5 * std::numeric_limits<double>::epsilon(), 0.0};
  const double relative = 0.5 * std::pow(10.0, 1 - digits);
  const int decimals =
      places_needed(values, 0, kMaxDecimals, [](double x, int places) { return fmt::format("{:.{}f}", x, places); });
  const double absolute = decimals < kMaxDecimals ? 0.5 * std::pow(10.0, -decimals) : 0.0;
  // The largest number of a fixed count of decimals has all the digits; small numbers written with all digits
  // need more decimals.
  constexpr double kOneDigit = 10.0;
  const bool fixed = relative * values.abs().maxCoeff() <= kOneDigit * absolute;
  return fixed ? FilePrecision{0.0, absolute} : FilePrecision{relative, 0.0};
}

}  // namespace slipstick::solver
