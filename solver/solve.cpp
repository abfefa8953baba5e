#include "solver/solve.hpp"

#include <limits>
#include <utility>

#include "solver/grid/threads.hpp"
#include "solver/history/history_step.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/model/within_double.hpp"

namespace slipstick::solver {
namespace {

void require_can_solve(const Scene& scene) {
  validate(scene);
  if (scene.solver.model == ModelChoice::exact) {
    throw InputError(scene.source.string(), "solver.model", "\"exact\"", "auto, full for a solve on a grid");
  }
  if (!scene.solver.program.empty()) {
    throw InputError(scene.source.string(), "solver.program", scene.solver.program.string(),
                     "left out: another program answers where the slipstick program runs it");
  }
}

/// The cache of the model's operators, with the room that the solve leaves: the one given, or one of its own
/// where operators are needed more than once.
std::shared_ptr<SolveCache> prepare_cache(std::shared_ptr<SolveCache> cache, const Scene& scene, const Model& model) {
  const bool repeats = scene.steps.size() > 1 || scene.cycles > 1 || model.shear_coupling;
  if (!cache && repeats) cache = std::make_shared<SolveCache>();
  if (cache) {
    const double room = scene.solver.memory_limit.value_or(std::numeric_limits<double>::infinity()) -
                        predicted_memory(scene, model).total();
    cache->begin_solve(scene.solver.rounding_seed == 0 ? room : 0.0);  // rounding changes with every application
  }
  return cache;
}

Solution solve_steps(const Scene& scene, const SolveOptions& options) {
  const Observer& observer = options.observer;
  Stopwatch watch(options.cache.get());
  Model model = make_model(scene, options.ranks);
  const ThreadPool threads(model.threads);
  model.cache = prepare_cache(options.cache, scene, model);
  double setup = watch.lap();
  HistoryState state;
  if (options.resumed) state = restore_state(*options.resumed, scene, model.grid.cells());
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  for (;;) {
    HistoryStep step = solve_history_step(scene, model, std::move(state), options.detail, observer.progress);
    step.totals.seconds.setup = std::exchange(setup, 0.0);
    step.totals.seconds.total += step.totals.seconds.setup;
    const bool ends = !step.converged() || step.state.finished + 1 == steps;
    if (!ends) state = step.after();
    if (ends || observer.step) {
      Solution solution = to_si(std::move(step), scene, model);
      if (observer.step) observer.step(solution);
      if (ends) return solution;
    }
    if (observer.state) observer.state(state);
  }
}

}  // namespace

Solution solve(const Scene& scene, const SolveOptions& options) {
  require_can_solve(scene);
  return within_double(scene, [&] { return solve_steps(scene, options); });
}

}  // namespace slipstick::solver
