#pragma once

#include <memory>

#include "analytic/axisymmetric.hpp"

namespace slipstick::analytic {

/// Indenter whose gap grows like r^n, so that its contact at one normal load is an enlargement of that at any
/// other (n = 2: sphere or paraboloid, 1: cone, infinity: flat punch). Dimensionless: loads over a reference
/// load W_0, lengths over the contact radius a_0 under W_0, pressures over the profile's p0 under W_0.
class SelfSimilarIndenter {
 public:
  /// Throws std::domain_error outside n in [0.01, 1000] and infinity.
  explicit SelfSimilarIndenter(double gap_exponent = 2);

  /// The profile under W_0, which defines p0.
  const Profile& profile() const { return *profile_; }
  /// 1/(n + 1): the power of the load that the contact radius follows.
  double radius_power() const { return radius_power_; }

  /// a/a_0 = (W/W_0)^(1/(n + 1)); loads are not negative here and below.
  double contact_radius(double load) const;
  /// The approach d as E* a_0 d/W_0, (n + 1)/(2 n) (W/W_0)^(n/(n + 1)).
  double approach(double load) const;
  /// p/p0 at radius r/a_0 >= 0: 0 outside the contact, infinite where the pressure is.
  double pressure(double load, double radius) const;

 private:
  std::shared_ptr<const Profile> profile_;
  double radius_power_;
};

}  // namespace slipstick::analytic
