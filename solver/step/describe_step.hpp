#pragma once

#include "solver/model/model.hpp"
#include "solver/solution.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::solver {

/// The loads of a step, and how much is computed from its fields.
struct StepLoads {
  Step loads;  ///< as the scene has them
  Detail detail = Detail::all;
};

/// Pressure and tractions of a step, with the problem that they solve.
struct SolvedStep {
  LoadStep loads;
  NormalSolution normal;
  TangentialSolution tangential;
};

/// In the model's units; forces, moments and energies over the cell area, counted areas in m^2. motion: since the first
/// step began. slip: see ContactState.
StepNumbers describe_step(const Scene& scene, const Model& model, const StepLoads& step, const SolvedStep& solved,
                          const RigidMotion& motion, const Eigen::ArrayXd& slip);

/// Contact radius of a pressure, in the grid's units: of a Hertzian contact from the second moments of the
/// pressure about its centre (those along the axes are a_i^2/5), which know the radius to far less than a
/// cell; else from the area of the contact cells.
double measure_contact_radius(const Dimensionless& model, const Eigen::ArrayXd& pressure);

}  // namespace slipstick::solver
