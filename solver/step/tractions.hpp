#pragma once

#include <Eigen/Core>
#include <functional>

#include "solver/contact/full_coupling.hpp"
#include "solver/contact/limit_load.hpp"
#include "solver/contact/tangential_problem.hpp"
#include "solver/model/model.hpp"
#include "solver/step/contact_state.hpp"

namespace slipstick::solver {

/// A step's tangential problem, and what its contact can carry.
struct LoadStep {
  TangentialProblem problem;
  double moment_limit;     ///< over the cell area, without force
  LimitLoad limit;         ///< of the loads that the step imposes
  bool is_coulomb = true;  ///< the bound is mu p

  bool carried() const { return limit.factor > 1.0; }
};

/// The change that a step of a scene brings to a contact under its pressure, on the model's grid.
LoadStep load_step(const Scene& scene, const Model& model, const Step& step, const Eigen::ArrayXd& pressure,
                   const ContactState& before);

/// Throws InputError for gross slip, with what the contact carries and how it would slide.
void require_carried(const Scene& scene, const Model& model, const Step& step, const LoadStep& loads);

/// The tractions of a step under its pressure, on the whole grid; note_omissions() is told what was left out.
/// Moves what only the solve needs out of loads.problem. goal: where a turn under full coupling wants less
/// than all. progress: called now and then.
TangentialSolution find_tractions(Model& model, const Scene& scene, LoadStep& loads,
                                  const Eigen::ArrayXd& pressure, const ContactState& before,
                                  const std::function<void(int iteration, double change)>& progress,
                                  const StaggeredTarget& goal = {});

/// The slip of the step in cells that are pressed and have no friction: no traction depends on it.
void add_slip_without_friction(TangentialSolution& solution, const Scene& scene, const Model& model,
                               const Eigen::ArrayXd& bound, const Eigen::ArrayXd& pressure,
                               const ContactState& before);

}  // namespace slipstick::solver
