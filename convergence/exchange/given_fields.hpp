#pragma once

#include <Eigen/Core>

#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

namespace slipstick::convergence {

/// Fields that another program computed for a scene of one load, on the scene's grid; SI units.
struct GivenFields {
  Eigen::ArrayXd pressure;  ///< cells, Pa
  Eigen::ArrayXd traction;  ///< 2*cells, Pa, on the lower body
};

/// Makes a solution of a field, as solve() makes one of a scene:
///
///  1. GivenContact gives the displacements under the field, find_state() the rigid motion and the slip.
///  2. The approach and the complementarity follow from the gap under the pressure.
///  3. describe_step() adds loads, certificate, energies, resolution.
///
/// The status is converged: the certificate and the errors judge the field. Throws InputError for a history
/// and where make_model() does; std::invalid_argument for fields that are not the grid's.
solver::Solution describe_given(solver::Scene scene, const GivenFields& fields);

/// The numbers of a scene that another program needs to solve it.
struct PosedScene {
  solver::Grid grid;        ///< m
  Eigen::ArrayXd gap;       ///< cells, m; infinite where the bodies cannot touch
  Eigen::ArrayXd pressure;  ///< cells, Pa; empty: to be solved
  double contact_modulus;   ///< Pa: E*, 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2
  double shear_modulus;     ///< Pa: 1/G = 1/G_1 + 1/G_2
  double poisson_ratio;     ///< of the pair: nu/G = nu_1/G_1 + nu_2/G_2
  /// 1/Pa: (1 - 2 nu)/G of the lower body minus the same of the upper; zero without pressure coupling.
  double mismatch;
  bool coupled;         ///< whether pressure moves the surfaces sideways: under layers also where mismatch is zero
  double moment_limit;  ///< N m, of the pressure on this grid; zero unless `with_limit`
};

/// with_limit: the limit moment is worked out, for which the pressure is solved where the scene does not give
/// it. Throws InputError as make_model() and solve() do.
PosedScene pose(solver::Scene scene, bool with_limit);

}  // namespace slipstick::convergence
