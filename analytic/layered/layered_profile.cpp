#include "analytic/layered/layered_profile.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "analytic/layered/panel_rule.hpp"

namespace slipstick::analytic::layered {
namespace {

using std::numbers::pi;

/// A stick radius c: chi = (2/pi) t H(max(t, c)), the half-space's, and within c a correction y = t z(t^2).
/// Lengths over a, pressures over p0, the friction and G are 1.
class Stick {
 public:
  Stick(const PressureIntegrals& pressure, const std::shared_ptr<const CosineTransform>& torsion,
        StickRadius c)
      : torsion_(torsion),
        c_(c),
        h_(pressure.integral(c)),
        ring_(pressure.beyond(c)),
        rule_(torsion->thickness() / c.ratio, torsion->resolution()),
        solutions_(
            solve_fredholm(torsion, Parity::odd, c.ratio,
                           {[](double t) { return 4 / pi * t; }, [this](double t) { return moved(t); }})),
        turn_(solutions_[1](c.ratio) / solutions_[0](c.ratio)) {
    const auto arm = [](double t) { return t; };
    stiffness_ = 4 * pi * solutions_[0].integral(arm);
    const double extra = turn_ * stiffness_ - 4 * pi * solutions_[1].integral(arm);
    twist_slope_ = (2 / pi * c.ratio * pressure.slope(c) + slope_at_front()) / solutions_[0](c.ratio);
    moment_ = 8.0 / 3 * c.ratio * c.ratio * c.ratio * h_ + extra;
    for (const auto& node : ring_) moment_ += 8 * node.weight * node.s.ratio * node.s.ratio * node.integral;
    // Within the least of the radii H is a logarithm and a constant.
    const double least = std::min(c.ratio, PressureIntegrals::kSmallest);
    const double log = pressure.integral({least, 1 - least}) - h_;
    deficit_ = 8.0 / 3 * least * least * least * (log + pressure.pressure(0) / 3) - extra;
    for (const auto& node : pressure.within(c))
      deficit_ += 8 * node.weight * node.s.ratio * node.s.ratio * (node.integral - h_);
  }

  double twist() const { return h_ / 2 + turn_; }      ///< G phi/mu
  double twist_slope() const { return twist_slope_; }  ///< -d twist/dc
  double moment() const { return moment_; }
  double deficit() const { return deficit_; }  ///< of the limit moment
  double stiffness() const { return stiffness_; }

  /// The correction's part of q at r < c, -r integral_r^c 2 t z'(t^2)/sqrt(t^2 - r^2) dt.
  double traction(double radius, double inward) const {
    std::call_once(once_, [&] { front_.emplace(front()); });
    return radius * std::sqrt(inward * (c_.ratio + radius)) * (*front_)(radius * radius);
  }

  /// Energy lost in a first loading, pi^2 integral_c^1 chi v dt with v = (4/pi) twist t - chi - K chi.
  double energy_lost() const {
    double sum = 0;
    for (const auto& at : ring_) {
      const double t = at.s.ratio;
      double lag = 4 / pi * twist() * t - moved(t);
      for (std::size_t i = 0; i < solutions_[0].nodes.size(); ++i) {
        const auto& [s, weight, bonded] = solutions_[0].nodes[i];
        const double y = turn_ * bonded - solutions_[1].nodes[i].value;
        lag -= weight * kernel(*torsion_, Parity::odd, t, s) * y;
      }
      const double chi = 2 / pi * t * at.integral;
      sum += at.weight * chi * (lag - chi);
    }
    return pi * pi * sum;
  }

 private:
  /// integral_0^1 K(t, s) chi(s) ds of the half-space's chi.
  double moved(double t) const {
    double sum = h_ * rule_([&](double s) { return kernel(*torsion_, Parity::odd, t, s) * s; }, c_.ratio);
    for (const auto& node : ring_)
      sum += node.weight * kernel(*torsion_, Parity::odd, t, node.s.ratio) * node.s.ratio * node.integral;
    return 2 / pi * sum;
  }

  ChebyshevPanels z(const std::vector<double>& ends) const {
    return {[&](double square) {
              const double t = std::sqrt(square);
              return (turn_ * solutions_[0](t) - solutions_[1](t)) / t;
            },
            ends, static_cast<std::size_t>(kTerms * torsion_->resolution())};
  }

  /// y'(c) = 2 c^2 z'(c^2), since z(c^2) = 0.
  double slope_at_front() const {
    const std::vector<double> ends = squared_ends(c_.ratio, torsion_->thickness());
    return 2 * ends.back() * z({*(ends.end() - 2), ends.back()}).derivative()(ends.back());
  }

  ChebyshevPanels front() const {
    const std::vector<double> ends = squared_ends(c_.ratio, torsion_->thickness());
    const ChebyshevPanels slope = z(ends).derivative();
    return {[&](double y) {
              const double inside = ends.back() - y;
              return -2 * rule_([&](double t) { return slope(y + inside * t * t); });
            },
            ends, static_cast<std::size_t>(kTerms * torsion_->resolution())};
  }

  std::shared_ptr<const CosineTransform> torsion_;
  StickRadius c_;
  double h_;
  std::vector<PressureIntegrals::Node> ring_;
  PanelRule rule_;
  std::vector<Solution> solutions_;  // of a unit twist, and of what the half-space's chi moves
  double turn_;                      // twist beyond the half-space's
  double twist_slope_ = 0;
  double stiffness_ = 0;
  double moment_ = 0;
  double deficit_ = 0;
  mutable std::once_flag once_;
  mutable std::optional<ChebyshevPanels> front_;
};

class LayeredProfile final : public Profile {
 public:
  using Numbers = Constants;
  LayeredProfile(Numbers constants, const PressureIntegrals& pressure,
                 std::shared_ptr<const CosineTransform> torsion)
      : Profile(std::move(constants)), pressure_(pressure), torsion_(std::move(torsion)) {}

  double pressure(double radius) const override { return pressure_.pressure(radius); }
  double twist_integral(StickRadius c) const override { return 2 * stick(c)->twist(); }
  double twist_slope(StickRadius c) const override { return 2 * c.ratio * stick(c)->twist_slope(); }

  MomentShare moment_share(StickRadius c) const override {
    const double limit = load() * moment_limit();
    const double deficit = stick(c)->deficit() / limit;
    if (deficit < 0.5 * slip_share()) return {.excess = slip_share() - deficit, .deficit = deficit};
    const double excess = stick(c)->moment() / limit - full_stick();
    return {.excess = excess, .deficit = slip_share() - excess};
  }

  double stick_traction(StickRadius c, double radius, double inward) const override {
    return 2 / pi * radius * pressure_.punches(c, radius, inward) + stick(c)->traction(radius, inward);
  }
  double bonded_traction(double radius) const override { return stick_traction({1, 0}, radius, 1 - radius); }
  double bonded_stiffness(StickRadius c) const override {
    return stick(c)->stiffness() / (c.ratio * c.ratio * c.ratio);
  }

  std::optional<SlipPart> slip_part(StickRadius c) const override {
    const auto state = stick(c);
    return SlipPart{.twist = (state->twist() - state->moment() / bonded_stiffness({1, 0})) / load(),
                    .energy_lost = 4 * state->energy_lost() / (load() * load())};
  }

 private:
  std::shared_ptr<const Stick> stick(StickRadius c) const {
    constexpr std::size_t kMostKept = 200;  // a search for a load asks for ten, a history's branches again
    const std::scoped_lock lock(mutex_);
    const auto key = std::pair(c.ratio, c.complement);
    const auto known = sticks_.find(key);
    if (known != sticks_.end()) return known->second;
    if (sticks_.size() >= kMostKept) sticks_.clear();
    return sticks_[key] = std::make_shared<const Stick>(pressure_, torsion_, c);
  }

  PressureIntegrals pressure_;
  std::shared_ptr<const CosineTransform> torsion_;
  mutable std::mutex mutex_;
  mutable std::map<std::pair<double, double>, std::shared_ptr<const Stick>> sticks_;
};

}  // namespace

std::unique_ptr<const Profile> layered_profile(const std::string& name, const std::string& reference_pressure,
                                               const PressureIntegrals& pressure,
                                               const CosineTransform& torsion) {
  const auto transform = std::make_shared<const CosineTransform>(torsion);
  double edge = 0;
  double full_stick = 0;
  if (pressure.edge() > 0) {
    const Stick full(pressure, transform, {1, 0});
    edge = 2 * full.twist();
    full_stick = full.moment() / pressure.moment_limit();
  }
  return std::make_unique<const LayeredProfile>(
      LayeredProfile::Numbers{.name = name,
                              .reference_pressure = reference_pressure,
                              .load = pressure.load(),
                              .moment_limit = pressure.moment_limit() / pressure.load(),
                              .edge = edge,
                              .slip_share = 1 - full_stick},
      pressure, transform);
}

}  // namespace slipstick::analytic::layered
