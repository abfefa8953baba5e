#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/deviation.hpp"
#include "convergence/check/foreign_field.hpp"
#include "convergence/oracle/oracle.hpp"
#include "solver/contact/certificate.hpp"

namespace slipstick::convergence {

/// Options of a check. A good field is right within its mesh; discrete and strict make the check stricter.
struct CheckOptions {
  std::optional<double> twist = {};       ///< rad, that the program reported
  std::vector<std::string> columns = {};  ///< names for a file without a header, or paths in an HDF5 file
  bool discrete = false;                  ///< a good field solves its own grid's problem, with constant cells
  bool strict = false;                    ///< a good field is in the scene's conventions
  bool pressure_given = false;            ///< the pressure is not judged
  /// Error allowed for loads, pressure, motion and tractions, instead of the one derived from the mesh.
  std::optional<double> tolerance = {};
};

/// Differences between the loads that a field carries and the loads that its program meant.
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
  std::optional<ScenePressure> pressure;  ///< none: it cannot be solved on these cells, or is not judged
  RightAnswer right;                      ///< with the field's own pressure and loads
  Regions regions;
  MeshErrors mesh;
  Deviation rounding;         ///< of the right answer with the digits of the field's file,
  Deviation noise;            ///< and with as much noise as the field shows
  Eigen::ArrayXd noise_size;  ///< cells: standard deviation of |q|
};

/// A field that another program computed for a scene, with all numbers that judge it. They are dimensionless
/// as `contact` is; moments are over the cell area.
struct Examination {
  solver::Scene scene;
  Interpretation read;  ///< with the twist's convention; `contact` has the field's values
  OracleAnswer exact;   ///< positions are about the centre of the field's grid
  GivenContact contact;
  ReferenceOnGrid reference;
  bool constant_cells;           ///< pressure, and so traction too, is constant in each cell
  bool pressure_given;           ///< the pressure is not judged
  bool twist_given;              ///< by the user or by the scene
  State state;                   ///< under that twist, otherwise `fitted`
  State fitted;                  ///< under the motion that fits best
  Deviation deviation;           ///< from the right answer
  std::optional<double> moment;  ///< that the scene imposes; none: any
  solver::Certificate certificate;
  solver::SlipDirection direction;  ///< of noticeable slip

  double moment_limit() const;  ///< of the field's pressure
};

/// Measures a field:
///
///  1. read_foreign_field() reads it, in_own_conventions() puts it into the scene's units and signs.
///  2. pose() computes the displacements under its pressure and tractions.
///  3. find_state() gives the rigid motion: under the reported twist, or the scene's if it imposes one, and
///     the one that fits Coulomb's law best.
///  4. find_reference_on_grid() solves the scene's pressure and tractions on the field's cells and on cells a
///     third as large: from them follow the errors that the mesh causes in right fields.
///  5. find_deviation() and certify() give the field's own errors.
///
/// Throws InputError for a history, for a scene without friction, and where read_foreign_field() or
/// in_own_conventions() does; std::runtime_error where the reference's solve does not converge.
Examination examine(const solver::Scene& scene, const std::filesystem::path& file, const CheckOptions& options);

/// The pressure of a scene, of the contact's bodies, on the contact's cells. None where it cannot be solved on these.
std::optional<ScenePressure> find_scene_pressure(const GivenContact& contact, const solver::Scene& scene,
                                                 const solver::Model& model);

}  // namespace slipstick::convergence
