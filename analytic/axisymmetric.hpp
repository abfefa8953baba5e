#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace slipstick::analytic {

/// The stick radius over the contact radius, c = a_s/a, and 1 - c: near either end one of them carries digits
/// that the other cannot.
struct StickRadius {
  /// c - r.
  double beyond(double r) const { return ratio < 0.5 ? ratio - r : (1 - r) - complement; }

  double ratio;
  double complement;
};

/// The moment over M_lim, split so that neither end cancels: M/M_lim = full_stick + excess = 1 - deficit.
struct MomentShare {
  double excess;   ///< beyond what full stick carries (all of M/M_lim where the pressure is finite at the edge)
  double deficit;  ///< 1 - M/M_lim
};

/// The effect of slip on first loading, dimensionless as in torsion.hpp and cycle.hpp: the twist less the
/// twist of full stick at the same moment, and the energy lost in a cycle of this amplitude.
struct SlipPart {
  double twist;
  double energy_lost;
};

/// An axisymmetric contact: its pressure p(r), and the functions of it that torsion needs. Lengths over the contact
/// radius a, pressure over a reference p0 (each profile says which), combined modulus G, friction mu. With
///   H(s) = integral_s^1 p(r)/sqrt(r^2 - s^2) dr
/// superposed twists of flat punches of radii c..1 (Jaeger 1995) are the slip-stick solution: twist
/// phi = mu H(c)/(2 G), moment M = (8/3) mu (integral_c^1 s^3 (-H'(s)) ds + H(1)), stick-zone traction
/// q = (2/pi) mu r (integral_c^1 -H'(s)/sqrt(s^2 - r^2) ds + H(1)/sqrt(1 - r^2)). Bodies other than
/// half-spaces have the same functions with their own twist: their H(c) is 2 G phi/mu.
class Profile {
 public:
  virtual ~Profile() = default;
  Profile(const Profile&) = delete;
  Profile& operator=(const Profile&) = delete;

  const std::string& name() const { return constants_.name; }
  /// p0 in words.
  const std::string& reference_pressure() const { return constants_.reference_pressure; }
  /// W/(p0 a^2).
  double load() const { return constants_.load; }
  /// M_lim/(mu W a).
  double moment_limit() const { return constants_.moment_limit; }
  /// H(1): not zero only where the pressure grows at the edge like 1/sqrt(1 - r^2), as under a flat punch.
  double edge() const { return constants_.edge; }
  /// Largest M/M_lim at which everything sticks, (8/3) H(1) over M_lim; and the effect of slip, to all digits.
  double full_stick() const { return 1 - slip_share(); }
  double slip_share() const { return constants_.slip_share; }

  /// p(r)/p0, r in [0, 1]; infinite where the profile's pressure is.
  virtual double pressure(double radius) const = 0;
  /// H(c).
  virtual double twist_integral(StickRadius stick) const = 0;
  /// -c H'(c): the slope of H in -ln c, and 3/8 c^-2 that of M in -c. A few digits do, for Newton steps; all
  /// of them near c = 1 where there is an edge term, since differences of H are integrals of this there.
  virtual double twist_slope(StickRadius stick) const = 0;
  /// H(c) - H(s), c <= s, to all digits, also where both are near H(1) > 0.
  double twist_gain(StickRadius c, StickRadius s) const;
  /// Moment at the stick radius c.
  virtual MomentShare moment_share(StickRadius stick) const = 0;
  /// q/(mu p0) at r < c, c < 1 or without an edge term. `inward` is c - r, given apart since it may be tiny.
  virtual double stick_traction(StickRadius stick, double radius, double inward) const = 0;

  /// q/(mu p0) where the edge begins to slip, r < 1; zero without an edge term.
  virtual double bonded_traction(double radius) const;
  /// dM/dphi over G a_s^3, the stiffness of a bonded flat punch of the stick radius (half-spaces: Reissner
  /// and Sagoci 1944).
  virtual double bonded_stiffness(StickRadius) const { return 16.0 / 3; }
  /// g(s) of the pressure as a sum of flat punches (Sneddon 1965),
  ///   p(r)/p0 = integral_r^1 g(s)/sqrt(s^2 - r^2) ds + (2/pi) H(1)/sqrt(1 - r^2).
  /// NaN: only a bound of the traction is known.
  virtual double punch_density(StickRadius s) const;
  /// Radii in (0, 1), rising, at which H' and g are not smooth, or fall steeply from there on.
  virtual std::vector<double> kinks() const { return {}; }
  /// None: that of half-spaces, which cycle.hpp has by integrals of H.
  virtual std::optional<SlipPart> slip_part(StickRadius) const { return std::nullopt; }

 protected:
  /// The values of the functions of the same names.
  struct Constants {
    std::string name;
    std::string reference_pressure;
    double load;
    double moment_limit;
    double edge = 0;
    double slip_share = 1;
  };
  explicit Profile(Constants constants) : constants_(std::move(constants)) {}

 private:
  Constants constants_;
};

/// p0 sqrt(1 - r^2), p0 the peak: sphere or paraboloid (Hertz). -H' = E/s, modulus sqrt(1 - s^2).
const Profile& hertz_profile();
/// p0 arcosh(1/r), p0 the mean: cone (Love 1939). -H' = K/s.
const Profile& cone_profile();
/// p0/sqrt(1 - r^2), p0 at the centre, half the mean: flat punch (Boussinesq). H = K, H(1) = pi/2, so that it
/// sticks everywhere until M = (2/3) mu W a. -H' = (E - s^2 K)/((1 - s^2) s).
const Profile& flat_punch_profile();

}  // namespace slipstick::analytic
