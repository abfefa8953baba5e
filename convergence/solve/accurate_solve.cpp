#include "convergence/solve/accurate_solve.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/results/exact_result.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/path_uncertainty.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
using solver::Scene;

/// Whether the error has to be estimated from two meshes. For an ellipse only the normal contact has an exact
/// answer, not the twist.
bool is_estimated(const Scene& scene, AccuracyOf of) { return !answers_exactly(scene, of); }

struct Approach {
  ContactOnGrid contact;
  bool smooth;       ///< smooth cell tractions
  bool shifted;      ///< the answer is a mean over shifted grids
  ContactForm form;  ///< for shifted grids
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

/// The errors that a tolerance leaves add up over the parts of a history: 194 parts, each to 1e-4/97, left 2.8e-5.
constexpr double kTighterInParts = 3.0;

Scene chosen_scene(const Scene& scene, const Approach& approach, const AccuracyChoice& choice) {
  Scene chosen = with_cells(scene, choice.cells);
  const auto parts = static_cast<double>(scene.steps.size()) * scene.cycles * scene.solver.substeps;
  chosen.solver.tolerance = parts > 1.0 ? choice.tolerance / (kTighterInParts * parts) : choice.tolerance;
  chosen.solver.tolerance = std::max(chosen.solver.tolerance, kTightestTolerance);
  if (approach.smooth) chosen.solver.cell_traction = solver::CellTraction::smooth;
  return chosen;
}

/// Parts of a target for the error by the length of the steps: the usual one and the largest. kMaxSubsteps is
/// the largest number of parts of a step. Trial solves on few cells find that error: at most kPathTrials,
/// with at most kPathTrialParts parts in all; beyond them the error is assumed to fall as 1/parts.
constexpr double kPathPart = 0.4;
constexpr double kMaxPathPart = 0.8;
constexpr int kMaxSubsteps = 256;
constexpr int kPathTrials = 4;
constexpr std::size_t kPathTrialParts = 300;
/// The number of parts, and the mesh, are chosen with this margin.
constexpr double kPathMargin = 0.8;
/// The error of n parts falls like 1/(n + kBeforeLinear) from kFewestCorrected parts on.
constexpr double kBeforeLinear = 1.6;
/// Uncertainty of a correction on a fine mesh: this part of it, and more that parts do not lower.
constexpr double kLeftOfChange = 0.042;
constexpr double kLeftOnMesh = 1e-6;

/// Relative uncertainty of the twist, or moment, by the length of the steps.
double path_of(const solver::Solution& solution) {
  const solver::Resolution& resolved = solution.resolution;
  const double path = resolved.path.*resolved.number;
  const bool turns = resolved.number == &solver::Quantities::twist;
  return path > 0.0 ? path / std::abs(turns ? solution.twist_angle : solution.moment) : 0.0;
}

/// Sets the number of parts of each step so that their error is within its part of the target, at most
/// kMaxSubsteps, and the error expected of them, which falls as 1/parts.
void make_more_parts(Scene& scene, AccuracyTarget& target) {
  const double before = scene.solver.substeps < kFewestCorrected ? 0.0 : kBeforeLinear;
  const double left = (scene.solver.substeps + before) * target.path / kPathMargin;
  const double needed = std::ceil(left / (kPathPart * target.error) - before);
  scene.solver.substeps = needed < kMaxSubsteps ? static_cast<int>(needed) : kMaxSubsteps;
  target.path = std::min(left / (scene.solver.substeps + before), kMaxPathPart * target.error);
}

/// The same of a coarse answer, with what the correction of a mean over shifted grids leaves: there, if that
/// is enough, or else on a fine mesh.
double path_left(const Scene& scene, double enough) {
  const solver::Solution solution = solve_with_path(scene);
  if (!takes_shifted_grids(scene, AccuracyOf::twist)) return path_of(solution);
  const std::optional<PathCorrection> correction = path_correction(scene, solution);
  if (!correction) return path_of(solution);
  const double fine = kLeftOfChange * std::abs(correction->change) + kLeftOnMesh;
  return correction->uncertainty <= enough ? correction->uncertainty : std::min(correction->uncertainty, fine);
}

/// The scene with the number of parts of its steps that the target needs, found on few cells; target.path
/// gets their error.
Scene with_parts(Scene scene, AccuracyTarget& target) {
  if (target.of != AccuracyOf::twist || !is_estimated(scene, target.of)) return scene;
  Scene coarse = with_cells(scene, kReferenceCells);
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  for (int trial = 0; trial < kPathTrials && scene.solver.substeps < kMaxSubsteps; ++trial) {
    coarse.solver.substeps = scene.solver.substeps;
    if (trial > 0 && steps * static_cast<std::size_t>(scene.solver.substeps) > kPathTrialParts) return scene;
    double path = 0.0;
    try {
      path = path_left(coarse, kPathPart * target.error);
    } catch (const InputError&) {
      return scene;  // the chosen mesh may carry the loads; if not, its solve throws the error
    }
    target.path = path;
    if (!(path > kPathPart * target.error)) {
      target.path /= kPathMargin;
      return scene;
    }
    if (takes_shifted_grids(scene, target.of) && scene.solver.substeps < kFewestCorrected) {
      scene.solver.substeps = kFewestCorrected;
      target.path = std::min(path, kMaxPathPart * target.error);
    } else {
      make_more_parts(scene, target);
      if (takes_shifted_grids(scene, target.of)) return scene;
    }
  }
  return scene;
}

const std::string kNoFinerMesh = fmt::format(
    "a mesh that would is finer than {} cells across the contact, or does not fit in memory", kMaxCellsAcross);

const char* const kPathNotKnown =
    "the length of the steps changes this number by an unknown amount: compare with a larger solver.substeps";

struct Attempt {
  SolvedScene answer;
  ReachedError reached;
  double uncertainty = NAN;             ///< of a mean over shifted grids
  std::vector<ShiftedGrid> grids = {};  ///< of a mean over shifted grids
  double path = 0.0;                    ///< error by the length of the steps; NaN: not known

  /// False for NaN.
  bool within(double error) const {
    const double mesh = error - path;
    return reached.error <= mesh && (std::isnan(uncertainty) || uncertainty <= mesh);
  }
  /// The error that the next mesh has to lower.
  double to_lower() const { return std::fmax(reached.error, uncertainty); }
};

Attempt attempt(const Scene& scene, const Approach& approach, AccuracyOf of, const GridSolve& solve) {
  if (!approach.shifted) {
    Attempt made{.answer = solve(scene, solver::Detail::all), .reached = {}};
    made.reached = reached_error(scene, made.answer.solution, made.answer.record.end.errors, of);
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
  double path = reached.how == "exact" ? 0.0 : path_of(mean.answer.solution);
  if (mean.path) path = mean.path->uncertainty;
  return {std::move(mean.answer), reached, mean.uncertainty, std::move(mean.grids), path};
}

/// Replaces the stated uncertainty of the twist or moment by the error of mesh and steps. Relative errors.
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

/// Names surfaces outside the measured data, by which the first mesh is chosen; empty: none.
std::string note_on(const Scene& scene) {
  for (const solver::Surface& surface : scene.surfaces) {
    if (surface.shape == solver::Shape::roughness) {
      return "the mesh was chosen by data of smooth contacts: this surface is rough";
    }
  }
  return scene.surfaces.size() > 1 ? "the mesh was chosen by data of one round contact: here are several shapes" : "";
}

}  // namespace

void to_json(Json& json, const ShiftedGrid& grid) { json = {{"extent", grid.extent}, {"value", grid.value}}; }

void to_json(Json& json, const AttemptAccount& attempt) {
  json = {{"cells", attempt.cells}, {"tolerance", attempt.tolerance}};
  set_number(json, "error", attempt.error, attempt.why);
  json.emplace("seconds", attempt.seconds);
  if (!attempt.grids.empty()) json.emplace("grids", attempt.grids);
}

SolvePlan accuracy_plan(const Scene& given, AccuracyTarget target) {
  require_reachable(given, target);
  if (given.solver.model == solver::ModelChoice::exact) return plan_solve(given);
  const Scene scene = with_parts(given, target);
  const Approach approach = approach_to(scene, target);
  SolvePlan plan = plan_solve(chosen_scene(scene, approach, first_choice(scene, approach, target)));
  plan.note = note_on(scene);
  if (!approach.shifted) return plan;
  plan.grids = kShiftedGrids;
  plan.seconds *= kShiftedGrids;
  return plan;
}

AccurateAnswer solve_to_accuracy(const Scene& given, AccuracyTarget target, const GridSolve& solve) {
  Scene scene = with_parts(given, target);
  const Approach approach = approach_to(scene, target);
  const double order = approach.shifted ? kShiftedOrder : falling_order(accuracy_data(), target.of);
  std::optional<AccuracyChoice> choice = first_choice(scene, approach, target);
  Attempt made{};
  GridAccuracy account;
  account.not_reached = fmt::format("the error is too large after {} refinements", kMaxRefinements);
  for (int refinement = 0; refinement <= kMaxRefinements; ++refinement) {
    const Scene chosen = chosen_scene(scene, approach, *choice);
    const auto start = std::chrono::steady_clock::now();
    made = attempt(chosen, approach, target.of, solve);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    account.attempts.push_back({made.answer.record.problem.cells, chosen.solver.tolerance, made.reached.error,
                                made.reached.why, seconds, made.grids});
    if (made.within(target.error)) {
      account.not_reached.reset();
      break;
    }
    if (std::isnan(made.path) && made.reached.error <= target.error) {
      account.not_reached = kPathNotKnown;
      break;
    }
    target.path = std::isnan(made.path) ? 0.0 : made.path;
    if (made.path > kPathPart * target.error) {
      if (!(made.path < target.error) && (scene.solver.substeps >= kMaxSubsteps || std::isinf(made.path))) {
        account.not_reached = fmt::format("steps in {} parts have an error of {:.2g}; divide the loads into more steps",
                                          scene.solver.substeps, made.path);
        break;
      }
      make_more_parts(scene, target);
      if (made.to_lower() <= target.of_mesh()) continue;
    }
    choice = refined(scene, approach.contact, target, *choice, made.to_lower(), order);
    if (!choice) {
      account.not_reached = std::isfinite(made.reached.error) ? kNoFinerMesh : made.reached.why;
      break;
    }
  }
  account.path = made.path;
  account.substeps = scene.solver.substeps;
  if (approach.shifted) account.uncertainty = made.uncertainty;
  account.replaced_cells = scene.grid.cells;
  account.replaced_tolerance = scene.solver.tolerance;
  account.note = note_on(scene);
  if (target.of == AccuracyOf::twist) put_uncertainty(made.answer.record.end, made.to_lower(), made.path);
  return {std::move(made.answer),
          {target.error, accuracy_quantity(scene, target.of).name, std::move(made.reached), std::move(account)}};
}

Accuracy exact_accuracy(const Scene& scene, const AccuracyTarget& target) {
  const Oracle oracle = require_oracle(scene);
  if (!(oracle.relative_uncertainty <= target.error)) {
    throw InputError(fmt::format("--accuracy {:g}", target.error),
                     fmt::format("allowed: {:.2g} or more, the exact answer's own uncertainty in double precision",
                                 oracle.relative_uncertainty));
  }
  return {target.error,
          accuracy_quantity(scene, target.of).name,
          {oracle.relative_uncertainty, "exact", "the exact solution needs no grid; this is its own uncertainty"},
          {}};
}

Json to_json(const Accuracy& accuracy) {
  const std::string& why = accuracy.reached.why;
  Json json{{"wanted", accuracy.target}, {"quantity", accuracy.quantity}};
  set_number(json, "reached", accuracy.error(), std::isnan(accuracy.path()) ? kPathNotKnown : why);
  json.update({{"how", accuracy.reached.how}, {"why", why}, {"attempts", Json::array()}});
  if (!accuracy.grid) return json;
  const GridAccuracy& grid = *accuracy.grid;
  if (grid.not_reached) json.emplace("not_reached", *grid.not_reached);
  set_number(json, "path", grid.path,
             std::isnan(grid.path) ? kPathNotKnown : "more parts of the steps do not carry these loads");
  json.update({{"substeps", grid.substeps},
               {"attempts", grid.attempts},
               {"replaced", {{"cells", grid.replaced_cells}, {"tolerance", grid.replaced_tolerance}}}});
  if (grid.uncertainty) set_number(json, "uncertainty", *grid.uncertainty, why);
  if (!grid.note.empty()) json.emplace("note", grid.note);
  return json;
}

std::string accuracy_text(const Accuracy& accuracy) {
  std::string text = text_line(
      "accuracy", fmt::format("{} of the {}; target {} ({}: {})", short_text(accuracy.error()), accuracy.quantity,
                              number_text(accuracy.target), accuracy.reached.how, accuracy.reached.why));
  if (!accuracy.grid) return text;
  const GridAccuracy& grid = *accuracy.grid;
  if (grid.uncertainty) {
    text += text_line("uncertainty", fmt::format("{} of it (95 %), the mean of {} grids", short_text(*grid.uncertainty),
                                                 kShiftedGrids));
  }
  if (grid.substeps > 1) {
    text += text_line("steps",
                      fmt::format("each in {} parts, which have an error of {}", grid.substeps, short_text(grid.path)));
  }
  if (grid.not_reached) text += text_line("not reached", *grid.not_reached);
  for (const AttemptAccount& attempt : grid.attempts) {
    text += text_line(
        "attempt", fmt::format("{} x {} cells, tolerance {}: error {}, {} s", attempt.cells[0], attempt.cells[1],
                               short_text(attempt.tolerance), short_text(attempt.error), short_text(attempt.seconds)));
  }
  text += text_line("replaced",
                    fmt::format("grid.cells = [{}, {}] and solver.tolerance = {} of the scene", grid.replaced_cells[0],
                                grid.replaced_cells[1], short_text(grid.replaced_tolerance)));
  if (!grid.note.empty()) text += text_line("note", grid.note);
  return text;
}

}  // namespace slipstick::convergence
