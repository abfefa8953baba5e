#pragma once

#include <Eigen/Core>
#include <string>

#include "solver/linear_operator.hpp"

namespace slipstick::solver {

/// Frictionless contact under a given load: minimise p.Kp/2 + p.h over p >= 0 with sum of p given. All
/// quantities in one consistent set of units; the operator is u3 = K33 p.
struct NormalProblem {
  Eigen::ArrayXd gap;     ///< undeformed gap h of each cell; infinite where the bodies cannot touch
  double total_pressure;  ///< load over cell area
};

struct NormalOptions {
  double tolerance = 1e-10;  ///< on the complementarity gap
  int max_iterations = 2000;
};

enum class Status { converged, not_converged };

struct NormalSolution {
  Status status = Status::not_converged;
  std::string message;      ///< why it did not converge; empty if it did
  Eigen::ArrayXd pressure;  ///< one value a cell
  double approach = 0.0;    ///< mean over the contact of u3 + h
  /// (energy - least possible energy) / energy is at most this: sum over p of the gap left open above its
  /// minimum.
  double complementarity = 0.0;
  double load_error = 0.0;  ///< relative
  int iterations = 0;
};

/// Conjugate gradients with the contact area as part of the answer (Polonsky and Keer, Wear 231, 1999). Stops
/// when the complementarity gap and the load balance hold, not on change.
NormalSolution solve_normal_contact(LinearOperator& op, const NormalProblem& problem,
                                    const NormalOptions& options = {});

}  // namespace slipstick::solver
