#include "convergence/check/loops/loop_judgement.hpp"

#include <fmt/core.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace slipstick::convergence {
namespace {

/// Allowed error of the moment that slip takes off, over the allowed error of the moment: at half of the
/// limit slip takes off about a tenth.
constexpr double kSlipOverLoad = 10.0;
/// Standard deviations that noise may explain.
constexpr double kSlipSigmas = 4.0;
/// kSlipSigmas of noise over the moment that slip takes off: with more noise a loop without loss could not be
/// distinguished from the exact one.
constexpr double kSlipShown = 0.8;
/// Variance of normal noise over its variance without the largest 2 %.
constexpr double kUntrimmed = 1.15;

/// Slope of a line through the origin, over the first rows up to a part of the loop's largest moment.
double slope_at_rest(const LoopPath& path, const std::vector<double>& moment) {
  const double enough = largest_of(path.moment) / 3.0;
  double above = 0.0;
  double below = 0.0;
  for (std::size_t row = 0; row <= path.turns[1] && std::abs(path.moment[row]) <= enough; ++row) {
    above += path.twist[row] * moment[row];
    below += path.twist[row] * path.twist[row];
  }
  return above / below;  // NaN: no row is near rest
}

/// Values less their straight line over the rotation.
Eigen::VectorXd without_line(const LoopPath& path, const Eigen::VectorXd& values) {
  const auto rows = static_cast<Eigen::Index>(path.twist.size());
  Eigen::VectorXd twist = Eigen::Map<const Eigen::VectorXd>(path.twist.data(), rows);
  twist.array() -= twist.mean();
  const Eigen::VectorXd left = values.array() - values.mean();
  return left - twist * (twist.dot(left) / twist.squaredNorm());
}

/// Slip makes the moment smaller than the stiffness at rest would. Finds by least squares, up to
/// any straight line, how much of that difference the record shows and how far its shape differs.
void judge_slip(LoopJudgement& judgement, const LoopPath& path, const LoopContact& contact) {
  const auto rows = static_cast<Eigen::Index>(path.twist.size());
  const auto map = [&](const std::vector<double>& values) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), rows));
  };
  const Eigen::VectorXd slip =
      without_line(path, contact.stiffness * map(path.twist) - map(judgement.exact.moment));
  const Eigen::VectorXd error = without_line(path, map(judgement.exact.moment) - map(path.moment));
  const double noise = judgement.noise * judgement.largest_load.value;
  const double part = slip.dot(error) / slip.squaredNorm();
  const double count = static_cast<double>(rows);
  const double by_noise = noise * noise * (kUntrimmed * count + kSlipSigmas * std::sqrt(4.0 * count));
  const double left = std::sqrt(std::max(0.0, (error - part * slip).squaredNorm() - by_noise));
  judgement.slip_error = std::hypot(part, left / slip.norm());
  judgement.slip_noise = noise / slip.norm();
}

std::string percent(double part) {
  return part < 1e-4 ? "under 0.01 %" : fmt::format("{:.2g} %", 100.0 * part);
}

/// A residual less the part that noise adds.
double without_noise(double residual, double noise) {
  return std::sqrt(std::max(0.0, residual * residual - noise * noise));
}

double noise_beside(const LoopPath& path, const LoopHypothesis& law) {
  std::vector<double> error;
  for (std::size_t row = 0; row < path.moment.size(); ++row)
    error.push_back(path.moment[row] - law.moment[row]);
  return row_noise(path, error);
}

/// The family of a law: laws that scale the exact curve are one family.
std::string family_of(const LoopHypothesis& law) {
  const bool scales = law.name == "limit" || law.name == "stiffness" || law.name == "factor";
  return scales ? "limit_and_stiffness" : law.name;
}

/// Root mean square distance of a law from the loop, less the part that noise adds.
double misfit(const LoopPath& path, const LoopHypothesis& law, double noise) {
  std::vector<double> error = law.moment;
  for (std::size_t row = 0; row < error.size(); ++row) error[row] -= path.moment[row];
  return without_noise(trimmed_mean(error), noise);
}

/// Residual of a law that explains the loop, over the tolerance. Rates of noisy rotations are off by percent.
double explained(const LoopHypothesis& law) {
  return law.name == "regularised" || law.name == "stribeck" || law.name == "viscous" ? 2.0 : 1.0;
}

/// Parameters, and the two numbers of a start that is not rest.
std::size_t unknowns(const LoopHypothesis& law) {
  const bool from_rest = law.start.shift == 0.0 && law.start.turned == 0.0;
  return law.parameters.size() + (from_rest ? 0 : 2);
}

/// A law of another family that explains the loop about as well, with no more unknowns; null: there is
/// none. noise: of the rows, by which both are off; 0 where the likeliest law is off by no more.
const LoopHypothesis* find_rival(const LoopPath& path, const std::vector<LoopHypothesis>& laws,
                                 const LoopHypothesis& likely, double noise) {
  constexpr double kLessLikely = 30.0;  // chi squared
  constexpr double kFurtherOff = 2.0;   // misfits, where it is not noise that makes them
  for (const LoopHypothesis& law : laws) {
    const bool is_other = family_of(law) != family_of(likely) && unknowns(law) <= unknowns(likely);
    if (!is_other || !std::isfinite(law.cost)) continue;
    const bool as_near = noise > 0.0 && misfit(path, law, noise) < kFurtherOff * misfit(path, likely, noise);
    if (as_near || law.cost < likely.cost + kLessLikely) return &law;
  }
  return nullptr;
}

/// The verdict's words on the energy lost.
std::string slip_text(const LoopJudgement& judgement) {
  if (!judgement.shows_slip()) {
    return fmt::format("; the record cannot show the energy lost: its noise is {:.2g} % of the largest load",
                       100.0 * judgement.noise);
  }
  const std::size_t loops = judgement.areas.size();
  if (loops == 0) return "";
  return fmt::format(", the energy lost in {} {} is right", loops, loops == 1 ? "loop" : "loops");
}

/// Compares a loop with the exact law from one of these starts.
LoopJudgement judge_from(const LoopPath& path, const LoopContact& contact, double tolerance,
                         const std::vector<LoopStart>& starts) {
  LoopJudgement judgement;
  judgement.exact = fit_exact_law(path, contact, starts);
  const std::vector<double>& exact = judgement.exact.moment;
  LoopPath own = path;
  for (double& m : own.moment) m -= judgement.exact.offset;
  for (double& t : own.twist) t += judgement.exact.start.shift;
  std::vector<double> held = exact;
  for (double& m : held) m -= judgement.exact.offset;
  judgement.residual = judgement.exact.residual;
  judgement.largest_load = {largest_of(own.moment), largest_of(held)};
  if (judgement.exact.start.turned == 0.0) {
    judgement.stiffness = {slope_at_rest(own, own.moment), slope_at_rest(own, held)};
  }
  const std::vector<double> areas = loop_areas(own, own.moment);
  const std::vector<double> exact_areas = loop_areas(own, held);
  for (std::size_t i = 0; i < areas.size(); ++i) judgement.areas.push_back({areas[i], exact_areas[i]});
  judgement.noise =
      std::max(noise_beside(path, judgement.exact) / judgement.largest_load.value, contact.law_error);
  judge_slip(judgement, path, contact);
  const double off = without_noise(judgement.residual, judgement.noise);
  judgement.good = off <= std::hypot(tolerance, 0.5 * judgement.noise) &&
                   judgement.slip_error <= kSlipOverLoad * tolerance + kSlipSigmas * judgement.slip_noise;
  if (!judgement.good) return judgement;
  judgement.law = "exact";
  judgement.why = fmt::format("follows the exact law: the {} is {} off in the mean{}", contact.words.load,
                              percent(judgement.residual), slip_text(judgement));
  return judgement;
}

}  // namespace

bool LoopJudgement::shows_slip() const { return slip_noise * kSlipSigmas <= kSlipShown; }

LoopJudgement judge_loop(const LoopPath& path, const LoopContact& contact, double tolerance) {
  const std::vector<LoopStart> starts = possible_starts(path);
  if (!begins_at_zero(path)) return judge_from(path, contact, tolerance, starts);
  LoopJudgement from_rest = judge_from(path, contact, tolerance, {{}});
  if (from_rest.good) return from_rest;
  LoopJudgement elsewhere = judge_from(path, contact, tolerance, starts);
  return elsewhere.good ? elsewhere : from_rest;
}

void explain(LoopJudgement& judgement, const LoopPath& path, const LoopContact& contact, double tolerance) {
  judgement.fitted = fit_wrong_laws(path, contact);
  const LoopHypothesis& likely = *std::ranges::min_element(judgement.fitted, {}, &LoopHypothesis::cost);
  const double noise = noise_beside(path, likely) / judgement.largest_load.value;
  constexpr double kAtNoise = 1.1;  // residual over noise, if it is only noise
  const bool at_noise = likely.residual <= kAtNoise * noise && likely.cost < judgement.exact.cost;
  const double off = without_noise(likely.residual, noise);
  const bool explains = at_noise || off <= explained(likely) * tolerance;
  const LoopHypothesis* const rival =
      explains
          ? find_rival(path, judgement.fitted, likely, at_noise ? 0.0 : noise * judgement.largest_load.value)
          : nullptr;
  const std::string found = fmt::format("the {} is {} off the exact law in the mean", contact.words.load,
                                        percent(judgement.residual));
  const std::string left = percent(likely.residual);
  if (explains && rival == nullptr) {
    judgement.law = likely.name;
    judgement.why = fmt::format("{} ({}, {} off this one)", likely.sentence, found, left);
  } else if (explains) {
    judgement.why = fmt::format("{}; two of the known laws explain it: {} ({} off), or {} ({} off)", found,
                                likely.sentence, left, rival->sentence, percent(rival->residual));
  } else {
    judgement.why = fmt::format("{} and follows none of the known laws; the nearest: {} ({} off)", found,
                                likely.sentence, left);
  }
}

}  // namespace slipstick::convergence
