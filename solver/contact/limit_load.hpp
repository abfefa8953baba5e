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

/// F1, F2 and M_3 about the grid's origin, over the cell area; empty: the motion along it is imposed instead,
/// and the load takes any value.
using ImposedLoads = std::array<std::optional<double>, 3>;

/// What a contact can carry before all of it slides.
struct LimitLoad {
  double factor;        ///< times the loads given; infinite if they are all zero
  double carried;       ///< at least so much, proven: balanced by admissible tractions
  RigidMotion sliding;  ///< that of the limit; the loads given do unit work in it
  std::optional<std::array<double, 2>> centre;  ///< of sliding; empty: pure translation
};

/// The largest factor by which the loads given can be multiplied so that some tractions |q| <= mu p balance
/// them. By duality it is the least sum of mu p |v| over rigid velocities v in which the loads do unit work,
/// zero where the motion is imposed (limit analysis: Drucker, Prager and Greenberg, 1952). That motion is the
/// direction in which the body slides. `factor` is that sum and so bounds the limit from above, `carried`
/// from below. Where several motions share the least sum one of them is returned.
///
/// friction_bound: mu p of each cell, zero outside the contact. Throws std::invalid_argument unless it has
/// grid.cells() finite values >= 0 and the loads are finite.
LimitLoad find_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound, const ImposedLoads& loads);

/// The largest moment (over the cell area) without force: the least sum of mu p |x - c| over turning
/// centres c.
double free_moment_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound);

}  // namespace slipstick::solver
