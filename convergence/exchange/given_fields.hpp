#pragma once

#include <Eigen/Core>

#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

namespace slipstick::convergence {

/// What another program found for a scene of one load, on the scene's grid; SI units.
struct GivenFields {
  Eigen::ArrayXd pressure;  ///< cells, Pa
  Eigen::ArrayXd traction;  ///< 2*cells, Pa, on the lower body
};

/// The answer that given pressure and tractions are: displacements from this project's operator, the rigid
/// motion under which they come closest to Coulomb's law (fitted_motion.hpp) where the scene does not impose
/// it, and all that follows from these, the certificate included. Its status is converged: what the fields
/// are worth, the certificate and the errors say. Throws InputError for a history and where make_model()
/// does; std::invalid_argument for fields that are not the grid's.
solver::Solution describe_given(solver::Scene scene, const GivenFields& fields);

/// The scene's gap and, where the scene does not leave it to be solved, its pressure: what another program
/// needs beside the loads.
struct PosedScene {
  solver::Grid grid;        ///< m
  Eigen::ArrayXd gap;       ///< cells, m; infinite where the bodies cannot touch
  Eigen::ArrayXd pressure;  ///< cells, Pa; empty: to be solved
  double contact_modulus;   ///< Pa: E*, 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2
  double shear_modulus;     ///< Pa: 1/G = 1/G_1 + 1/G_2
  double poisson_ratio;     ///< of the pair: nu/G = nu_1/G_1 + nu_2/G_2
  /// 1/Pa: (1 - 2 nu)/G of the lower body less that of the upper; zero where pressure is not coupled to it.
  double mismatch;
  bool coupled;  ///< whether pressure moves the surfaces sideways: under layers also where mismatch is zero
  double moment_limit;  ///< N m, of the pressure on this grid; zero unless it is asked for
};

/// with_limit: the limit moment is worked out, for which the pressure is solved where the scene does not give
/// it. Throws InputError as make_model() and solve() do.
PosedScene pose(solver::Scene scene, bool with_limit);

}  // namespace slipstick::convergence
