#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/newton/coefficients.hpp"

namespace slipstick::solver {

/// Part of mu p by which |q| of a slipping cell may differ from mu p where a solver stops at a tolerance.
inline constexpr double kOnCircle = 1e-4;

/// The rigid motion under which tractions come closest to Coulomb's law: the one with the least gap, the sum
/// of s.q + mu p |s| with s = displacement - sum z_k motions_k, which is convex in z.
struct FittedMotion {
  Coefficients coefficients;  ///< z
  Eigen::ArrayXd slip;        ///< s, 2*cells
  Eigen::ArrayXd gap;         ///< cells: s.q + mu p |s|, each zero under Coulomb's law
};

/// displacement, traction: 2*cells; friction_bound: cells; motions: at most kMaxConditions fields of 2*cells,
/// linearly independent where the bound is positive. Cells without a bound do not count, and have no slip.
FittedMotion fit_motion(const Eigen::ArrayXd& displacement, const Eigen::ArrayXd& traction,
                        const Eigen::ArrayXd& friction_bound, const std::vector<Eigen::ArrayXd>& motions);

}  // namespace slipstick::solver
