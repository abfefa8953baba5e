#pragma once

#include <Eigen/Core>

namespace slipstick::solver {

/// Euclidean projection onto the tractions within the friction discs |q_i| <= b_i that carry a moment, t.q =
/// moment, in place. It is the projection of traction + alpha t onto the discs, and alpha, the multiplier, is
/// returned: the moment grows with it, so that Newton's method within a bracket finds it to rounding. With
/// traction = q - (K q + g)/L, a step of projected gradients, L alpha estimates the twist.
///
/// traction, rotation (t): 2*cells values; bound: b = mu p of each cell, zero or positive; guess: where to
/// look first. Not finite are the multiplier and the result where traction is not. Throws
/// std::invalid_argument unless |moment| < sum of b |t|, or both are zero (then alpha is 0).
double project_with_moment(Eigen::ArrayXd& traction, const Eigen::ArrayXd& bound,
                           const Eigen::ArrayXd& rotation, double moment, double guess = 0.0);

}  // namespace slipstick::solver
