#include "analytic/tangential_history.hpp"

#include <algorithm>

#include "analytic/gsl.hpp"
#include "analytic/out_of_range.hpp"

namespace slipstick::analytic::tangential {

void TangentialHistory::load_to(double normal_load, double force) {
  require_positive("W/W_0", normal_load);
  if (!(std::abs(force) < normal_load))
    throw std::domain_error(fmt::format("F/(mu W_0) = {}{}; allowed: |F| < mu W, W/W_0 = {}", force,
                                        std::isnan(force) ? "" : " is gross slip", normal_load));
  while (const auto ring = ring_that_ends_before(normal_load, force)) {
    const double share = (ring->front - this->normal_load()) / (normal_load - this->normal_load());
    dissipated_ += energy_lost(*ring, ring->front);
    force_ = std::lerp(force_, force, share);
    cut_down_to(ring->front);
  }
  const double growth = normal_load - this->normal_load();
  const double change = force - force_;
  if (growth == 0 && change == 0) return;
  force_ = force;
  if (growth > 0 && std::abs(change) <= growth) {
    layers_.push_back({.load = normal_load, .share = change / growth});
    return;
  }
  TangentialHistory after = *this;
  if (growth > 0) after.layers_.push_back({.load = normal_load, .share = 0});  // all of it will slip
  if (growth < 0) after.cut_down_to(normal_load);
  const Slip slip = after.slip_inwards(force - after.force_between(0, normal_load));
  after.dissipated_ += energy_lost(slip, normal_load);
  *this = std::move(after);
}

std::optional<TangentialHistory::Slip> TangentialHistory::ring_that_ends_before(double normal_load,
                                                                                double force) const {
  const double start = this->normal_load();
  // The force that the ring lacks once the load has fallen so far; linear within a layer.
  const auto missing = [&](double load) {
    return (force - force_) * ((load - start) / (normal_load - start)) + force_between(load, start);
  };
  double outer = start;
  for (std::size_t i = layers_.size(); i-- > 0 && outer > normal_load;) {
    const double inner = std::max(normal_load, inner_load(i));
    const double before = missing(outer);
    const double after = missing(inner);
    if (outer < start && before * after < 0)
      return Slip{.front = std::lerp(outer, inner, before / (before - after)), .direction = std::copysign(1, before)};
    outer = inner;
  }
  return std::nullopt;
}

double TangentialHistory::force_between(double low, double high) const {
  double force = 0;
  for (std::size_t i = 0; i < layers_.size(); ++i)
    force += layers_[i].share * std::max(0.0, std::min(high, layers_[i].load) - std::max(low, inner_load(i)));
  return force;
}

void TangentialHistory::cut_down_to(double normal_load) {
  while (inner_load(layers_.size() - 1) >= normal_load) layers_.pop_back();
  layers_.back().load = normal_load;
}

TangentialHistory::Slip TangentialHistory::slip_inwards(double missing_force) {
  const double edge = normal_load();
  const double direction = std::copysign(1, missing_force);
  double missing = std::abs(missing_force);
  double front = edge;
  while (!layers_.empty()) {
    const double gain = 1 - direction * layers_.back().share;
    const double inner = inner_load(layers_.size() - 1);
    if (missing < gain * (front - inner)) {
      front -= missing / gain;
      layers_.back().load = front;
      break;
    }
    missing -= gain * (front - inner);
    front = inner;
    layers_.pop_back();
  }
  layers_.push_back({.load = edge, .share = direction});
  return {.front = front, .direction = direction};
}

/// While the front passes a punch of radius c every larger one, out to the edge of that moment, loses to
/// friction its load less what it has in common with the punch c, times the slip.
double TangentialHistory::energy_lost(const Slip& slip, double normal_load) const {
  const double start = this->normal_load();
  // The force that the front has gained says how far the step has come, and so what the load is.
  const auto gained = [&](double front) { return (start - front) - slip.direction * force_between(front, start); };
  const double whole = gained(slip.front);
  const double power = indenter_.radius_power();
  if (!(whole > 0) || power == 0) return 0;
  const auto lost_at = [&](double radius) {
    const double front = std::pow(radius, 1 / power);
    const double load = std::lerp(start, normal_load, gained(front) / whole);
    const double lost = load - front - 2 * radius * (indenter_.approach(load) - indenter_.approach(front));
    return lost * std::pow(radius, 1 / power - 2) / (4 * power);
  };
  double sum = 0;
  for (std::size_t i = layers_.size(); i-- > 0 && layers_[i].load > slip.front;)
    sum += (1 - slip.direction * layers_[i].share) *
           gsl::gauss_legendre(lost_at, indenter_.contact_radius(std::max(slip.front, inner_load(i))),
                               indenter_.contact_radius(layers_[i].load));
  return sum;
}

HistoryState TangentialHistory::state() const {
  HistoryState state{.normal_load = normal_load(),
                     .force = force_,
                     .contact_radius = indenter_.contact_radius(normal_load()),
                     .stick_radius = indenter_.contact_radius(normal_load()),
                     .displacement = 0,
                     .tangent_stiffness = 0,
                     .dissipated = dissipated_};
  for (std::size_t i = 0; i < layers_.size(); ++i)
    state.displacement +=
        layers_[i].share / 2 * (indenter_.approach(layers_[i].load) - indenter_.approach(inner_load(i)));
  if (!layers_.empty() && std::abs(layers_.back().share) == 1)
    state.stick_radius = indenter_.contact_radius(inner_load(layers_.size() - 1));
  state.tangent_stiffness = 4 * state.stick_radius;
  return state;
}

double TangentialHistory::traction(double radius) const {
  if (!(radius >= 0)) out_of_range("r/a_0", radius, "0 or more");
  double sum = 0;
  for (std::size_t i = 0; i < layers_.size(); ++i)
    sum += layers_[i].share * (indenter_.pressure(layers_[i].load, radius) - indenter_.pressure(inner_load(i), radius));
  if (!std::isfinite(sum)) out_of_range("r/a_0", radius, "where the pressure is finite");
  return sum;
}

}  // namespace slipstick::analytic::tangential
