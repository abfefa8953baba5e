#pragma once

#include "convergence/results/solve_record.hpp"

namespace slipstick::solver {
struct Scene;
struct Solution;
}  // namespace slipstick::solver

namespace slipstick::convergence {

/// The gap of the continuous problem, and the interval of its twist under a moment, by three further
/// solves; missing numbers have the reason.
///
/// The least energy J*(M) of a moment is convex, and the twist is its derivative. With
/// J(q) - G <= J*(M) <= J(q) for tractions q that carry M, differences to the moments M + d and M - d bound
/// it: (J_low(M) - J_up(M - d))/d <= phi(M) <= (J_up(M + d) - J_low(M))/d.
ContinuumRecord continuum_record(const solver::Scene& scene, const solver::Solution& solution);

}  // namespace slipstick::convergence
