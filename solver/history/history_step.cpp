#include "solver/history/history_step.hpp"

#include <fmt/core.h>

#include <limits>
#include <utility>

#include "solver/step/resolution.hpp"

namespace slipstick::solver {
namespace {

/// A step that broke off in one of its parts has no numbers at its end.
void break_off(Solution& solution, const HistoryStep& at, const Step& step) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  solution.message = fmt::format("{}, part {} of {}: {}", step.key, at.solved, at.parts, solution.message);
  solution.loads = step;
  for (double* const number : {&solution.twist_angle, &solution.moment, &solution.limit.factor,
                               &solution.elastic_energy, &solution.dissipated, &solution.work})
    *number = kUnknown;
  solution.displacement = solution.force = {kUnknown, kUnknown};
}

void add(StepTotals& totals, const EnergyNumbers& energy, const WorkNumbers& work) {
  totals.dissipated += energy.dissipated;
  totals.work += energy.work;
  totals.operator_applications += work.operator_applications;
  totals.pressure_applications += work.pressure_applications;
  totals.seconds.pressure += work.seconds.pressure;
  totals.seconds.traction += work.seconds.traction;
  totals.seconds.total += work.seconds.total;
}

/// The torsion that the contact carries, or its twist, as a load of this kind.
TorsionLoad as_load(const TorsionLoad& kind, const LoadNumbers& at) {
  if (std::holds_alternative<Twist>(kind)) return Twist{at.twist_angle};
  if (std::holds_alternative<Moment>(kind)) return Moment{at.moment};
  return MomentRatio{at.moment_limit > 0.0 ? at.moment / at.moment_limit : 0.0};
}

/// The tangential loads that the contact carries, or its motions, in place of a step's.
Step with_loads(Step step, const LoadNumbers& at) {
  step.torsion = as_load(step.torsion, at);
  if (step.displacement) {
    step.displacement = at.displacement;
  } else {
    step.force = at.force;
  }
  return step;
}

}  // namespace

std::vector<Step> parts_of(const Scene& scene, const Step& step, const Step* previous, const LoadNumbers& before) {
  const int parts = scene.solver.substeps;
  const bool presses = previous != nullptr && previous->normal && previous->normal != step.normal;
  const int pressing = presses ? parts / 2 : 0;
  const Step pressed = with_loads(step, before);
  Step unpressed = pressed;
  if (presses) unpressed.normal = previous->normal;
  std::vector<Step> loads;
  for (int k = 1; k <= pressing; ++k) {
    loads.push_back(on_the_way(unpressed, pressed, static_cast<double>(k) / pressing));
  }
  for (int k = pressing + 1; k < parts; ++k) {
    loads.push_back(on_the_way(pressed, step, static_cast<double>(k - pressing) / (parts - pressing)));
  }
  loads.push_back(step);
  return loads;
}

HistoryState HistoryStep::after() const {
  return {state.finished + 1, contact_after(state.contact, last), state.end, state.open};
}

HistoryStep solve_history_step(const Scene& scene, const Model& model, HistoryState before, Detail detail,
                               const Progress& progress) {
  const std::size_t k = before.finished;
  const Step previous = step_of(scene, k > 0 ? k - 1 : 0);
  const std::vector<Step> parts = parts_of(scene, step_of(scene, k), k > 0 ? &previous : nullptr, before.end);
  HistoryStep step{.last = {}, .totals = {}, .solved = 0, .parts = parts.size(), .state = std::move(before)};
  HistoryState& state = step.state;
  for (const Step& part : parts) {
    if (step.solved > 0) {
      state.contact = contact_after(state.contact, step.last);
      step.last = {};
    }
    step.last = solve_step(scene, model, {part, detail}, state.contact, progress);
    ++step.solved;
    const StepNumbers numbers = to_si(step.last.numbers, model);
    state.open.add(state.end, numbers, numbers.resolution);
    state.end = numbers;
    add(step.totals, numbers, step.last.work);
    if (!step.converged()) break;
  }
  return step;
}

Solution to_si(HistoryStep step, const Scene& scene, const Model& model) {
  const std::size_t k = step.state.finished;
  Solution solution = to_si(std::move(step.last), model);
  solution.cycle = static_cast<int>(k / scene.steps.size()) + 1;
  solution.dissipated = step.totals.dissipated;
  solution.work = step.totals.work;
  solution.operator_applications = step.totals.operator_applications;
  solution.pressure_applications = step.totals.pressure_applications;
  solution.seconds = step.totals.seconds;
  if (step.solved < step.parts) break_off(solution, step, step_of(scene, k));
  solution.resolution = with_uncertainty(solution, scene, k, step.state.open.mesh());
  return solution;
}

}  // namespace slipstick::solver
