#include "analytic/self_similar_indenter.hpp"

#include <cmath>

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

}  // namespace slipstick::analytic
