#pragma once

#include "convergence/solve/accuracy.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {

/// Safety factor of an estimated error.
double estimation_safety(AccuracyOf of);

/// The error of a solve, and its basis.
struct ReachedError {
  double error;     ///< relative, not negative; NaN where it is not known
  std::string how;  ///< exact | estimated
  std::string why;  ///< basis of the estimate, or why the error is not known
};

/// The error against the exact answer, if `errors` has it. Else an estimate from a second solve on half as
/// many cells over the same extent. For a number it is the difference of the two over r^p - 1 with the
/// theoretical order p, times Roache's safety factor 3 (1998) for two meshes. For the tractions it is the
/// root mean square of the differences on the coarser cells over r^p - 1, in which nothing cancels,
/// times 1.25. It is at least the error measured for smooth contacts on such a mesh.
ReachedError reached_error(const solver::Scene& scene, const solver::Solution& solution,
                           const ErrorsRecord& errors, AccuracyOf of);

}  // namespace slipstick::convergence
