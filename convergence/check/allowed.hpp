#pragma once

#include <Eigen/Core>
#include <optional>

#include "convergence/check/examination.hpp"

namespace slipstick::convergence {

/// The largest values that a right field may have on its own mesh: errors of loads, motion and fields, all
/// relative, and distances from Coulomb's law.
struct Allowed {
  double normal, moment, force;
  double pressure;                ///< in the mean
  Eigen::ArrayXd pressure_cells;  ///< cells; empty: the pressure is not judged
  double motion;
  double tractions;               ///< in the mean
  Eigen::ArrayXd traction_cells;  ///< cells
  double friction;                ///< of |q|/(mu p) in the slip ring
  double friction_bound;          ///< of friction_excess()
  double direction;               ///< degrees
  double gap;                     ///< of Coulomb's law over the energy,
  double discrete_gap;            ///< and of a field that solves its own grid's problem
};

/// tolerance: takes the place of the errors that the mesh allows for loads, motion, pressure and tractions.
Allowed find_allowed(const Examination& examination, std::optional<double> tolerance);

/// Whether |q| <= mu p, up to the file's digits and a solver's tolerance. Otherwise Coulomb's gap is
/// undefined.
bool keeps_friction_bound(const GivenContact& contact);

/// The part of mu p by which |q| exceeds it in the worst cell, beyond digits and noise; a cell that carries
/// next to nothing is judged by a part of the largest mu p.
double friction_excess(const Examination& examination);

/// Distance of the field's tractions from the right ones, cell by cell.
Eigen::ArrayXd traction_deviation(const Examination& examination);

}  // namespace slipstick::convergence
