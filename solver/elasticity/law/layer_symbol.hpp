#pragma once

#include <optional>

#include "solver/elasticity/law/half_spaces.hpp"

namespace slipstick::solver {

/// A layer that is bonded to a half-space. Its shear modulus is finite.
struct BondedLayer {
  HalfSpace elastic;
  double thickness;
};

/// A half-space, and the layer on it if there is one. A rigid base is one of infinite shear modulus.
struct CoatedBody {
  HalfSpace base;
  std::optional<BondedLayer> layer = {};

  /// The constants of what is touched.
  const HalfSpace& surface() const { return layer ? layer->elastic : base; }
};

/// How a body's surface moves under a wave of tractions: wave number times displacement over traction. Those
/// of a half-space do not depend on the wave number.
struct WaveCompliance {
  double across = 0.0;    ///< along the surface, across the wave vector: shear waves alone
  double along = 0.0;     ///< along the wave vector
  double normal = 0.0;    ///< along the pressure
  double coupling = 0.0;  ///< over i: along the wave vector, by a pressure
};

/// Of a pair: compliances add up but in the coupling, which is the lower body's less the upper one's.
WaveCompliance of_pair(const WaveCompliance& lower, const WaveCompliance& upper);

/// A coated body at any wave number. The layer and the base follow the bonding constants of Burmister (1945),
/// as in O'Sullivan and King (Journal of Tribology 110, 1988): every term decays with the product x of wave
/// number and thickness, the denominator is a sum of positive terms, and what would cancel at small x is
/// written as a series or as the difference of the exponential from 1.
class LayerSymbol {
 public:
  explicit LayerSymbol(const CoatedBody& body);

  /// The body's compliance at a positive wave number.
  WaveCompliance whole(double wave_number) const;

  /// The same less that of a half-space of the layer's constants: zero without a layer, and where both are
  /// alike. It decays like exp(-2 x) times a polynomial of degree 2.
  WaveCompliance beyond_layer(double wave_number) const;

 private:
  struct Terms;
  Terms terms(double wave_number) const;

  bool coated_;
  double thickness_ = 0.0;
  WaveCompliance surface_;   ///< of a half-space of the surface's constants
  double shear_compliance_;  ///< 1/G1
  double along_;             ///< (1 - nu1)/G1
  double ratio_ = 0.0;       ///< mu = G1/G2
  double lambda_ = 0.0;      ///< (mu k2 - k1)/(1 + mu k2), k = 3 - 4 nu
  double kappa_ = 0.0;       ///< (mu - 1)/(mu + k1)
  double one_less_lambda_ = 0.0;
  double one_less_kappa_ = 0.0;
  double one_less_product_ = 0.0;  ///< 1 - lambda kappa
  double less_two_kappa_ = 0.0;    ///< 1 + lambda kappa - 2 kappa
  double plus_two_kappa_ = 0.0;    ///< 1 + lambda kappa + 2 kappa
  double base_coupling_ = 0.0;     ///< mu (1 - 2 nu2)
  double layer_coupling_ = 0.0;    ///< 1 - 2 nu1
};

}  // namespace slipstick::solver
