#include "solver/history/history_step.hpp"

#include <fmt/core.h>

#include <limits>
#include <utility>

#include "solver/history/load_parts.hpp"
#include "solver/step/resolution.hpp"
#include "solver/step/to_si.hpp"

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

}  // namespace

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
    const StepEnd end = end_of(numbers.loads);
    state.open.add(std::exchange(state.end, end), end, numbers.quality.resolution);
    add(step.totals, numbers.energy, step.last.work);
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
