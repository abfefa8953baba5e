#pragma once

#include <string>
#include <vector>

#include "convergence/runs/process_pool.hpp"

/// The digits of an answer that do not depend on rounding.
namespace slipstick::convergence {

/// Decimal digits of a number that another rounding does not change: -log10(standard deviation / number),
/// from 0 to kAllDigits. [low, high] is the 95 % confidence interval for normal deviations (chi-square;
/// Sohier et al. 2021, Confidence intervals for stochastic arithmetic).
struct Digits {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};
inline constexpr double kAllDigits = 15.95;  ///< -log10 of half an ulp

/// The digits of `value`, solved with rounding to nearest, from at least one sample of it, solved with random
/// rounding. NaN where any of them is NaN.
Digits surviving_digits(double value, const std::vector<double>& samples);

struct DigitsOptions {
  int samples = 30;
  int first_seed = 1;  ///< of `samples` in a row; positive
};

struct OutputDigits {
  std::string output;  ///< path in a result
  double value = 0.0;
  Digits digits;
};

struct DigitsResult {
  RunSpec spec;
  DigitsOptions options;
  RunStatus status = RunStatus::not_converged;  ///< of the solve with rounding to nearest
  std::string message;
  std::ptrdiff_t not_converged = 0;  ///< of the samples
  std::vector<OutputDigits> digits;
};

/// Solves a scene with rounding to nearest, and with `samples` values of solver.rounding_seed. Throws
/// std::invalid_argument for options out of range.
DigitsResult rounding_digits(const RunSpec& spec, const DigitsOptions& options, const ProcessPool& pool);

/// docs/schema/digits.schema.json
Json to_json(const DigitsResult& result);

/// For a person: one line for each number.
std::string digits_text(const DigitsResult& result);

}  // namespace slipstick::convergence
