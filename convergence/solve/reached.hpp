#pragma once

#include "convergence/solve/accuracy.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {

/// The safety factor of an estimated error: the mesh for a target is chosen for the target over this.
double estimation_safety(AccuracyOf of);

/// The error that a solve left, and how that is known.
struct ReachedError {
  double error;     ///< relative, not negative; NaN where it is not known
  std::string how;  ///< exact | estimated
  std::string why;  ///< what it was estimated from, or why it is not known
};

/// Against the exact answer where the result has an error against it; else from a second solve on half as
/// many cells over the same extent. The error of a number is the distance of the two over r^p - 1, with
/// Roache's safety factor 3 (1998; two meshes show no order p, so the theory's is taken); that of the
/// tractions is their difference on the coarser cells in the root mean square, where nothing cancels,
/// with 1.25. Never less than what smooth contacts were measured to err by on such a mesh.
ReachedError reached_error(const solver::Scene& scene, const solver::Solution& solution, const Json& result,
                           AccuracyOf of);

}  // namespace slipstick::convergence
