#pragma once

#include <limits>

#include "solver/elasticity/law/half_spaces.hpp"

namespace slipstick::solver {

/// A layer that is bonded to a half-space. Without one the surface is the half-space itself.
struct CoatedBody {
  HalfSpace surface;                                           ///< the layer; a rigid one cannot be bonded
  double thickness = std::numeric_limits<double>::infinity();  ///< of the layer; infinite: there is none
  HalfSpace base = surface;                                    ///< below the layer; may be rigid
};

/// Wave number times displacement over traction of a surface under a wave of tractions. In a pair the members
/// add, except the coupling, which is the lower body's less the upper one's.
struct WaveCompliance {
  double across;    ///< along the surface, across the wave vector: pure shear waves
  double along;     ///< along the wave vector
  double normal;    ///< along the pressure
  double coupling;  ///< over i: along the wave vector, by a pressure
};

/// At a wave number above 0; an infinite one depends only on the surface layer. By the bonding constants of Burmister
/// (1945), as in O'Sullivan and King (Journal of Tribology 110, 1988). No exponential grows, denominators are sums of
/// positive terms, and differences that cancel on a thin layer are written as a series or by expm1.
WaveCompliance wave_compliance(const CoatedBody& body, double wave_number);

}  // namespace slipstick::solver
