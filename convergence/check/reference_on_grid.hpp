#pragma once

#include <Eigen/Core>
#include <optional>

#include "convergence/check/deviation.hpp"
#include "convergence/oracle/oracle.hpp"

namespace slipstick::convergence {

/// How far loads that a field carries may be from those that its program meant.
struct LoadErrors {
  double normal = 0.0;  ///< relative
  double moment = 0.0;  ///< relative
  double force = 0.0;   ///< in parts of the sum of mu p
};

/// What a mesh does to a right field.
struct MeshErrors {
  Deviation deviation;     ///< from the right answer
  LoadErrors loads;        ///< by midpoints and edge cells
  double direction = 0.0;  ///< of noticeable slip, in the mean, degrees
};

/// What is to be expected of a right field on a given contact's grid, whatever its discretisation. It is
/// measured on right fields: the solution on a mesh of cells a third as large, under the exact pressure where
/// that is known, once averaged over this grid's cells and once sampled at their centres.
struct ReferenceOnGrid {
  RightAnswer right;          ///< with the field's own pressure and loads
  MeshErrors mesh;            ///< the larger ones of the two fields
  Deviation rounding;         ///< of the right answer, rounded like the field's file
  Deviation noise;            ///< and with as much noise as the field shows
  Eigen::ArrayXd noise_size;  ///< cells: standard deviation, of |q|
};

/// pressed: the exact normal contact, about the grid's centre. twist_given: the program reported its twist;
/// so do the right fields then. Throws std::runtime_error where a solve does not converge.
ReferenceOnGrid find_reference_on_grid(const GivenContact& contact, const solver::Step& load,
                                       const std::optional<Oracle>& pressed, bool twist_given);

}  // namespace slipstick::convergence
