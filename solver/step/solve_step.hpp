#pragma once

#include <string>
#include <vector>

#include "solver/step/describe_step.hpp"

/// One load step, Scene -> Model -> StepResult:
/// 1. the pressure under the step's normal load, kept where that load has not changed (pressure.hpp);
/// 2. the step's tangential problem and its limit loads; gross slip is refused (tractions.hpp);
/// 3. the tractions by the scene's method (tractions.hpp);
///    under full coupling 1 to 3 are repeated in turns until pressure and tractions agree
///    (full_coupling.hpp);
/// 4. the numbers of the step, with its certificate (describe_step.hpp);
/// 5. the status: converged only where both solves did and the certificate keeps its bounds.
namespace slipstick::solver {

/// The answer to a step, in the model's units.
struct StepResult {
  Status status = Status::not_converged;
  std::string message;  ///< why it did not converge
  StepLoads step;
  SolvedStep solved;
  RigidMotion motion;  ///< since the first step began
  StepNumbers numbers;
  WorkNumbers work;
  std::vector<Omission> left_out;
};

/// Throws InputError for gross slip and for a contact that the grid's edge cuts off.
StepResult solve_step(const Scene& scene, const Model& model, const StepLoads& step, const ContactState& before,
                      const Progress& progress = {});

/// The contact at the end of a step that started from `before`.
ContactState contact_after(const ContactState& before, const StepResult& step);

/// The numbers of a step in SI units.
StepNumbers to_si(StepNumbers numbers, const Model& model);

/// The answer to a step in SI units: its fields and numbers, each times its unit. Throws std::domain_error
/// where that leaves double precision.
Solution to_si(StepResult result, const Model& model);

}  // namespace slipstick::solver
