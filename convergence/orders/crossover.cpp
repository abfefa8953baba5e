#include "convergence/orders/crossover.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace slipstick::convergence {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUpperQuantile = 0.975;  // the upper end of a 95 % interval

/// The logarithm of a time, its standard error and the degrees of freedom that this rests on.
struct LogTime {
  double value;
  double error;  ///< NaN: one repetition
  double freedom;
};

std::optional<LogTime> log_time(const std::vector<double>& seconds) {
  std::vector<double> logs;
  for (const double one : seconds) {
    if (one > 0.0 && std::isfinite(one)) logs.push_back(std::log(one));
  }
  if (logs.empty()) return {};
  const auto count = static_cast<double>(logs.size());
  // The median of many normal deviates has this much of their mean's standard error.
  const double of_median = std::sqrt(0.5 * std::numbers::pi);
  const double error =
      count > 1.0 ? of_median * gsl_stats_sd(logs.data(), 1, logs.size()) / std::sqrt(count) : kNaN;
  return LogTime{gsl_stats_median(logs.data(), 1, logs.size()), error, count - 1.0};
}

double quantile(double freedom) { return freedom > 0.0 ? gsl_cdf_tdist_Pinv(kUpperQuantile, freedom) : kNaN; }

/// The logarithms of slow over quick at the sizes at which both have a time.
struct Ratios {
  std::vector<double> log_cells;
  std::vector<double> values;
  std::vector<double> halves;  ///< half the 95 % interval of each; NaN: one repetition
};

Ratios ratios_of(const Family& slow, const Family& quick) {
  Ratios ratios;
  for (const auto& [cells, seconds] : slow) {
    const auto partner = std::ranges::find(quick, cells, &SizedSeconds::cells);
    if (partner == quick.end() || !(cells > 0.0)) continue;
    const auto one = log_time(seconds);
    const auto other = log_time(partner->seconds);
    if (!one || !other) continue;
    ratios.log_cells.push_back(std::log(cells));
    ratios.values.push_back(one->value - other->value);
    ratios.halves.push_back(quantile(std::min(one->freedom, other->freedom)) *
                            std::hypot(one->error, other->error));
  }
  return ratios;
}

/// Where the logarithm of slow over quick becomes positive for good; infinite outside the sizes.
double crossing(const std::vector<double>& log_cells, const std::vector<double>& log_ratios) {
  if (!(log_ratios.back() > 0.0)) return kInfinity;
  std::size_t i = log_ratios.size() - 1;
  while (i > 0 && log_ratios[i - 1] > 0.0) --i;
  if (i == 0) return -kInfinity;
  const double part = -log_ratios[i - 1] / (log_ratios[i] - log_ratios[i - 1]);
  return std::exp(log_cells[i - 1] + part * (log_cells[i] - log_cells[i - 1]));
}

}  // namespace

TypicalSeconds typical(const std::vector<double>& seconds) {
  const auto time = log_time(seconds);
  if (!time) return {kNaN, kNaN, kNaN};
  const double half = time->error * quantile(time->freedom);
  return {std::exp(time->value), std::exp(time->value - half), std::exp(time->value + half)};
}

Crossover find_crossover(const Family& slow, const Family& quick) {
  const auto [log_cells, values, halves] = ratios_of(slow, quick);
  if (values.empty()) return {kNaN, kNaN, kNaN, "no size has a time in both"};
  Crossover found{crossing(log_cells, values), kNaN, kNaN, ""};
  if (std::isinf(found.cells)) {
    const bool later = found.cells > 0.0;
    found.remark =
        fmt::format("not within the measured sizes: {} at {:g} cells", later ? "not yet" : "already",
                    std::exp(later ? log_cells.back() : log_cells.front()));
    found.cells = kNaN;
  }
  if (std::ranges::any_of(halves, [](double half) { return std::isnan(half); })) {
    found.remark += found.remark.empty() ? "the uncertainty of one repetition is unknown" : "";
    return found;
  }
  std::vector<double> above = values;
  std::vector<double> below = values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    above[i] += halves[i];
    below[i] -= halves[i];
  }
  found.low = crossing(log_cells, above);
  found.high = crossing(log_cells, below);
  return found;
}

}  // namespace slipstick::convergence
