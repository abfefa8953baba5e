#include "convergence/solve/accurate_solve.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "convergence/results/exact_result.hpp"
#include "convergence/solve/reached.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
using solver::Scene;

/// Whether the error will have to be estimated from two meshes. The normal contact of an ellipse has an exact
/// answer, but not its twist.
bool is_estimated(const Scene& scene, AccuracyOf of) { return !answers_exactly(scene, of); }

Scene chosen_scene(const Scene& scene, const AccuracyChoice& choice) {
  Scene chosen = with_cells(scene, choice.cells);
  chosen.tolerance = choice.tolerance;
  return chosen;
}

/// A second solve on half as many cells along each side, where the error is estimated from it.
constexpr double kWithCoarserSolve = 1.25;

const std::string kNoFinerMesh =
    fmt::format("a mesh that would is finer than {} cells across the contact, or does not fit in memory",
                kMaxCellsAcross);

/// Surfaces whose errors the data do not cover.
std::string note_on(const Scene& scene) {
  for (const solver::Surface& surface : scene.surfaces) {
    if (surface.shape == solver::Shape::roughness) {
      return "the mesh was chosen by data of smooth contacts: this surface is rough";
    }
  }
  return scene.surfaces.size() > 1
             ? "the mesh was chosen by data of one round contact: here are several shapes"
             : "";
}

Json account(const Scene& scene, const AccuracyTarget& target) {
  Json json{{"wanted", target.error}, {"quantity", accuracy_quantity(scene, target.of).name}};
  json["reached"] = nullptr;
  return json;
}

Json attempt_json(const SolvedScene& answer, const Scene& scene, const ReachedError& reached,
                  double seconds) {
  Json json{{"cells", answer.result["cells"]}, {"tolerance", scene.tolerance}};
  set_number(json, "error", reached.error, reached.why);
  json["seconds"] = seconds;
  return json;
}

}  // namespace

Scene scene_for(const Scene& scene, const AccuracyTarget& target) {
  if (scene.model == solver::ModelChoice::exact) return scene;
  return chosen_scene(scene,
                      choose_grid(scene, contact_on_grid(scene), target, is_estimated(scene, target.of)));
}

AccurateAnswer solve_to_accuracy(const Scene& scene, const AccuracyTarget& target, const GridSolve& solve) {
  const ContactOnGrid contact = contact_on_grid(scene);
  const bool estimated = is_estimated(scene, target.of);
  std::optional<AccuracyChoice> choice = choose_grid(scene, contact, target, estimated);
  AccurateAnswer found{.answer = {}, .accuracy = account(scene, target)};
  const double predicted = predicted_seconds(chosen_scene(scene, *choice), contact);
  Json attempts = Json::array();
  ReachedError reached{};
  std::string stopped = fmt::format("{} refinements did not get there", kMaxRefinements);
  for (int attempt = 0; attempt <= kMaxRefinements; ++attempt) {
    const Scene chosen = chosen_scene(scene, *choice);
    const auto start = std::chrono::steady_clock::now();
    found.answer = solve(chosen);
    reached = reached_error(chosen, found.answer.solution, found.answer.result, target.of);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    attempts.push_back(attempt_json(found.answer, chosen, reached, seconds));
    found.reached = reached.error <= target.error;
    if (found.reached) break;
    choice = refined(scene, contact, target, *choice, reached.error);
    if (!choice) {
      stopped = std::isfinite(reached.error) ? kNoFinerMesh : reached.why;
      break;
    }
  }
  if (!found.reached) found.accuracy["not_reached"] = stopped;
  set_number(found.accuracy, "reached", reached.error, reached.why);
  found.accuracy.update({{"how", reached.how}, {"why", reached.why}, {"attempts", std::move(attempts)}});
  set_number(found.accuracy, "predicted_seconds", predicted * (estimated ? kWithCoarserSolve : 1.0),
             "measured for method = \"coulomb\" with operator = \"dcfft\" alone");
  found.accuracy["replaced"] = {{"cells", scene.cells}, {"tolerance", scene.tolerance}};
  if (const std::string note = note_on(scene); !note.empty()) found.accuracy["note"] = note;
  return found;
}

Json exact_accuracy(const Scene& scene, const AccuracyTarget& target) {
  const Oracle oracle = require_oracle(scene);
  if (!(oracle.relative_uncertainty <= target.error)) {
    throw InputError(
        fmt::format("--accuracy {:g}", target.error),
        fmt::format("allowed: {:.2g} or more, the exact answer's own uncertainty in double precision",
                    oracle.relative_uncertainty));
  }
  Json json = account(scene, target);
  json.update({{"reached", oracle.relative_uncertainty},
               {"how", "exact"},
               {"why", "the exact solution needs no grid; this is its own uncertainty"},
               {"attempts", Json::array()}});
  Scene on_grid = scene;
  on_grid.model = solver::ModelChoice::automatic;
  try {
    json["grid_instead"] = plan_json(scene_for(on_grid, target));
  } catch (const InputError& error) {
    set_missing(json, "grid_instead", error.what());
  }
  return json;
}

std::string accuracy_text(const Json& result) {
  const Json& accuracy = result["accuracy"];
  std::string text = text_line(
      "accuracy", fmt::format("{} of the {}, {} wanted ({}: {})", short_text(accuracy["reached"]),
                              accuracy["quantity"].get<std::string>(), number_text(accuracy["wanted"]),
                              accuracy["how"].get<std::string>(), accuracy["why"].get<std::string>()));
  if (accuracy.contains("not_reached")) {
    text += text_line("not reached", accuracy["not_reached"].get<std::string>());
  }
  for (const Json& attempt : accuracy["attempts"]) {
    text += text_line(
        "attempt", fmt::format("{} x {} cells, tolerance {}: error {}, {} s", attempt["cells"][0].get<int>(),
                               attempt["cells"][1].get<int>(), short_text(attempt["tolerance"]),
                               short_text(attempt["error"]), short_text(attempt["seconds"])));
  }
  if (accuracy.contains("replaced")) {
    const Json& replaced = accuracy["replaced"];
    text +=
        text_line("replaced", fmt::format("grid.cells = [{}, {}] and solver.tolerance = {} of the scene",
                                          replaced["cells"][0].get<int>(), replaced["cells"][1].get<int>(),
                                          short_text(replaced["tolerance"])));
  }
  if (accuracy.contains("grid_instead")) {
    const Json& grid = accuracy["grid_instead"];
    text += text_line("on a grid", grid.is_null()
                                       ? accuracy["grid_instead_reason"].get<std::string>()
                                       : fmt::format("it would take {} x {} cells and about {} s",
                                                     grid["cells"][0].get<int>(), grid["cells"][1].get<int>(),
                                                     short_text(grid["seconds"])));
  }
  if (accuracy.contains("note")) text += text_line("note", accuracy["note"].get<std::string>());
  return text;
}

}  // namespace slipstick::convergence
