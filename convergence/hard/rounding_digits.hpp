#pragma once

#include <vector>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"

/// How many digits of a solve's answer rounding leaves.
namespace slipstick::convergence {

/// Decimal digits of a number that another rounding does not change: -log10 of the deviation's standard
/// deviation over the number, from 0 to kAllDigits. The interval holds it with 95 %, were the deviations
/// normal (chi-square; Sohier et al. 2021, Confidence intervals for stochastic arithmetic).
struct Digits {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};
inline constexpr double kAllDigits = 15.95;  ///< -log10 of half an ulp

/// The digits of `value`, rounded to nearest, from at least one sample of it, rounded at random. NaN where
/// any of them is NaN.
Digits surviving_digits(double value, const std::vector<double>& samples);

struct DigitsOptions {
  int samples = 30;
  int first_seed = 1;  ///< of `samples` in a row; positive
};

/// Solves a scene to nearest and with `samples` seeds of solver.rounding_seed:
/// docs/schema/digits.schema.json. Throws std::invalid_argument for options out of range.
Json rounding_digits(const RunSpec& spec, const DigitsOptions& options, const ProcessPool& pool);

/// For a person: a line for each number.
std::string digits_text(const Json& result);

}  // namespace slipstick::convergence
