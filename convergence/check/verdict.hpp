#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/diagnosis.hpp"
#include "convergence/check/examination.hpp"

namespace slipstick::convergence {

// ---------------------------------------------------------------- what a mesh allows (allowed.cpp)

/// The largest values that a right field may have on its own mesh: errors of loads, motion and fields, all
/// relative, and distances from Coulomb's law.
struct Allowed {
  double normal, moment, force;
  double pressure;                ///< in the mean
  Eigen::ArrayXd pressure_cells;  ///< cells; empty: the pressure is not judged
  double motion;
  double tractions;               ///< in the mean
  double inside;                  ///< their part in inner cells
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

// ---------------------------------------------------------------- what is judged by that (verdict.cpp)

/// A number and its allowed maximum, which NaN exceeds.
struct Judged {
  std::string quantity;
  double value;
  double allowed;
  std::string right;  ///< words for the verdict where it holds; empty: none
  std::string wrong;  ///< and where it does not: how much, where, and the maximum; empty: none

  bool holds() const { return value <= allowed; }
};

/// Two answers. Is the field right within its mesh? Pressure, loads, motion, tractions and Coulomb's law are
/// judged in the mean and cell by cell, against the errors of right fields of any discretisation on the same
/// mesh, or against the user's tolerance. Does it solve its own grid's problem, with constant tractions in
/// each cell, up to iteration error?
struct Verdict {
  std::vector<Judged> judged;
  Judged discrete;
  std::optional<Diagnosis> diagnosis;  ///< of a field that is wrong
  std::string headline;                ///< names the first quantity that is wrong, or says that all are right
  std::string details;                 ///< the cause, what else is wrong, and what is right

  bool within_mesh() const;
};

/// tolerance: as in find_allowed().
Verdict reach_verdict(const Examination& examination, std::optional<double> tolerance);

}  // namespace slipstick::convergence
