#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "solver/contact/certificate.hpp"
#include "solver/contact/limit_load.hpp"
#include "solver/grid/grid.hpp"
#include "solver/newton/safeguards.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::solver {

/// One size for each number that loads may leave open.
struct Quantities {
  double twist = 0.0;         ///< rad
  double displacement = 0.0;  ///< m
  double moment = 0.0;        ///< N m
  double force = 0.0;         ///< N
};
inline constexpr std::array kQuantities{&Quantities::twist, &Quantities::displacement, &Quantities::moment,
                                        &Quantities::force};

/// How well a mesh resolves a contact's slip and stick.
struct Resolution {
  /// Cells across the stick area, in the mean: four times its area over its outline. Zero where no cell sticks.
  double stick_width = 0.0;
  double slip_width = 0.0;  ///< mean number of cells across the slip area: twice its area over its outline
  double step = 0.0;        ///< relative error of the step's own change that the mesh causes
  double stick_area = 0.0;  ///< cells: error of the stick area, in addition to the error of counting cells
  Quantities open;          ///< rad and m: additional error close to gross slip, where few cells stick
  Quantities mesh;          ///< error that the mesh causes over all steps of the history
  Quantities path;          ///< error that the number of parts of the steps causes
  /// The number that the loads leave open: the twist where a moment acts or has turned the contact, the
  /// moment where the twist is imposed; without torsion the displacement, or the force where that is imposed.
  double Quantities::*number = &Quantities::twist;
  double absolute = 0.0;  ///< mesh and path together, of `number`
  /// `absolute` relative to the number. Above kPoorlyResolved the number depends more on the mesh or on the
  /// steps than on the contact.
  double uncertainty = 0.0;
};
/// Relative uncertainty from which on an answer is marked as poorly resolved.
inline constexpr double kPoorlyResolved = 0.1;

/// Wall-clock time of the parts of a solve, in s.
struct Seconds {
  double setup = 0.0;
  double pressure = 0.0;
  double traction = 0.0;
  double total = 0.0;
};

/// How much is computed from the fields of an answer.
enum class Detail {
  all,
  loads,  ///< loads and motions with their certificate: what a mean over grids takes. The stick radius is
          ///< counted
};

/// The pressure and the contact under it.
struct ContactNumbers {
  double normal_load = 0.0;    ///< W, N: the sum of the pressure
  double peak_pressure = 0.0;  ///< Pa
  double approach = 0.0;       ///< m
  /// m; of a Hertzian contact by the pressure's second moments, else of a circle with the contact cells' area.
  double contact_radius = 0.0;
  double contact_radius_counted = 0.0;  ///< m, of a circle with the contact cells' area
  Index contact_cells = 0;
  CountedArea contact_area;  ///< m^2
};

/// The part of the contact that sticks.
struct StickNumbers {
  double stick_radius = 0.0;          ///< m, of a circle with the stick area, sub-cell
  std::string stick_radius_note;      ///< why all or part of it is only counted; empty if it is not
  double stick_radius_counted = 0.0;  ///< m, of a circle with the stick cells' area
  Index stick_cells = 0;
  CountedArea stick_area;  ///< m^2
};

/// Motions since the first step began, and the loads that the tractions carry.
struct LoadNumbers {
  double twist_angle = 0.0;              ///< rad
  std::array<double, 2> displacement{};  ///< m
  double moment = 0.0;                   ///< N m
  std::array<double, 2> force{};         ///< N
  double moment_limit = 0.0;             ///< N m, of this pressure and mesh, without force
  double friction_force = 0.0;           ///< N, that slides the contact along a line: mu W under Coulomb's law
  LimitLoad limit;                       ///< of the loads imposed; lengths in m, its motion's scale free
};

struct EnergyNumbers {
  double elastic_energy = 0.0;  ///< J, of the tractions: q.Kq/2
  double dissipated = 0.0;      ///< J, in this step: mu p |s| over the contact
  /// J: work of the loads at the end of the step in its motions, less the elastic energy that it stores.
  /// Equal to `dissipated` up to the certificate.
  double work = 0.0;
};

/// How good the answer is.
struct QualityNumbers {
  Certificate certificate{};
  SlipDirection slip_direction{};  ///< NaN where nothing slips
  Resolution resolution;
};

/// The numbers of a step.
struct StepNumbers : ContactNumbers, StickNumbers, LoadNumbers, EnergyNumbers, QualityNumbers {};

/// The work that a step took, tangential unless another problem is named.
struct WorkNumbers {
  int turns = 1;                       ///< between pressure and tractions, under full coupling
  double operator_applications = 0.0;  ///< on all grids, weighted by their cells over the finest grid's
  double pressure_applications = 0.0;  ///< of the normal operator, counted in the same way
  double bytes = 0.0;                  ///< predicted, of operators and workspaces: Memory::solver
  double predicted_bytes = 0.0;        ///< of all that the step holds, once its contact was known
  int threads = 1;
  Seconds seconds;
  int iterations = 0;           ///< of the method that found the tractions
  double change = 0.0;          ///< last value of the quantity that its stopping test compares
  std::vector<GridWork> grids;  ///< its work, coarsest grid first
  Safeguards safeguards;        ///< of the step: tractions and pressure, all grids
  int pressure_iterations = 0;
  double pressure_complementarity = 0.0;
};

/// Fields on the grid: one value a cell, vectors first all first components, then all second ones.
struct SolutionFields {
  Grid grid{};              ///< m
  Eigen::ArrayXd pressure;  ///< Pa
  Eigen::ArrayXd traction;  ///< Pa, (q1, q2) on the lower body
  /// m, (u1, u2): displacement of the lower surface by the tractions, minus the upper surface's, in contact;
  /// elsewhere it may be zero.
  /// Where several processes share the grid, each may hold its own rows only.
  Eigen::ArrayXd elastic_displacement;
  Eigen::ArrayXd slip;              ///< m, (s1, s2) in this step
  Eigen::ArrayXd stick;             ///< 1 where the bodies stick, else 0
  Eigen::ArrayXd gap_density = {};  ///< J/m^2, see ContinuumGap; empty: not computed
};

/// The numerical answer at the end of a step, in SI units like the scene.
struct Solution : SolutionFields, StepNumbers, WorkNumbers {
  Status status = Status::not_converged;
  std::string message;  ///< why it did not converge
  Step loads;           ///< the step as the scene gives it
  int cycle = 1;        ///< counted from 1
  Detail detail = Detail::all;
  FrictionLaw friction;        ///< in Pa
  double shear_modulus = 0.0;  ///< Pa, of the pair: 1/G = 1/G_1 + 1/G_2
  bool coupled = false;        ///< the pressure displaces the surfaces tangentially: K13, K23 enter and are not zero
  std::vector<Omission> left_out;
};

}  // namespace slipstick::solver
