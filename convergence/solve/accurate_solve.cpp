#include "convergence/solve/accurate_solve.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "convergence/results/exact_result.hpp"
#include "convergence/runs/path_uncertainty.hpp"
#include "convergence/solve/cost.hpp"
#include "convergence/solve/reached.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
using solver::Scene;

/// Whether the error will have to be estimated from two meshes. The normal contact of an ellipse has an exact
/// answer, but not its twist.
bool is_estimated(const Scene& scene, AccuracyOf of) { return !answers_exactly(scene, of); }

/// How a scene's answer is made: on which meshes, and whether it is a mean over shifted grids.
struct Approach {
  ContactOnGrid contact;
  bool smooth;  ///< cell tractions
  bool shifted;
  ContactForm form;  ///< of shifted grids
};

Approach approach_to(const Scene& scene, const AccuracyTarget& target) {
  const bool shifted = takes_shifted_grids(scene, target.of);
  return {contact_on_grid(scene), gains_by_smooth_cells(scene, target.of), shifted,
          shifted ? coarse_form(scene, target) : ContactForm{}};
}

AccuracyChoice first_choice(const Scene& scene, const Approach& approach, const AccuracyTarget& target) {
  return approach.shifted ? choose_shifted(scene, approach.contact, target, approach.form)
                          : choose_grid(scene, approach.contact, target, is_estimated(scene, target.of));
}

Scene chosen_scene(const Scene& scene, const Approach& approach, const AccuracyChoice& choice) {
  Scene chosen = with_cells(scene, choice.cells);
  chosen.solver.tolerance = std::max(choice.tolerance / scene.solver.substeps, kTightestTolerance);
  if (approach.smooth) chosen.solver.cell_traction = solver::CellTraction::smooth;
  return chosen;
}

/// The part of a target that the length of the steps may take, the largest such part, the largest number of
/// parts of a step, and the limits of trial solves on few cells: beyond them the error is taken to fall like
/// one over the number of parts.
constexpr double kPathPart = 0.4;
constexpr double kMaxPathPart = 0.8;
constexpr int kMaxSubsteps = 256;
constexpr int kPathTrials = 4;
constexpr std::size_t kPathTrialParts = 300;

/// The relative uncertainty of the wanted number that the length of steps leaves.
double path_of(const solver::Solution& solution) {
  const solver::Resolution& resolved = solution.resolution;
  const double path = resolved.path.*resolved.number;
  const bool turns = resolved.number == &solver::Quantities::twist;
  return path > 0.0 ? path / std::abs(turns ? solution.twist_angle : solution.moment) : 0.0;
}

/// Puts the known error of the number where the answer states its uncertainty.
void put_uncertainty(EndRecord& end, double mesh, double path) {
  ResolutionRecord& resolved = end.resolution;
  const bool turns = resolved.number == "twist_angle";
  if (!turns && resolved.number != "moment") return;
  const double value = std::abs(turns ? end.loads.twist_angle : end.loads.moment);
  if (!std::isfinite(mesh * value)) return;
  resolved.uncertainty = {mesh + path};
  resolved.absolute = {(mesh + path) * value};
  resolved.mesh = {mesh * value};
  resolved.path = {path * value};
  (turns ? resolved.paths.twist_angle : resolved.paths.moment) = resolved.path;
  resolved.warning.clear();
}

/// As many parts as leave as little as the target allows them, or the most, and what they leave, if that
/// falls like one over their number.
void make_more_parts(Scene& scene, AccuracyTarget& target) {
  const double left = scene.solver.substeps * target.path;
  const double needed = std::ceil(left / (0.8 * kPathPart * target.error));
  scene.solver.substeps = needed < kMaxSubsteps ? static_cast<int>(needed) : kMaxSubsteps;
  target.path = std::min(left / scene.solver.substeps, kMaxPathPart * target.error);
}

/// The scene with as many parts of its steps as the target takes, and in the target what they leave, found on
/// few cells.
Scene with_parts(Scene scene, AccuracyTarget& target) {
  if (target.of != AccuracyOf::twist || !is_estimated(scene, target.of)) return scene;
  Scene coarse = with_cells(scene, kReferenceCells);
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  for (int trial = 0; trial < kPathTrials && scene.solver.substeps < kMaxSubsteps; ++trial) {
    coarse.solver.substeps = scene.solver.substeps;
    if (trial > 0 && steps * static_cast<std::size_t>(scene.solver.substeps) > kPathTrialParts) return scene;
    double path = 0.0;
    try {
      path = path_of(solve_with_path(coarse));
    } catch (const InputError&) {
      return scene;  // the mesh that counts may do better, or says it again
    }
    target.path = path;
    if (!(path > kPathPart * target.error)) return scene;
    make_more_parts(scene, target);
  }
  return scene;
}

const std::string kNoFinerMesh =
    fmt::format("a mesh that would is finer than {} cells across the contact, or does not fit in memory",
                kMaxCellsAcross);

Json account(const Scene& scene, const AccuracyTarget& target) {
  Json json{{"wanted", target.error}, {"quantity", accuracy_quantity(scene, target.of).name}};
  json["reached"] = nullptr;
  return json;
}

const char* const kPathNotKnown =
    "the length of the steps changes this number by an unknown amount: compare with a larger solver.substeps";

/// One attempt: its answer, and what is known of its error.
struct Attempt {
  SolvedScene answer;
  ReachedError reached;
  double uncertainty;  ///< of a mean over shifted grids; NaN of another answer
  Json grids;          ///< likewise; else null
  double path;         ///< what the length of steps leaves open beside it; NaN: not known

  /// NaN never is.
  bool within(double error) const {
    const double mesh = error - path;
    return reached.error <= mesh && (std::isnan(uncertainty) || uncertainty <= mesh);
  }
  /// The error that the next mesh has to lower.
  double to_lower() const { return std::fmax(reached.error, uncertainty); }
};

Attempt attempt(const Scene& scene, const Approach& approach, AccuracyOf of, const GridSolve& solve) {
  if (!approach.shifted) {
    Attempt made{.answer = solve(scene, solver::Detail::all),
                 .reached = {},
                 .uncertainty = NAN,
                 .grids = {},
                 .path = 0.0};
    made.reached = reached_error(scene, made.answer.solution, to_json(made.answer.record), of);
    if (of == AccuracyOf::twist) {
      made.path = path_of(made.answer.solution);
    } else if (made.reached.how != "exact" && depends_on_path(scene, made.answer.solution.coupled)) {
      made.path = NAN;
    }
    return made;
  }
  ShiftedMean mean =
      mean_over_shifted_grids(scene, accuracy_quantity(scene, of), approach.form, approach.contact, solve);
  ReachedError reached{mean.uncertainty, "estimated", mean.why};
  if (std::isfinite(mean.uncertainty) && std::isfinite(mean.error)) {
    reached = {std::abs(mean.error), "exact",
               fmt::format("the mean of {} grids against the exact answer", mean.grids.size())};
  }
  const double path = reached.how == "exact" ? 0.0 : path_of(mean.answer.solution);
  return {std::move(mean.answer), reached, mean.uncertainty, std::move(mean.grids), path};
}

Json attempt_json(const Attempt& made, const Scene& scene, double seconds) {
  Json json{{"cells", made.answer.record.problem.cells}, {"tolerance", scene.solver.tolerance}};
  set_number(json, "error", made.reached.error, made.reached.why);
  json["seconds"] = seconds;
  if (!made.grids.is_null()) json["grids"] = made.grids;
  return json;
}

}  // namespace

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

Json accuracy_plan(const Scene& given, AccuracyTarget target) {
  if (given.solver.model == solver::ModelChoice::exact) return plan_json(given);
  const Scene scene = with_parts(given, target);
  const Approach approach = approach_to(scene, target);
  Json plan = plan_json(chosen_scene(scene, approach, first_choice(scene, approach, target)));
  if (!approach.shifted) return plan;
  plan["grids"] = kShiftedGrids;
  if (plan["seconds"].is_number()) plan["seconds"] = kShiftedGrids * plan["seconds"].get<double>();
  return plan;
}

AccurateAnswer solve_to_accuracy(const Scene& given, AccuracyTarget target, const GridSolve& solve) {
  Scene scene = with_parts(given, target);
  const Approach approach = approach_to(scene, target);
  const double order = approach.shifted ? kShiftedOrder : falling_order(accuracy_data(), target.of);
  std::optional<AccuracyChoice> choice = first_choice(scene, approach, target);
  AccurateAnswer found{.answer = {}, .accuracy = account(scene, target)};
  Json attempts = Json::array();
  Attempt made{};
  std::string stopped = fmt::format("{} refinements did not get there", kMaxRefinements);
  for (int refinement = 0; refinement <= kMaxRefinements; ++refinement) {
    const Scene chosen = chosen_scene(scene, approach, *choice);
    const auto start = std::chrono::steady_clock::now();
    made = attempt(chosen, approach, target.of, solve);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    attempts.push_back(attempt_json(made, chosen, seconds));
    found.reached = made.within(target.error);
    if (found.reached) break;
    if (std::isnan(made.path) && made.reached.error <= target.error) {
      stopped = kPathNotKnown;
      break;
    }
    target.path = std::isnan(made.path) ? 0.0 : made.path;
    if (made.path > kPathPart * target.error) {
      if (!(made.path < target.error) && (scene.solver.substeps >= kMaxSubsteps || std::isinf(made.path))) {
        stopped = fmt::format("steps in {} parts leave {:.2g} open; write out more steps",
                              scene.solver.substeps, made.path);
        break;
      }
      make_more_parts(scene, target);
      if (made.to_lower() <= target.of_mesh()) continue;
    }
    choice = refined(scene, approach.contact, target, *choice, made.to_lower(), order);
    if (!choice) {
      stopped = std::isfinite(made.reached.error) ? kNoFinerMesh : made.reached.why;
      break;
    }
  }
  if (!found.reached) found.accuracy["not_reached"] = stopped;
  const bool known = !std::isnan(made.path);
  set_number(found.accuracy, "reached", made.reached.error + made.path,
             known ? made.reached.why : kPathNotKnown);
  set_number(found.accuracy, "path", made.path,
             known ? "more parts of the steps do not carry these loads" : kPathNotKnown);
  found.accuracy["substeps"] = scene.solver.substeps;
  found.accuracy.update(
      {{"how", made.reached.how}, {"why", made.reached.why}, {"attempts", std::move(attempts)}});
  if (approach.shifted) set_number(found.accuracy, "uncertainty", made.uncertainty, made.reached.why);
  found.accuracy["replaced"] = {{"cells", scene.grid.cells}, {"tolerance", scene.solver.tolerance}};
  if (const std::string note = note_on(scene); !note.empty()) found.accuracy["note"] = note;
  found.answer = std::move(made.answer);
  if (target.of == AccuracyOf::twist) put_uncertainty(found.answer.record.end, made.to_lower(), made.path);
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
  return json;
}

std::string accuracy_text(const Json& result) {
  const Json& accuracy = result["accuracy"];
  std::string text = text_line(
      "accuracy", fmt::format("{} of the {}, {} wanted ({}: {})", short_text(accuracy["reached"]),
                              accuracy["quantity"].get<std::string>(), number_text(accuracy["wanted"]),
                              accuracy["how"].get<std::string>(), accuracy["why"].get<std::string>()));
  if (accuracy.contains("uncertainty")) {
    text += text_line("uncertainty", fmt::format("{} of it (95 %), the mean of {} grids",
                                                 short_text(accuracy["uncertainty"]), kShiftedGrids));
  }
  if (accuracy.value("substeps", 1) > 1) {
    text += text_line("steps", fmt::format("each in {} parts, which leave {} open",
                                           accuracy["substeps"].get<int>(), short_text(accuracy["path"])));
  }
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
  if (accuracy.contains("note")) text += text_line("note", accuracy["note"].get<std::string>());
  return text;
}

}  // namespace slipstick::convergence
