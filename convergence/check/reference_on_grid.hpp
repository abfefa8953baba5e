#pragma once

#include <Eigen/Core>
#include <optional>

#include "convergence/check/deviation.hpp"
#include "convergence/oracle/oracle.hpp"

namespace slipstick::convergence {

/// Differences between the loads that a field carries and those that its program meant.
struct LoadErrors {
  double normal = 0.0;  ///< relative
  double moment = 0.0;  ///< relative
  double force = 0.0;   ///< in parts of the sum of mu p
};

/// Errors that a mesh causes in right fields, the larger one of several fields each.
struct MeshErrors {
  Deviation deviation;        ///< from the right answer
  LoadErrors loads;           ///< by midpoints and edge cells
  double moment_limit = 0.0;  ///< of the finer pressure, over the cell area of the field's grid
  double direction = 0.0;     ///< of noticeable slip, in the mean, degrees
  Eigen::ArrayXd pressures;   ///< cells of the field's grid: distance of right pressures from the reference,
  Eigen::ArrayXd tractions;   ///< and of right tractions
};

/// The scene's own pressure, solved on the field's cells.
struct ScenePressure {
  Eigen::ArrayXd values;     ///< on the field's grid
  Eigen::ArrayXd deviation;  ///< of the field's pressure from it, under the same normal load
  double off;                ///< sum of deviations, also outside of the field's grid, over that of `values`
};

/// The errors of right fields on a given contact's grid, whatever their discretisation. They are measured on
/// the solution on cells a third as large, under the exact pressure where it is known: once averaged over
/// this grid's cells and once sampled at their centres.
struct ReferenceOnGrid {
  std::optional<ScenePressure> pressure;  ///< none: it cannot be solved on these cells, or is not wanted
  RightAnswer right;                      ///< with the field's own pressure and loads
  Regions regions;
  MeshErrors mesh;
  Deviation rounding;         ///< of the right answer with the digits of the field's file,
  Deviation noise;            ///< and with as much noise as the field shows
  Eigen::ArrayXd noise_size;  ///< cells: standard deviation of |q|
};

/// What is known of the contact beside the field.
struct Known {
  std::optional<Oracle> pressed;  ///< the exact normal contact, about the grid's centre
  std::optional<Oracle> exact;    ///< the exact answer, about the grid's centre
  bool twist;                     ///< the program reported its twist; right fields then report theirs
  bool pressure;                  ///< the field's pressure is taken as given
};

/// The pressure of a scene, of the contact's bodies, on the contact's cells. None where it cannot be solved
/// on these.
std::optional<ScenePressure> find_scene_pressure(const GivenContact& contact, const solver::Scene& scene,
                                                 const solver::Model& model);

/// model: the scene's. Throws std::runtime_error where a solve does not converge.
ReferenceOnGrid find_reference_on_grid(const GivenContact& contact, const solver::Scene& scene,
                                       const solver::Model& model, const Known& known);

}  // namespace slipstick::convergence
