#pragma once

#include <functional>
#include <ostream>
#include <vector>

#include "solver/history/history_step.hpp"
#include "solver/model/make_model.hpp"
#include "solver/solve.hpp"
#include "solver/step/pressure.hpp"

namespace slipstick::solver {

/// Gap over energy of a certificate. The last Newton step, whose states stand, goes far below it.
inline constexpr double kGap = 1e-13;
/// Two answers of the same discrete problem, each with that gap, in the largest traction, in motions and in
/// loads: the gap is of first order in the slip that is left in stick cells, so they agree to about its size
/// times the contact's condition.
inline constexpr double kSame = 1e-9;

/// The case of Gradinaru and Spinu, Section 5, with its exact answers (Hertz; Jaeger's construction,
/// evaluated to 30 digits): a sphere of 18 mm pressed by 1 kN on a half-space, both of steel.
namespace paper {
constexpr double kRadius = 0.018;
constexpr double kYoungModulus = 210e9;
constexpr double kPoissonRatio = 0.3;
constexpr double kLoad = 1000.0;
constexpr double kFriction = 0.1;

constexpr double kContactRadius = 0.48909732465087485e-3;
constexpr double kPeakPressure = 1995.9553043899548e6;
constexpr double kMomentLimit = 28.810210537755196e-3;

/// Relative twist of the bodies in rad at a part of the limit moment.
struct ExactTwist {
  double moment_ratio;
  double twist;
};
inline void PrintTo(const ExactTwist& exact, std::ostream* stream) { *stream << exact.moment_ratio; }
constexpr ExactTwist kTwists[] = {
    {0.1, 1.197249389022587e-4}, {0.5, 7.629453516649457e-4}, {0.9, 2.361048651456917e-3}};
}  // namespace paper

inline Scene paper_scene(Index cells, double moment_ratio) {
  const Material steel{paper::kYoungModulus, paper::kPoissonRatio};
  Scene scene;
  scene.source = "paper.toml";
  scene.surfaces.front().radius = paper::kRadius;
  scene.upper = scene.lower = steel;
  scene.contact.friction.coefficient = paper::kFriction;
  scene.steps[0].normal = paper::kLoad;
  scene.steps[0].torsion = MomentRatio{moment_ratio};
  scene.grid.cells = {cells, cells};
  return scene;
}

/// The same pressed by a body with two radii of curvature.
inline Scene ellipsoid_scene(Index cells, double radius_1, double radius_2, double moment_ratio) {
  Scene scene = paper_scene(cells, moment_ratio);
  scene.surfaces.front().shape = Shape::ellipsoid;
  scene.surfaces.front().radius_1 = radius_1;
  scene.surfaces.front().radius_2 = radius_2;
  return scene;
}

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

/// The scene solved by the paper's method.
inline ModelSolution by_paper_method(Scene scene) {
  scene.solver.method = Method::paper;
  return solve_in_model_units(scene);
}

/// 1/E* = sum of (1 - nu^2)/E.
inline double effective_modulus(const Scene& scene) {
  const auto compliance = [](const Material& body) {
    return (1.0 - body.poisson_ratio * body.poisson_ratio) / body.young_modulus;
  };
  return 1.0 / (compliance(scene.upper) + compliance(scene.lower));
}

/// The normal contact of a scene.
struct Contact {
  Model model;
  NormalSolution solution;
};

inline Contact press(const Scene& scene) {
  Contact contact{make_model(scene), {}};
  contact.solution = find_pressure(scene, contact.model, scene.steps[0]);
  return contact;
}

inline double load(const Contact& contact) {
  return contact.solution.pressure.sum() * contact.model.grid.cell_area() * contact.model.force_unit();
}

}  // namespace slipstick::solver
