#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Velocity (delta1 - twist x2, delta2 + twist x1) of each point of a rigid body.
struct RigidMotion {
  double delta1 = 0.0;
  double delta2 = 0.0;
  double twist = 0.0;
};

/// F1, F2 and M_3 about the grid's origin, over the cell area; empty: the motion is imposed instead.
using ImposedLoads = std::array<std::optional<double>, 3>;

/// The load at which the whole contact slides.
struct LimitLoad {
  double factor;                                ///< limit load over the given loads; infinite if these are all zero
  double carried;                               ///< proven lower bound of it: admissible tractions balance these loads
  RigidMotion sliding;                          ///< the motion at the limit; the given loads do unit work in it
  std::optional<std::array<double, 2>> centre;  ///< of sliding; empty: pure translation
};

/// The largest multiple of the given loads that tractions |q| <= mu p can balance. By duality it is the least
/// sum of mu p |v| over rigid velocities v in which the loads do unit work, with v = 0 along imposed motions
/// (limit analysis: Drucker, Prager and Greenberg, 1952). `factor` is that sum, an upper bound, and `carried`
/// a lower one. If several motions have the least sum one of them is returned.
///
/// 1. Minimise sum of mu p sqrt(|v|^2 + s^2) by Newton's method with decreasing s (smoothed_friction.hpp).
/// 2. Tractions mu p v / sqrt(|v|^2 + s^2) are admissible; scaled, and corrected for the remaining imbalance,
///    they give the lower bound. Stop once the bounds are close.
///
/// friction_bound: mu p of each cell, zero outside the contact. Throws std::invalid_argument unless it has
/// grid.cells() finite values >= 0 and the loads are finite.
LimitLoad find_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound, const ImposedLoads& loads);

/// The largest moment (over the cell area) without force: the least sum of mu p |x - c| over turning
/// centres c.
double free_moment_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound);

}  // namespace slipstick::solver
