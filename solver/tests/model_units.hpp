#pragma once

#include <functional>
#include <vector>

#include "solver/history/history_step.hpp"
#include "solver/model/make_model.hpp"
#include "solver/solve.hpp"

namespace slipstick::solver {

/// A solution, and its fields in the model's units.
struct ModelSolution : Solution {
  Model model;
  NormalSolution normal;
  TangentialSolution tangential;
};

/// The steps of a scene as solve() takes them; returns the last one.
inline ModelSolution solve_in_model_units(const Scene& scene,
                                          const std::function<void(const ModelSolution&)>& on_step = {}) {
  validate(scene);
  Model model = make_model(scene);
  const bool repeats = scene.steps.size() > 1 || scene.cycles > 1 || model.shear_coupling;
  if (repeats) model.cache = std::make_shared<SolveCache>();
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  HistoryState state;
  for (;;) {
    const HistoryStep step = solve_history_step(scene, model, state, Detail::all);
    ModelSolution solution{to_si(step, scene, model), model, step.last.solved.normal, step.last.solved.tangential};
    solution.model.cache = nullptr;
    if (on_step) on_step(solution);
    if (!step.converged() || step.state.finished + 1 == steps) return solution;
    state = step.after();
  }
}

/// The solutions at the ends of a scene's steps.
inline std::vector<Solution> steps_of(const Scene& scene) {
  std::vector<Solution> steps;
  solve(scene, {.observer = {.step = [&](const Solution& step) { steps.push_back(step); }}});
  return steps;
}

}  // namespace slipstick::solver
