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

/// A tangential force F on an axisymmetric contact under a constant normal load W, with a slip ring c < r < a
/// (sphere: Cattaneo 1938, Mindlin 1949; any profile: Jaeger 1998, Ciavarella 1998). The traction is mu times
/// what the pressure would lose if the contact shrank to the stick radius, all of it along F:
///   q = mu (p(r; a) - p(r; c)), F = mu (W(a) - W(c)), delta = mu (G_n/G_t) (d(a) - d(c)),
/// with the combined moduli 1/G_t = sum (2 - nu_i)/(2 G_i) and 1/G_n = sum (1 - nu_i)/G_i of the two bodies
/// and p, W, d the pressure, load and approach of the same indenter at either radius. Exact for nu_i = 0,
/// where G_t = G_n is torsion's G; otherwise the slip across F in the ring is left out, which is not zero,
/// while q there has no such component. For similar bodies only (Dundurs' beta = 0).
///
/// Dimensionless: lengths over a, forces over mu W, displacement (of one body's far points against the
/// other's, along F) as G_t a delta/(mu W), energies over (mu W)^2/(G_t a).
namespace slipstick::analytic::tangential {

/// Number and complement are both carried, so that neither end of the range loses digits.
struct TangentialState {
  double force_ratio;        ///< F/(mu W)
  double force_deficit;      ///< 1 - F/(mu W)
  double stick_ratio;        ///< c/a
  double stick_complement;   ///< 1 - c/a
  double displacement;       ///< G_t a delta/(mu W), (n + 1)/(4 n) (1 - (c/a)^n) for a gap like r^n
  double tangent_stiffness;  ///< (dF/ddelta)/(G_t a) = 4 c/a, as for a bonded circle of radius c
};

/// The state at a given force; tangential_history.hpp has the tractions. Relative error of every member a few eps, plus
/// what an ulp of the argument costs. Throws std::domain_error, with the value and the range, outside [0, 1).
TangentialState from_force_ratio(double force_ratio, const SelfSimilarIndenter& indenter);

/// Energy lost in a cycle between F and -F, over (mu W)^2/(G_t a): four times the loss of the first loading
/// to F. For the sphere 9/5 (1 - L^(5/3) - 5/6 (1 - L)(1 + L^(2/3))) with L = 1 - F/(mu W) (Mindlin, Mason,
/// Osmer and Deresiewicz 1952). Relative error below 1e-13.
double energy_lost_per_cycle(const TangentialState& state, const SelfSimilarIndenter& indenter);

}  // namespace slipstick::analytic::tangential
