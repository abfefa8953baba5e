#pragma once

#include <optional>

#include "analytic/certified/ball.hpp"

/// The torsional contact in balls, to the precision in force: what certified.hpp prints.
/// Lengths over the contact radius, a = mu = G = p0 = 1.
namespace slipstick::analytic::certified {

/// A pressure at the precision in force. A sphere is the power law n = 2, a cone n = 1.
///
/// Each pressure is a sum of flat punches, and so are its moment and twist (Jaeger 1995). With K(s) the
/// complete elliptic integral of modulus sqrt(1 - s^2) and
///   J(c) = integral_c^1 s^2 K ds,  J(0) = pi^2/16,  H(c) = integral_c^1 x^(n-2) K(c/x) dx  (flat punch:
///   K(c))
/// they are  M/M_lim = (J + share c^3 H/3)/J(0),  twist = H/(2 W),
/// and with  e = -c H' = K - (n - 1) H  (flat punch: -c K')  the slope is  -(M/M_lim)' = weight/3 c^2 e/J(0).
/// A constant bound has elementary functions: with v = sqrt(1 - c^2), H = ln((1 + v)/c), e = 1/v and
/// M/M_lim = (2/pi)(arccos c + c v).
struct Law {
  Law(Kind kind, const Rational& exponent);

  bool punch() const { return kind == Kind::flat_punch; }
  bool constant() const { return kind == Kind::constant; }
  /// M_lim/(mu W a)
  Ball moment_limit() const;
  /// M/M_lim at which slip begins: 0 but for a flat punch, which sticks everywhere up to here.
  Ball onset() const;

  Kind kind;
  Ball n;
  Ball share;
  Ball weight;
  Ball load;  ///< W
};

/// The stick ratio c and 1 - c, so that neither end loses digits.
struct Stick {
  explicit Stick(const Rational& c);
  /// From y = ln((1 - c)/c).
  explicit Stick(const Ball& logit);

  /// sqrt(1 - c^2)
  Ball root() const { return sqrt(complement * (1 + ratio)); }

  /// -ln c
  Ball depth() const;
  /// c - r
  Ball beyond(const Rational& radius) const;

  Ball ratio;
  Ball complement;
  std::optional<Rational> exactly;
};

/// H
Ball twist_integral(const Law& law, const Stick& stick);

struct Moment {
  Ball ratio;    ///< M/M_lim
  Ball deficit;  ///< 1 - M/M_lim
};
Moment moment_at(const Law& law, const Stick& stick, const Ball& twist_integral);

/// q/(mu p0); none if the precision is too low to separate stick from slip.
std::optional<Ball> traction(const Law& law, const Stick& stick, const Rational& radius);

/// quantity = value, of a pressure.
struct Equation {
  Kind kind;
  Rational exponent;
  Quantity quantity;
  Rational value;
};

/// The stick ratio that fulfils it, proven, beyond the onset of slip: of a twist or the lesser of
/// moment_ratio (over its onset) and moment_deficit. None if the precision is too low.
std::optional<Stick> solve(const Equation& equation);

}  // namespace slipstick::analytic::certified
