#pragma once

#include <Eigen/Core>

#include "convergence/oracle.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {

/// Relative errors of a field: sum |f - exact| / sum |exact|, the same of squares under a root, and of
/// maxima.
struct FieldError {
  double l1;
  double l2;
  double max;
};

/// Signed relative errors computed/exact - 1, and errors of the fields at cell centres. Where the exact value
/// is zero (no load), the twist and traction errors are NaN.
struct Errors {
  double twist;
  double moment;
  double moment_limit;
  double stick_radius;
  double contact_radius;
  double peak_pressure;
  FieldError traction;
  FieldError pressure;
};

/// Exact fields at the cell centres of a solution, in its model's units.
struct ExactFields {
  Eigen::ArrayXd pressure;  ///< cells
  Eigen::ArrayXd traction;  ///< 2*cells
};

ExactFields exact_fields(const Oracle& oracle, const solver::Model& model);
Errors compare(const solver::Solution& solution, const Oracle& oracle);

}  // namespace slipstick::convergence
