#include "convergence/hard/rounding_digits.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {
namespace {

constexpr double kOneSide = 0.025;

/// The outputs that a user would quote, pairs by component.
constexpr const char* kOutputs[] = {
    "twist_angle",     "moment",     "force[0]",     "force[1]",       "displacement[0]",
    "displacement[1]", "approach",   "moment_limit", "contact_radius", "stick_radius",
    "elastic_energy",  "dissipated", "work",         "twist_error",    "moment_error",
};

double digits_of(double deviation, double value) {
  return std::clamp(-std::log10(deviation / std::abs(value)), 0.0, kAllDigits);
}

}  // namespace

Digits surviving_digits(double value, const std::vector<double>& samples) {
  if (samples.empty()) throw std::invalid_argument("digits of no samples");
  double squares = 0.0;
  for (const double sample : samples) squares += (sample - value) * (sample - value);
  if (!std::isfinite(squares)) return {NAN, NAN, NAN};
  if (squares == 0.0) return {kAllDigits, kAllDigits, kAllDigits};
  const auto n = static_cast<double>(samples.size());
  return {digits_of(std::sqrt(squares / n), value),
          digits_of(std::sqrt(squares / gsl_cdf_chisq_Pinv(kOneSide, n)), value),
          digits_of(std::sqrt(squares / gsl_cdf_chisq_Qinv(kOneSide, n)), value)};
}

DigitsResult rounding_digits(const RunSpec& spec, const DigitsOptions& options, const ProcessPool& pool) {
  if (options.samples < 1 || options.first_seed < 1) {
    throw std::invalid_argument("samples and seeds of rounding are positive");
  }
  std::vector<RunSpec> runs{spec};
  for (int i = 0; i < options.samples; ++i) {
    runs.push_back(changed(spec, {fmt::format("solver.rounding_seed={}", options.first_seed + i)}));
  }
  const std::vector<SolveRecord> records = pool.run(runs);
  const SolveRecord& nearest = records.front();
  if (nearest.is_failed()) throw std::runtime_error(nearest.message);
  DigitsResult result{.spec = spec,
                      .options = options,
                      .status = nearest.status,
                      .message = nearest.message,
                      .not_converged = std::ranges::count(records, false, &SolveRecord::is_converged),
                      .digits = {}};
  if (!nearest.is_converged()) {
    --result.not_converged;
    return result;
  }
  const Json at_nearest = to_json(nearest);
  std::vector<Json> samples;
  for (const SolveRecord& record : records) {
    if (&record != &nearest && record.is_converged()) samples.push_back(to_json(record));
  }
  for (const char* output : kOutputs) {
    const double value = number_at(at_nearest, output);
    if (std::isnan(value) || samples.empty()) continue;
    std::vector<double> values;
    for (const Json& sample : samples) values.push_back(number_at(sample, output));
    result.digits.push_back({output, value, surviving_digits(value, values)});
  }
  return result;
}

Json to_json(const DigitsResult& result) {
  Json digits = Json::object();
  for (const auto& [output, value, found] : result.digits) {
    digits[output] = {{"value", value}, {"digits", found.value}, {"low", found.low}, {"high", found.high}};
  }
  Json json{{"scene", result.spec.scene.string()}, {"set", result.spec.overrides},
            {"samples", result.options.samples},   {"first_seed", result.options.first_seed},
            {"status", to_string(result.status)},  {"not_converged", result.not_converged},
            {"digits", std::move(digits)}};
  if (result.status != RunStatus::converged) json.push_back({"message", result.message});
  json.push_back({"provenance", provenance(1)});
  return json;
}

std::string digits_text(const DigitsResult& result) {
  std::string text = fmt::format("  {:18} {:>24} {:>7}   {}\n", "", "value", "digits", "95 % interval");
  for (const auto& [output, value, digits] : result.digits) {
    text += fmt::format("  {:18} {:>24.17g} {:>7.1f}   {:.1f} to {:.1f}{}\n", output, value, digits.value, digits.low,
                        digits.high, digits.high < 1.0 ? ", only rounding" : "");
  }
  if (result.status != RunStatus::converged) {
    text += fmt::format("  {}: {}\n", to_string(result.status), result.message);
  }
  if (result.not_converged != 0) {
    text += fmt::format("  {} of {} samples did not converge\n", result.not_converged, result.options.samples);
  }
  return text;
}

}  // namespace slipstick::convergence
