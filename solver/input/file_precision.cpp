#include "solver/input/file_precision.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

namespace slipstick::solver {
namespace {

/// Digits that distinguish every double.
constexpr int kDigitsOfDouble = 17;
/// Numbers with no more digits may be in single precision by chance.
constexpr int kDigitsOfSingle = 7;
/// Numbers that need more decimals were not written with a fixed count of them.
constexpr int kMaxDecimals = 20;

bool is(const std::string& text, double value) { return std::strtod(text.c_str(), nullptr) == value; }

int digits_needed(const Eigen::ArrayXd& values) {
  int digits = 1;
  for (const double value : values) {
    while (digits < kDigitsOfDouble && !is(fmt::format("{:.{}e}", value, digits - 1), value)) ++digits;
    if (digits == kDigitsOfDouble) break;
  }
  return digits;
}

int decimals_needed(const Eigen::ArrayXd& values) {
  int decimals = 0;
  for (const double value : values) {
    while (decimals < kMaxDecimals && !is(fmt::format("{:.{}f}", value, decimals), value)) ++decimals;
    if (decimals == kMaxDecimals) break;
  }
  return decimals;
}

bool is_single(const Eigen::ArrayXd& values) { return (values == values.cast<float>().cast<double>()).all(); }

}  // namespace

FilePrecision find_precision(const Eigen::ArrayXd& values) {
  if ((values == 0.0).all()) return {0.0, 0.0};  // zeros say nothing of decimals, in any unit
  const int digits = digits_needed(values);
  if (digits > kDigitsOfSingle && is_single(values)) {
    return {0.5 * static_cast<double>(std::numeric_limits<float>::epsilon()), 0.0};
  }
  if (digits == kDigitsOfDouble) return {0.5 * std::numeric_limits<double>::epsilon(), 0.0};
  const double relative = 0.5 * std::pow(10.0, 1 - digits);
  const int decimals = decimals_needed(values);
  const double absolute = decimals < kMaxDecimals ? 0.5 * std::pow(10.0, -decimals) : 0.0;
  // The largest number of a fixed count of decimals has all the digits; small numbers written with all digits
  // need more decimals.
  constexpr double kOneDigit = 10.0;
  const bool fixed = relative * values.abs().maxCoeff() <= kOneDigit * absolute;
  return fixed ? FilePrecision{0.0, absolute} : FilePrecision{relative, 0.0};
}

}  // namespace slipstick::solver
