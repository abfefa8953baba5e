#pragma once

#include <functional>

#include "solver/certificate.hpp"
#include "solver/coulomb_method.hpp"
#include "solver/model.hpp"
#include "solver/normal_contact.hpp"
#include "solver/paper_method.hpp"
#include "solver/scene.hpp"
#include "solver/stick_front.hpp"

namespace slipstick::solver {

struct Seconds {
  double setup = 0.0;
  double pressure = 0.0;
  double traction = 0.0;
  double total = 0.0;
};

/// A scene's numerical answer. Fields are in the model's units; the scalars below them in the scene's.
struct Solution {
  Status status = Status::not_converged;
  std::string message;  ///< why it did not converge
  Model model;
  NormalSolution normal;
  TorsionSolution torsion;
  Certificate certificate;
  SlipDirection slip_direction;

  double normal_load = 0.0;             ///< W, N: what the pressure carries
  double peak_pressure = 0.0;           ///< Pa
  double contact_radius = 0.0;          ///< m, see measure_contact_radius
  double contact_radius_counted = 0.0;  ///< m, of a circle with the contact cells' area
  double stick_radius = 0.0;            ///< m, of a circle with the stick area, told within the cells
  std::string stick_radius_note;        ///< why it is only counted, all or in part; empty if it is not
  double stick_radius_counted = 0.0;    ///< m, of a circle with the stick cells' area
  double approach = 0.0;                ///< m
  double twist_angle = 0.0;             ///< rad
  double moment = 0.0;                  ///< N m, carried by the tractions
  double moment_limit = 0.0;            ///< N m, of this pressure and mesh
  Index contact_cells = 0;
  Index stick_cells = 0;
  double operator_applications = 0.0;  ///< tangential, of all grids in those of the finest one
  double pressure_applications = 0.0;  ///< likewise of the normal operator
  double bytes = 0.0;                  ///< operators and workspaces of the larger of the two problems
  Seconds seconds;
};

struct SolveOptions {
  /// Called now and then with the iterations or applications so far and what the method's stopping test sees.
  std::function<void(int iteration, double change)> progress;
};

/// Solves a scene. Throws InputError for what the scene got wrong, gross slip and a model that is not on a
/// grid (ModelChoice::exact) among it; what the numbers do is in the status.
Solution solve(const Scene& scene, const SolveOptions& options = {});

/// Contact radius of a pressure, in the grid's units: of a Hertzian contact from the second moments of the
/// pressure (their mean is a_i^2/5), which knows the radius to far less than a cell; else from the area of
/// the contact cells.
double measure_contact_radius(const Model& model, const Eigen::ArrayXd& pressure);

}  // namespace slipstick::solver
