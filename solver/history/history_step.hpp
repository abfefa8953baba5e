#pragma once

#include "solver/history/history_state.hpp"
#include "solver/model/model.hpp"
#include "solver/step/solve_step.hpp"

namespace slipstick::solver {

/// Numbers that add up over the parts of a step: SI units, seconds.
struct StepTotals {
  double dissipated = 0.0;
  double work = 0.0;
  double operator_applications = 0.0;
  double pressure_applications = 0.0;
  Seconds seconds;
};

/// A step of a history, up to its end or to the part that did not converge.
struct HistoryStep {
  StepResult last;     ///< of the last part that was solved
  StepTotals totals;   ///< of all parts that were solved
  std::size_t solved;  ///< parts
  std::size_t parts;   ///< parts of the whole step
  /// The history's state at the start of the last part, with the loads at the end of it.
  HistoryState state;

  bool converged() const { return last.status == Status::converged; }
  /// The state after the step.
  HistoryState after() const;
};

/// The loads at the ends of the parts of a step, `scene.solver.substeps` of them; the last one is the step
/// itself. Each part is an implicit step of its own, which opposes traction to its slip as a whole: so the
/// answer depends on the number of parts wherever slip turns within a step, or the contact grows or shrinks
/// while it slips, and tends to that of Coulomb's law like one over that number. Tangential loads and imposed
/// motions are interpolated linearly, from their values at the end of the step before. Where the normal load
/// changes too, the first half of the parts brings it, and the second half the tangential loads; a single
/// part brings both at once. The first step begins with its normal load.
std::vector<Step> parts_of(const Scene& scene, const Step& step, const Step* previous, const LoadNumbers& before);

/// Solves the step of a scene that follows a state, part by part.
HistoryStep solve_history_step(const Scene& scene, const Model& model, HistoryState before, Detail detail,
                               const Progress& progress = {});

/// The answer to a step of a scene in SI units. Where a part broke off, numbers at the end of the step are NaN.
Solution to_si(HistoryStep step, const Scene& scene, const Model& model);

}  // namespace slipstick::solver
