#pragma once

#include <array>
#include <string>

#include "solver/contact/certificate.hpp"
#include "solver/contact/normal_contact.hpp"
#include "solver/load_step.hpp"
#include "solver/model.hpp"
#include "solver/resolution.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::solver {

struct Seconds {
  double setup = 0.0;
  double pressure = 0.0;
  double traction = 0.0;
  double total = 0.0;
};

/// The numerical answer at the end of a step. Fields are in the model's units, slip is that of the step; the
/// scalars below them are in the scene's units.
struct Solution {
  Status status = Status::not_converged;
  std::string message;  ///< why it did not converge
  Model model;
  NormalSolution normal;
  TangentialSolution tangential;
  Certificate certificate;
  SlipDirection slip_direction;
  Resolution resolution;

  double normal_load = 0.0;              ///< W, N: what the pressure carries
  double peak_pressure = 0.0;            ///< Pa
  double contact_radius = 0.0;           ///< m, see measure_contact_radius
  double contact_radius_counted = 0.0;   ///< m, of a circle with the contact cells' area
  double stick_radius = 0.0;             ///< m, of a circle with the stick area, told within the cells
  std::string stick_radius_note;         ///< why it is only counted, all or in part; empty if it is not
  double stick_radius_counted = 0.0;     ///< m, of a circle with the stick cells' area
  double approach = 0.0;                 ///< m
  Step loads;                            ///< those of the step, as the scene has them
  int cycle = 1;                         ///< of so many times that the steps are gone through
  double twist_angle = 0.0;              ///< rad, since the first step began
  std::array<double, 2> displacement{};  ///< m, likewise
  double moment = 0.0;                   ///< N m, carried by the tractions
  std::array<double, 2> force{};         ///< N, likewise
  double moment_limit = 0.0;             ///< N m, of this pressure and mesh, without force
  LimitLoad limit;                       ///< of the loads imposed; lengths in m, its motion's scale free
  double elastic_energy = 0.0;           ///< J, of the tractions: q.Kq/2
  double dissipated = 0.0;               ///< J, in this step: mu p |s| over the contact
  /// J: what the loads at the end of the step do in its motions, less what that stores elastically. Equal to
  /// `dissipated` up to the certificate.
  double work = 0.0;
  int turns = 1;  ///< between pressure and tractions, under full coupling
  Index contact_cells = 0;
  Index stick_cells = 0;
  double operator_applications = 0.0;  ///< tangential, of all grids in those of the finest one
  double pressure_applications = 0.0;  ///< likewise of the normal operator
  double bytes = 0.0;                  ///< operators and workspaces of the larger of the two problems
  Seconds seconds;
};

/// Fills in the members that follow from pressure, tractions and loads: the contact, the stick area, loads
/// and limits, certificate, energies. slip: see ContactState.
void describe(Solution& solution, const LoadStep& loads, const Eigen::ArrayXd& slip);

/// Contact radius of a pressure, in the grid's units: of a Hertzian contact from the second moments of the
/// pressure about its centre (those along the axes are a_i^2/5), which know the radius to far less than a
/// cell; else from the area of the contact cells.
double measure_contact_radius(const Model& model, const Eigen::ArrayXd& pressure);

}  // namespace slipstick::solver
