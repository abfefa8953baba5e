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
  Deviation deviation;       ///< from the right answer
  LoadErrors loads;          ///< by midpoints and edge cells
  double direction = 0.0;    ///< of noticeable slip, in the mean, degrees
  Eigen::ArrayXd pressures;  ///< cells of the field's grid: how far right pressures are from the reference,
  Eigen::ArrayXd tractions;  ///< and right tractions
};

/// The scene's own pressure, solved on the field's cells.
struct ScenePressure {
  Eigen::ArrayXd values;     ///< on the field's grid
  Eigen::ArrayXd deviation;  ///< of the field's from it, under the same normal load
  double off;  ///< sum of deviations, those outside of the field's grid too, over the pressure's
};

/// What is to be expected of a right field on a given contact's grid, whatever its discretisation. It is
/// measured on right fields: the solution on a mesh of cells a third as large, under the exact pressure where
/// that is known, once averaged over this grid's cells and once sampled at their centres.
struct ReferenceOnGrid {
  std::optional<ScenePressure> pressure;  ///< none: it cannot be solved on these cells, or is not wanted
  RightAnswer right;                      ///< with the field's own pressure and loads
  MeshErrors mesh;                        ///< the larger ones of the two fields
  Deviation rounding;                     ///< of the right answer, rounded like the field's file
  Deviation noise;                        ///< and with as much noise as the field shows
  Eigen::ArrayXd noise_size;              ///< cells: standard deviation, of |q|
};

/// What a field's program and its user know of the contact.
struct Known {
  std::optional<Oracle> pressed;  ///< the exact normal contact, about the grid's centre
  std::optional<Oracle> exact;    ///< and the whole exact answer
  bool twist;                     ///< the program reported its twist; so do the right fields then
  bool pressure;                  ///< it is taken as given
};

/// model: the scene's. Throws std::runtime_error where a solve does not converge.
ReferenceOnGrid find_reference_on_grid(const GivenContact& contact, const solver::Scene& scene,
                                       const solver::Model& model, const Known& known);

}  // namespace slipstick::convergence
