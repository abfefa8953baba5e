#include "convergence/loops/loop_judgement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace slipstick::convergence {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double largest_of(const std::vector<double>& moment) {
  double largest = 0.0;
  for (const double m : moment) largest = std::max(largest, std::abs(m));
  return largest;
}

/// Slope of a line through the origin, over the first rows up to a part of the loop's largest moment.
double slope_at_rest(const LoopPath& path, const std::vector<double>& moment) {
  const double enough = largest_of(path.moment) / 3.0;
  double above = 0.0;
  double below = 0.0;
  for (std::size_t row = 0; row <= path.turns[1] && std::abs(path.moment[row]) <= enough; ++row) {
    above += path.twist[row] * moment[row];
    below += path.twist[row] * path.twist[row];
  }
  return below > 0.0 ? above / below : kUnknown;
}

/// The twist at which the moment crosses a value between two rows; none: it does not.
std::optional<double> crossing(const LoopPath& path, const std::vector<double>& moment, std::size_t from,
                               std::size_t to, double value) {
  for (std::size_t row = from; row < to; ++row) {
    const double before = moment[row] - value;
    const double after = moment[row + 1] - value;
    if (before * after > 0.0 || before == after) continue;
    return path.twist[row] + (path.twist[row + 1] - path.twist[row]) * before / (before - after);
  }
  return std::nullopt;
}

double presliding_of(const LoopPath& path, const std::vector<double>& moment) {
  const double sign = path.twist[path.turns[1]] >= path.twist[0] ? 1.0 : -1.0;
  return std::abs(crossing(path, moment, 0, path.turns[1], 0.5 * sign).value_or(kUnknown));
}

double recovered_part(const LoopPath& path, const std::vector<double>& moment) {
  if (path.turns.size() < 3) return kUnknown;
  const double turned = path.twist[path.turns[1]];
  const auto left = crossing(path, moment, path.turns[1], path.turns[2], 0.0);
  return left ? (turned - *left) / turned : kUnknown;
}

/// The loop's own moment on first loading, between its rows.
double own_loading(const LoopPath& path, double twist) {
  for (std::size_t row = 0; row < path.turns[1]; ++row) {
    const double one = std::abs(path.twist[row]);
    const double other = std::abs(path.twist[row + 1]);
    if (!(one <= twist && twist <= other) || one == other) continue;
    const double m = std::abs(path.moment[row]);
    return m + (std::abs(path.moment[row + 1]) - m) * (twist - one) / (other - one);
  }
  return kUnknown;
}

double masing_error(const LoopPath& path) {
  if (path.turns.size() < 3) return kUnknown;
  const std::size_t turn = path.turns[1];
  const double sign = path.twist[turn] >= 0.0 ? 1.0 : -1.0;
  double sum = 0.0;
  int rows = 0;
  for (std::size_t row = turn; row <= path.turns[2]; ++row) {
    const double back = 0.5 * sign * (path.twist[turn] - path.twist[row]);
    const double enlarged = path.moment[turn] - 2.0 * sign * own_loading(path, back);
    if (std::isnan(enlarged)) continue;
    sum += std::pow(path.moment[row] - enlarged, 2);
    ++rows;
  }
  return rows > 0 ? std::sqrt(sum / rows) / largest_of(path.moment) : kUnknown;
}

bool areas_hold(const LoopJudgement& judgement, const LoopPath& path, double tolerance) {
  const auto [low, high] = std::ranges::minmax_element(path.twist);
  const double box = 2.0 * largest_of(path.moment) * (*high - *low);
  return std::ranges::all_of(judgement.areas, [&](const LoopNumber& area) {
    return std::abs(area.value - area.exact) <= 3.0 * tolerance * box;
  });
}

std::string percent_off(double residual) { return fmt::format("{:.2g} %", 100.0 * residual); }

/// The law that is wrong, or that none is known.
void explain(LoopJudgement& judgement, const char* load, double tolerance) {
  constexpr double kExplained = 0.5;  // of the exact law's residual, at most
  const LoopHypothesis& likely = most_likely(judgement.fitted);
  const bool explains = likely.residual <= std::max(2.0 * tolerance, 0.02) &&
                        likely.residual <= kExplained * judgement.residual;
  if (explains) {
    judgement.law = likely.name;
    judgement.why =
        fmt::format("{} (the {} is {} off the exact law in the mean, {} off this one)", likely.sentence, load,
                    percent_off(judgement.residual), percent_off(likely.residual));
    return;
  }
  judgement.why = fmt::format(
      "the {} is {} off the exact law in the mean, and none of the laws that were tried explains it", load,
      percent_off(judgement.residual));
}

}  // namespace

LoopJudgement judge_loop(const LoopPath& path, const LoopContact& contact, double tolerance) {
  const std::vector<double> exact = follow(path, masing_law(contact.loading));
  LoopJudgement judgement{.good = false,
                          .why = "",
                          .law = "",
                          .residual = residual(path, exact),
                          .stiffness = {slope_at_rest(path, path.moment), slope_at_rest(path, exact)},
                          .largest_load = {largest_of(path.moment), largest_of(exact)},
                          .presliding = {presliding_of(path, path.moment), presliding_of(path, exact)},
                          .recovered = {recovered_part(path, path.moment), recovered_part(path, exact)},
                          .areas = {},
                          .masing_error = masing_error(path),
                          .fitted = {}};
  const std::vector<double> areas = loop_areas(path, path.moment);
  const std::vector<double> exact_areas = loop_areas(path, exact);
  for (std::size_t i = 0; i < areas.size(); ++i) judgement.areas.push_back({areas[i], exact_areas[i]});
  judgement.good = judgement.residual <= tolerance && areas_hold(judgement, path, tolerance);
  if (!judgement.good) {
    judgement.fitted = fit_loop_laws(path, contact);
    explain(judgement, contact.words.load, tolerance);
    return judgement;
  }
  judgement.law = "exact";
  judgement.why = fmt::format("follows the exact law: the {} is {} off in the mean{}", contact.words.load,
                              percent_off(judgement.residual),
                              areas.empty() ? ""
                                            : fmt::format(", the energy lost in {} {} is right", areas.size(),
                                                          areas.size() == 1 ? "loop" : "loops"));
  return judgement;
}

}  // namespace slipstick::convergence
