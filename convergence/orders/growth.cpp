#include "convergence/orders/growth.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace slipstick::convergence {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUpperQuantile = 0.975;  // the upper end of a 95 % interval
constexpr double kAsymptoticSpan = 8.0;   // largest size over the smallest that a power law is fitted to

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

/// Sizes that have a time.
struct Times {
  std::vector<double> cells;
  std::vector<LogTime> times;

  std::size_t size() const { return cells.size(); }
};

Times times_of(const Family& family) {
  Times known;
  for (const SizedSeconds& sized : family) {
    const auto time = log_time(sized.seconds);
    if (!time || !(sized.cells > 0.0)) continue;
    known.cells.push_back(sized.cells);
    known.times.push_back(*time);
  }
  return known;
}

PowerLaw no_law(std::string why_not) { return {kNaN, kNaN, kNaN, kNaN, {}, std::move(why_not)}; }

/// Two families at the sizes that both have.
struct Race {
  std::vector<double> log_cells;
  std::vector<LogTime> slow;
  std::vector<LogTime> quick;
};

Race race(const Times& slow, const Times& quick) {
  Race both;
  for (std::size_t i = 0; i < slow.size(); ++i) {
    const auto place = std::ranges::find(quick.cells, slow.cells[i]);
    if (place == quick.cells.end()) continue;
    both.log_cells.push_back(std::log(slow.cells[i]));
    both.slow.push_back(slow.times[i]);
    both.quick.push_back(quick.times[static_cast<std::size_t>(place - quick.cells.begin())]);
  }
  return both;
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

/// Half the 95 % interval of each logarithm of slow over quick; NaN: one repetition.
std::vector<double> half_intervals(const Race& both) {
  std::vector<double> halves;
  for (std::size_t i = 0; i < both.slow.size(); ++i) {
    const double freedom = std::min(both.slow[i].freedom, both.quick[i].freedom);
    const double quantile = freedom > 0.0 ? gsl_cdf_tdist_Pinv(kUpperQuantile, freedom) : kNaN;
    halves.push_back(quantile * std::hypot(both.slow[i].error, both.quick[i].error));
  }
  return halves;
}

}  // namespace

TypicalSeconds typical(const std::vector<double>& seconds) {
  const auto time = log_time(seconds);
  if (!time) return {kNaN, kNaN, kNaN};
  const double half =
      time->freedom > 0.0 ? time->error * gsl_cdf_tdist_Pinv(kUpperQuantile, time->freedom) : kNaN;
  return {std::exp(time->value), std::exp(time->value - half), std::exp(time->value + half)};
}

PowerLaw fit_power_law(const Family& family) {
  const Times known = times_of(family);
  if (known.size() < kMinSizes) {
    return no_law(fmt::format("{} sizes have a time, {} are needed", known.size(), kMinSizes));
  }
  const double from = std::ranges::max(known.cells) / kAsymptoticSpan;
  std::vector<double> cells;
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known.cells[i] < from) continue;
    cells.push_back(known.cells[i]);
    x.push_back(std::log(known.cells[i]));
    y.push_back(known.times[i].value);
  }
  if (cells.size() < kMinSizes) {
    return no_law(fmt::format("{} sizes from {:g} cells up, {} are needed", cells.size(), from, kMinSizes));
  }
  double start = 0.0;
  double slope = 0.0;
  double slope_variance = 0.0;
  double unused = 0.0;
  gsl_fit_linear(x.data(), 1, y.data(), 1, x.size(), &start, &slope, &unused, &unused, &slope_variance,
                 &unused);
  const double half =
      std::sqrt(slope_variance) * gsl_cdf_tdist_Pinv(kUpperQuantile, static_cast<double>(cells.size() - 2));
  return {slope, slope - half, slope + half, std::exp(start), cells, ""};
}

std::string to_string(Growth growth) {
  constexpr std::array kNames{"N^2", "N^2 log N", "N^4"};
  return kNames.at(static_cast<std::size_t>(growth));
}

double grown(Growth growth, double cells) {
  if (growth == Growth::n4) return std::pow(cells, 4);
  return cells * cells * (growth == Growth::n2 ? 1.0 : std::log2(2.0 * cells));
}

Crossover find_crossover(const Family& slow, const Family& quick) {
  const Race both = race(times_of(slow), times_of(quick));
  if (both.log_cells.empty()) return {kNaN, kNaN, kNaN, "no size has a time in both"};
  std::vector<double> ratios;
  for (std::size_t i = 0; i < both.slow.size(); ++i) {
    ratios.push_back(both.slow[i].value - both.quick[i].value);
  }
  Crossover found{crossing(both.log_cells, ratios), kNaN, kNaN, ""};
  if (std::isinf(found.cells)) {
    found.remark = found.cells > 0.0 ? fmt::format("not within the measured sizes: not yet at {:g} cells",
                                                   std::exp(both.log_cells.back()))
                                     : fmt::format("not within the measured sizes: already at {:g} cells",
                                                   std::exp(both.log_cells.front()));
    found.cells = kNaN;
  }
  const std::vector<double> halves = half_intervals(both);
  if (std::ranges::any_of(halves, [](double half) { return std::isnan(half); })) {
    found.remark += found.remark.empty() ? "the uncertainty of one repetition is unknown" : "";
    return found;
  }
  const auto crossing_at = [&](double sign) {
    std::vector<double> shifted = ratios;
    for (std::size_t i = 0; i < shifted.size(); ++i) shifted[i] += sign * halves[i];
    return crossing(both.log_cells, shifted);
  };
  found.low = crossing_at(1.0);
  found.high = crossing_at(-1.0);
  return found;
}

}  // namespace slipstick::convergence
