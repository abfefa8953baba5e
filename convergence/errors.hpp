#pragma once

#include <Eigen/Core>

#include "convergence/oracle.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {

/// Relative errors of a field: sum |f - exact| / sum |exact|, the same of squares under a root, and of
/// maxima. A cell where the exact value is infinite (a cone's axis, with an odd number of cells) is left out.
struct FieldError {
  double l1;
  double l2;
  double max;
};

/// Signed relative errors computed/exact - 1, and errors of the fields at cell centres. Where the exact value
/// is zero (no load: twist, moment, traction) or infinite (peak pressure of a cone and a flat punch), the
/// error is NaN.
struct Errors {
  double twist;
  double moment;
  double moment_limit;
  double stick_radius;
  double stick_ratio;
  double displacement;  ///< length of the difference, not signed
  double dissipated;    ///< in the step
  double stick_radius_counted;
  double contact_radius;
  double peak_pressure;
  FieldError traction;
  FieldError pressure;
};

/// Exact fields at the cell centres of a solution, in its model's units.
struct ExactFields {
  Eigen::ArrayXd radius;    ///< cells: distance from the axis
  Eigen::ArrayXd pressure;  ///< cells
  Eigen::ArrayXd traction;  ///< 2*cells
};

ExactFields exact_fields(const Oracle& oracle, const solver::Model& model);
Errors compare(const solver::Solution& solution, const Oracle& oracle);

}  // namespace slipstick::convergence
