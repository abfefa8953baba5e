#include "convergence/runs/solve_scene.hpp"

#include <utility>

#include "convergence/exchange/program_solve.hpp"
#include "convergence/results/make_record.hpp"
#include "convergence/runs/path_uncertainty.hpp"
#include "solver/elasticity/elasticity.hpp"
#include "solver/history/history_state.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/within_double.hpp"

namespace slipstick::convergence {
namespace {

SolvedScene solve_elsewhere(const solver::Scene& scene, const AllowedPrograms& programs) {
  ProgramAnswer answer = solve_by_program(scene, programs);
  SolvedScene solved{.solution = std::move(answer.solution), .exact = std::move(answer.exact), .record = {}};
  solved.record =
      solver::within_double(scene, [&] { return make_record(answer.scene, solved.solution, solved.exact); });
  solved.record.problem.method = "program";
  solved.record.program = std::move(answer.program);
  return solved;
}

}  // namespace

SolvedScene solve_scene(const solver::Scene& scene, const SolveSceneOptions& options) {
  if (!scene.solver.program.empty() && options.programs.all) return solve_elsewhere(scene, options.programs);
  auto history = solver::within_double(scene, [&] { return exact_history(scene); });
  SolvedScene solved;
  std::vector<StepRecord> steps;
  solver::SolveOptions to_solver{
      .observer = {options.progress}, .cache = options.cache, .detail = options.detail, .ranks = options.ranks};
  if (options.resumed) {
    steps = options.resumed->steps;
    to_solver.resumed = options.resumed->state;
    for (std::size_t k = 0; k < to_solver.resumed->finished; ++k) {
      solved.exact = history.advance(solver::step_of(scene, k));
    }
  }
  to_solver.observer.step = [&](const solver::Solution& at) {
    const solver::KeptRounding scope(static_cast<int>(Rounding::nearest));
    solved.exact = history.advance(at.loads);
    if (has_history(scene)) steps.push_back(make_step(scene, at, solved.exact));
    if (options.on_step) options.on_step(at, solved.exact);
  };
  if (options.on_state) {
    to_solver.observer.state = [&](const solver::HistoryState& state) { options.on_state(state, steps); };
  }
  try {
    const solver::KeptRounding scope(static_cast<int>(options.rounding));
    solved.solution = solve_with_path(scene, to_solver);
  } catch (const solver::InputError& error) {
    if (!steps.empty() && options.incomplete != nullptr) {
      *options.incomplete = make_incomplete(scene.name, error.what(), std::move(steps));
    }
    throw;
  }
  solved.record =
      solver::within_double(scene, [&] { return make_record(scene, solved.solution, solved.exact, std::move(steps)); });
  return solved;
}

}  // namespace slipstick::convergence
