#include "analytic/cattaneo_mindlin.hpp"

#include "analytic/gsl.hpp"
#include "analytic/out_of_range.hpp"
#include "analytic/punch_superposition.hpp"

namespace slipstick::analytic {

namespace {

/// In closed form where there is one.
std::shared_ptr<const Profile> profile_of_gap(double exponent) {
  const auto borrow = [](const Profile& profile) {
    return std::shared_ptr<const Profile>(std::shared_ptr<const Profile>(), &profile);
  };
  if (exponent == 1) return borrow(cone_profile());
  if (exponent == 2) return borrow(hertz_profile());
  if (std::isinf(exponent) && exponent > 0) return borrow(flat_punch_profile());
  return power_profile(exponent);
}

}  // namespace

SelfSimilarIndenter::SelfSimilarIndenter(double gap_exponent)
    : profile_(profile_of_gap(gap_exponent)), radius_power_(1 / (gap_exponent + 1)) {}

double SelfSimilarIndenter::contact_radius(double load) const { return std::pow(load, radius_power_); }

double SelfSimilarIndenter::approach(double load) const {
  return std::pow(load, 1 - radius_power_) / (2 * (1 - radius_power_));
}

double SelfSimilarIndenter::pressure(double load, double radius) const {
  const double contact = contact_radius(load);
  if (!(radius <= contact) || load == 0) return 0;
  return std::pow(load, 1 - 2 * radius_power_) * profile_->pressure(radius / contact);
}

namespace tangential {

TangentialState from_force_ratio(double force_ratio, const SelfSimilarIndenter& indenter) {
  if (!(force_ratio >= 0 && force_ratio < 1)) out_of_range("F/(mu W)", force_ratio, "0 <= F/(mu W) < 1");
  // Each member is a power of 1 - F/(mu W).
  const double log_deficit = std::log1p(-force_ratio);
  const double power = indenter.radius_power();
  const double stick = std::exp(power * log_deficit);
  return {.force_ratio = -std::expm1(log_deficit),
          .force_deficit = std::exp(log_deficit),
          .stick_ratio = stick,
          .stick_complement = -std::expm1(power * log_deficit),
          .displacement = -std::expm1((1 - power) * log_deficit) / (4 * (1 - power)),
          .tangent_stiffness = 4 * stick};
}

/// The loop's area by the slip that each punch of the superposition sees, (n + 1)^2/n^2 times
/// integral_c^1 (1 - t^n)(t^n - c^n) dt: no term is negative.
double energy_lost_per_cycle(const TangentialState& state, const SelfSimilarIndenter& indenter) {
  const double slip = state.stick_complement;
  if (slip == 0) return 0;
  const double power = indenter.radius_power();
  const double n = (1 - power) / power;
  const double log_stick = std::log1p(-slip);
  const double integral = gsl::integral(
      [&](double share) {
        const double log_t = std::log1p(-slip * share);
        return std::expm1(n * log_t) * std::exp(n * log_t) * std::expm1(n * (log_stick - log_t));
      },
      0, 1);
  return integral * slip / ((1 - power) * (1 - power));
}

}  // namespace tangential

}  // namespace slipstick::analytic
