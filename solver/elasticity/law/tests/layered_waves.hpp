#pragma once

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>

#include "solver/elasticity/law/layer_symbol.hpp"

/// The answer of coated bodies to waves by another way than the law's: amplitudes of the solutions of
/// Navier's equations in layer and base, from the conditions at the surface and the interface, in extended
/// precision.
namespace slipstick::solver::testing_waves {

using Real = long double;

/// Displacements (along the wave vector over i, into the body) and tractions on the plane at depth z.
struct State {
  Real u, w, shear, pressure;
};

/// The gradient of psi = exp(s k z), or the solution of Papkovich and Neuber with psi along the depth, times
/// exp(-shift) and with k = 1.
inline State wave_solution(const HalfSpace& body, int sign, bool second, Real z, Real shift) {
  const Real s = sign;
  const Real g = body.shear_modulus;
  const Real nu = body.poisson_ratio;
  const Real psi = std::exp(s * z - shift);
  const Real c = 4.0L - 4.0L * nu;
  const Real u = second ? z * psi : psi;
  const Real w = second ? (1.0L + s * z - c) * psi : s * psi;
  const Real du = second ? (1.0L + s * z) * psi : s * psi;
  const Real dw = second ? (2.0L * s + z - c * s) * psi : psi;
  const Real volume = second ? -4.0L * g * nu * s * psi : 0.0L;  // lambda times the divergence
  return {u, w, -g * (du + w), -(volume + 2.0L * g * dw)};
}

/// Compliances times the wave number, x the product of wave number and thickness.
inline WaveCompliance wave_reference(const CoatedBody& body, Real x) {
  const bool rigid = std::isinf(body.base.shear_modulus);
  const int size = rigid ? 4 : 6;
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> conditions(size, size);
  conditions.setZero();
  const HalfSpace& layer = body.layer->elastic;
  const auto set_column = [&](int column, const State& top, const State& bottom) {
    const std::array all{top.shear, top.pressure, bottom.u, bottom.w, bottom.shear, bottom.pressure};
    for (int i = 0; i < size; ++i) conditions(i, column) = all[static_cast<std::size_t>(i)];
  };
  for (int i = 0; i < 4; ++i) {
    const int sign = i < 2 ? -1 : 1;
    const Real shift = sign > 0 ? x : 0.0L;
    set_column(i, wave_solution(layer, sign, i % 2 == 1, 0.0L, shift),
               wave_solution(layer, sign, i % 2 == 1, x, shift));
  }
  for (int i = 4; i < size; ++i) {
    const State base = wave_solution(body.base, -1, i == 5, 0.0L, 0.0L);
    set_column(i, {}, {-base.u, -base.w, -base.shear, -base.pressure});
  }
  Eigen::Matrix<Real, Eigen::Dynamic, 2> loads(size, 2);
  loads.setZero();
  loads(0, 0) = loads(1, 1) = 1.0L;
  const Eigen::Matrix<Real, Eigen::Dynamic, 2> amplitudes = conditions.fullPivLu().solve(loads);
  Eigen::Matrix<Real, 2, 2> moved;
  moved.setZero();
  for (int i = 0; i < 4; ++i) {
    const int sign = i < 2 ? -1 : 1;
    const State top = wave_solution(layer, sign, i % 2 == 1, 0.0L, sign > 0 ? x : 0.0L);
    moved.row(0) += top.u * amplitudes.row(i);
    moved.row(1) += top.w * amplitudes.row(i);
  }
  // Shear: tractions g cosh and g sinh grow from the base, where they are those of its own waves.
  const Real g1 = layer.shear_modulus;
  const Real base = rigid ? 0.0L : g1 / static_cast<Real>(body.base.shear_modulus);
  const Real across = (base + std::tanh(x)) / (g1 * (1.0L + base * std::tanh(x)));
  return {static_cast<double>(across), static_cast<double>(moved(0, 0)), static_cast<double>(moved(1, 1)),
          static_cast<double>(moved(0, 1))};
}

inline constexpr double kRigidBase = std::numeric_limits<double>::infinity();

/// Layers of thickness 1 that are hard for a solver: much softer and harder than their base, incompressible,
/// of negative Poisson's ratio, on a rigid base.
inline const std::array kHostileBodies{CoatedBody{{2.0, 0.2}, BondedLayer{{5.0, 0.3}, 1.0}},
                                       CoatedBody{{2.0, 0.5}, BondedLayer{{0.1, 0.5}, 1.0}},
                                       CoatedBody{{kRigidBase, 0.0}, BondedLayer{{1.0, 0.3}, 1.0}},
                                       CoatedBody{{kRigidBase, 0.0}, BondedLayer{{1.0, 0.5}, 1.0}},
                                       CoatedBody{{1.0, 0.2}, BondedLayer{{1e4, 0.0}, 1.0}},
                                       CoatedBody{{1e4, -0.9}, BondedLayer{{1.0, -0.9}, 1.0}},
                                       CoatedBody{{1.0, 0.5}, BondedLayer{{1.001, 0.1}, 1.0}}};

}  // namespace slipstick::solver::testing_waves
