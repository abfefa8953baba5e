#include "convergence/hard/rounding_digits.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "convergence/results/provenance.hpp"
#include "convergence/results/quantity.hpp"
#include "convergence/runs/failed_runs.hpp"

namespace slipstick::convergence {
namespace {

constexpr double kOneSide = 0.025;

/// The outputs that a user would quote; those of two components by component.
constexpr const char* kOutputs[] = {
    "twist_angle",     "moment",     "force[0]",     "force[1]",       "displacement[0]",
    "displacement[1]", "approach",   "moment_limit", "contact_radius", "stick_radius",
    "elastic_energy",  "dissipated", "work",         "twist_error",    "moment_error",
};

double digits_of(double deviation, double value) {
  return std::clamp(-std::log10(deviation / std::abs(value)), 0.0, kAllDigits);
}

Json digits_json(double value, const Digits& digits) {
  return {{"value", value}, {"digits", digits.value}, {"low", digits.low}, {"high", digits.high}};
}

}  // namespace

Digits surviving_digits(double value, const std::vector<double>& samples) {
  if (samples.empty()) throw std::invalid_argument("digits of no samples");
  double squares = 0.0;
  for (const double sample : samples) squares += (sample - value) * (sample - value);
  if (!std::isfinite(squares)) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  if (squares == 0.0) return {kAllDigits, kAllDigits, kAllDigits};
  const auto n = static_cast<double>(samples.size());
  return {digits_of(std::sqrt(squares / n), value),
          digits_of(std::sqrt(squares / gsl_cdf_chisq_Pinv(kOneSide, n)), value),
          digits_of(std::sqrt(squares / gsl_cdf_chisq_Qinv(kOneSide, n)), value)};
}

Json rounding_digits(const RunSpec& spec, const DigitsOptions& options, const ProcessPool& pool) {
  if (options.samples < 1 || options.first_seed < 1) {
    throw std::invalid_argument("samples and seeds of rounding are positive");
  }
  std::vector<RunSpec> runs{spec};
  for (int i = 0; i < options.samples; ++i) {
    runs.push_back(changed(spec, {fmt::format("solver.rounding_seed={}", options.first_seed + i)}));
  }
  const std::vector<Json> results = pool.run(runs);
  const Json& nearest = results.front();
  if (is_failed(nearest)) throw std::runtime_error(nearest["message"].get<std::string>());
  Json json{
      {"scene", spec.scene.string()},
      {"set", spec.overrides},
      {"samples", options.samples},
      {"first_seed", options.first_seed},
      {"status", nearest["status"]},
      {"not_converged", std::ranges::count_if(results.begin() + 1, results.end(),
                                              [](const Json& result) { return !is_converged(result); })},
      {"digits", Json::object()}};
  if (!is_converged(nearest)) {
    json["message"] = nearest.value("message", "");
  } else {
    for (const char* output : kOutputs) {
      const double value = number_at(nearest, output);
      if (std::isnan(value)) continue;
      std::vector<double> samples;
      for (std::size_t i = 1; i < results.size(); ++i) {
        if (is_converged(results[i])) samples.push_back(number_at(results[i], output));
      }
      if (!samples.empty()) json["digits"][output] = digits_json(value, surviving_digits(value, samples));
    }
  }
  json["provenance"] = provenance(1);
  return json;
}

std::string digits_text(const Json& result) {
  std::string text = fmt::format("  {:18} {:>24} {:>7}   {}\n", "", "value", "digits", "95 % interval");
  for (const auto& [name, found] : result["digits"].items()) {
    const double high = found["high"].get<double>();
    text += fmt::format("  {:18} {:>24.17g} {:>7.1f}   {:.1f} to {:.1f}{}\n", name,
                        found["value"].get<double>(), found["digits"].get<double>(),
                        found["low"].get<double>(), high, high < 1.0 ? ", rounding alone" : "");
  }
  if (result["status"] != "converged") {
    text +=
        fmt::format("  {}: {}\n", result["status"].get<std::string>(), result["message"].get<std::string>());
  }
  if (result["not_converged"] != 0) {
    text += fmt::format("  {} of {} samples did not converge\n", result["not_converged"].get<int>(),
                        result["samples"].get<int>());
  }
  return text;
}

}  // namespace slipstick::convergence
