#pragma once

#include <array>
#include <optional>

namespace slipstick::analytic::layered {

/// An isotropic elastic material.
struct Elastic {
  double shear_modulus;  ///< Pa; infinite: rigid
  double poisson_ratio;  ///< in (-1, 1/2]
};

/// A layer of one thickness, bonded to a half-space.
struct Coat {
  double thickness;  ///< m
  Elastic base;      ///< of the half-space below
};

/// A body: its material at the surface, and the base if the surface material is a layer.
struct Body {
  Elastic surface;
  std::optional<Coat> coat = {};
};

/// Two bodies that touch. Under a traction of wave number k their displacements are those of half-spaces,
/// made of the surface materials, times 1 + excess(k); the excess falls like exp(-2 k h).
class Pair {
 public:
  /// Throws std::domain_error unless moduli and thicknesses are positive, layers have finite ones, Poisson's
  /// ratios in (-1, 1/2], and at least one body coated.
  Pair(const Body& first, const Body& second);

  /// 1/E* = sum of (1 - nu)/(2 G) and 1/G = sum of 1/G, of the surface materials, Pa.
  double effective_modulus() const { return 1 / (normal_[0] + normal_[1]); }
  double shear_modulus() const { return 1 / (tangential_[0] + tangential_[1]); }
  /// The thinnest layer's, m.
  double thickness() const;

  /// By a pressure, without shear (Burmister 1945); wave number in 1/m.
  double normal_excess(double wave_number) const;
  /// By a shear traction across the wave vector, all that torsion about an axis sees: with reflection
  /// L = (G - G_base)/(G + G_base), a body's is 2 L exp(-2 k h)/(1 - L exp(-2 k h)).
  double torsional_excess(double wave_number) const;

 private:
  std::array<Body, 2> bodies_;
  std::array<double, 2> normal_{};      // (1 - nu)/(2 G), 1/Pa
  std::array<double, 2> tangential_{};  // 1/G, 1/Pa
};

}  // namespace slipstick::analytic::layered
