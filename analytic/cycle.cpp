#include "analytic/cycle.hpp"

#include <fmt/core.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "analytic/gsl.hpp"

namespace slipstick::analytic {

namespace {

/// integral_c^1 s^2 (H(c) - H(s)) weight(s) ds.
template <class Weight>
double slip_integral(const Profile& profile, StickRadius c, double relative, Weight weight) {
  if (c.complement == 0) return 0;
  // s = 1 - (1 - c) t keeps the digits of 1 - s, and the gain over H(c) keeps the digits of the smallest loads.
  const double deep = profile.twist_integral(c);
  const double integral = gsl::integral(
      [&](double t) {
        const StickRadius s{.ratio = (1 - t) + c.ratio * t, .complement = c.complement * t};
        return s.ratio * s.ratio * (profile.twist_gain(c, s) / deep) * weight(s);
      },
      0, 1, relative);
  return integral * deep * c.complement;
}

StickRadius stick_radius(const TorsionState& state) {
  return {.ratio = state.stick_ratio, .complement = state.stick_complement};
}

/// The twist that slip adds on first loading. Without slip the twist would be (3/16) M; by parts,
/// M = (8/3) mu (c^3 H(c) + 3 integral_c^1 s^2 H(s) ds), and the difference of the two is one integral.
double slip_twist(const TorsionState& state, const Profile& profile) {
  if (const auto part = profile.slip_part(stick_radius(state))) return part->twist;
  return 3 / (2 * profile.load()) * slip_integral(profile, stick_radius(state), 1e-14, [](StickRadius) { return 1.0; });
}

}  // namespace

void LoadingHistory::load_to(double moment_ratio) {
  if (!(std::abs(moment_ratio) < 1))
    throw std::domain_error(fmt::format("M/M_lim = {}{}; allowed: -1 < M/M_lim < 1", moment_ratio,
                                        std::isnan(moment_ratio) ? "" : " is gross slip"));
  if (turns_towards(moment_ratio)) turning_points_.push_back(moment_ratio_);
  while (closes_loop_at(moment_ratio)) close_loop();
  moment_ratio_ = moment_ratio;
}

bool LoadingHistory::turns_towards(double moment_ratio) const {
  const double start = turning_points_.empty() ? 0 : turning_points_.back();
  if (moment_ratio == moment_ratio_ || moment_ratio_ == start) return false;
  return (moment_ratio > moment_ratio_) != (moment_ratio_ > start);
}

bool LoadingHistory::closes_loop_at(double moment_ratio) const {
  if (turning_points_.empty()) return false;
  const double start = turning_points_.back();
  // The oldest reversal left the first-loading curve, which the branch meets again at its mirror image.
  const double end = turning_points_.size() == 1 ? -start : *(turning_points_.end() - 2);
  return end > start ? moment_ratio >= end : moment_ratio <= end;
}

void LoadingHistory::close_loop() {
  // The loop of the oldest reversal has its other half on the first-loading curve.
  const std::size_t last = turning_points_.size() - 1;
  lost_in_closed_loops_ += energy_lost_per_cycle(branch(last).amplitude, *profile_) / (last == 0 ? 2 : 1);
  turning_points_.resize(last == 0 ? 0 : last - 1);
}

/// The branch from the reversal before `index` to that at `index`, or, behind the last, to where it stands.
LoadingHistory::Branch LoadingHistory::branch(std::size_t index) const {
  const double end = index < turning_points_.size() ? turning_points_[index] : moment_ratio_;
  if (index == 0) return {.weight = std::copysign(1, end), .amplitude = std::abs(end)};
  const double change = end - turning_points_[index - 1];
  return {.weight = std::copysign(2, change), .amplitude = std::abs(change) / 2};
}

std::vector<LoadingHistory::Branch> LoadingHistory::branches() const {
  std::vector<Branch> list;
  for (std::size_t i = 0; i <= turning_points_.size(); ++i) list.push_back(branch(i));
  return list;
}

CycleState LoadingHistory::state() const {
  const double moment = moment_ratio_ * profile_->moment_limit();
  CycleState state{.moment_ratio = moment_ratio_,
                   .moment = moment,
                   .twist = moment / profile_->bonded_stiffness({.ratio = 1, .complement = 0}),
                   .stick_ratio = 1,
                   .tangent_stiffness = 0,
                   .dissipated = lost_in_closed_loops_};
  for (const auto& [weight, amplitude] : branches()) {
    const TorsionState loaded = from_moment_ratio(amplitude, *profile_);
    state.twist += weight * slip_twist(loaded, *profile_);
    state.dissipated += std::abs(weight) * energy_lost_per_cycle(loaded, *profile_) / 4;
    state.stick_ratio = loaded.stick_ratio;
    state.tangent_stiffness = loaded.tangent_stiffness;
  }
  return state;
}

double LoadingHistory::traction(double radius) const {
  double sum = 0;
  for (const auto& [weight, amplitude] : branches())
    sum += weight * analytic::traction(from_moment_ratio(amplitude, *profile_), radius, *profile_);
  return sum;
}

std::vector<CycleState> loading_curve(const std::vector<double>& turning_points, int points_per_branch,
                                      const Profile& profile) {
  if (points_per_branch < 1)
    throw std::domain_error(fmt::format("points_per_branch = {}; allowed: 1 or more", points_per_branch));
  LoadingHistory history(profile);
  std::vector<CycleState> curve{history.state()};
  for (const double end : turning_points) {
    const double start = history.moment_ratio();
    for (int i = 1; i <= points_per_branch; ++i) {
      const double share = std::pow(std::sin(std::numbers::pi / 2 * i / points_per_branch), 2);
      history.load_to(std::lerp(start, end, share));  // exactly `end` for 1
      curve.push_back(history.state());
    }
  }
  return curve;
}

double energy_lost_per_cycle(double moment_ratio, const Profile& profile) {
  return energy_lost_per_cycle(from_moment_ratio(moment_ratio, profile), profile);
}

/// The loop's area is 8 integral M dphi - 4 M phi over the first loading, which cancels; with M as in
/// slip_twist, and by parts, (16/load^2) integral_c^1 s^2 H(s) (H(c) - H(s)) ds, which does not.
double energy_lost_per_cycle(const TorsionState& state, const Profile& profile, double relative) {
  if (const auto part = profile.slip_part(stick_radius(state))) return part->energy_lost;
  return 16 / (profile.load() * profile.load()) *
         slip_integral(profile, stick_radius(state), relative,
                       [&](StickRadius s) { return profile.twist_integral(s); });
}

double energy_lost_per_small_cycle(double moment_ratio, const Profile& profile) {
  const double slope = profile.twist_slope({.ratio = 1, .complement = 0});
  if (profile.edge() > 0 || !(slope > 0 && std::isfinite(slope)))
    throw std::domain_error(
        fmt::format("{}: -H'(1) = {}, H(1) = {}: no cubic law of small cycles; allowed: -H'(1) > 0, H(1) = 0",
                    profile.name(), slope, profile.edge()));
  const double moment = from_moment_ratio(moment_ratio, profile).moment;
  return 9.0 / 64 * profile.load() / slope * moment * moment * moment;
}

}  // namespace slipstick::analytic
