#include "convergence/solve/plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "convergence/results/exact_result.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/model/make_model.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/model/model.hpp"

namespace slipstick::convergence {
namespace {

using solver::Scene;

constexpr const char* kNoGrid = "the exact solution needs no grid";

/// Seconds on this machine: measured work times the seconds of an application here. NaN for methods and
/// operators that were not measured.
double predicted_seconds(const Scene& scene, const ContactOnGrid& contact) {
  if (scene.solver.method != solver::Method::coulomb || scene.solver.op != solver::OperatorKind::dcfft) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double across = cells_across(contact, std::max(scene.grid.cells[0], scene.grid.cells[1]));
  const auto steps = static_cast<double>(scene.steps.size()) * scene.cycles;
  return steps * work_of(accuracy_data(), across, scene.solver.tolerance) * application_seconds(scene);
}

/// Number of timed rounds, and least seconds of a round. The quickest round counts: it is likely undisturbed
/// by other processes.
constexpr int kRounds = 7;
constexpr double kRoundSeconds = 2e-4;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Mean over the applications of one round.
double round_seconds(solver::LinearOperator& op, const Eigen::ArrayXd& in, Eigen::ArrayXd& out) {
  const auto start = std::chrono::steady_clock::now();
  int applications = 0;
  do {
    op.apply(in, out);
    ++applications;
  } while (seconds_since(start) < kRoundSeconds);
  return seconds_since(start) / applications;
}

/// Keeps the ratio of the sides.
void set_reference_cells(solver::Scene& scene) {
  const solver::Index longer = std::max(scene.grid.cells[0], scene.grid.cells[1]);
  if (longer == 0) return;  // a height map's
  for (solver::Index& cells : scene.grid.cells) {
    cells = std::max<solver::Index>(1, cells * kReferenceCells / longer);
  }
}

}  // namespace

double application_seconds(solver::Scene scene) {
  set_reference_cells(scene);
  const solver::Model model = solver::make_model(scene);
  const bool whole = model.pressure_coupling || model.forces;
  const solver::Reduction part = whole ? solver::Reduction(model.grid) : model.pressure_part;
  const auto op = solver::elasticity(scene, model, part).make(part.grid(), solver::tangential_kernel());
  const auto size = static_cast<solver::Index>(op->inputs()) * part.grid().cells();
  const Eigen::ArrayXd in = Eigen::ArrayXd::LinSpaced(size, -1.0, 1.0);
  Eigen::ArrayXd out(static_cast<solver::Index>(op->outputs()) * part.grid().cells());
  double quickest = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) quickest = std::min(quickest, round_seconds(*op, in, out));
  return quickest;
}

SolvePlan plan_solve(const Scene& scene, int ranks) {
  if (scene.solver.model == solver::ModelChoice::exact) {
    require_oracle(scene);
    return {};
  }
  const solver::Model model =
      solver::make_model(scene, ranks > 1 ? solver::Ranks::planned(ranks) : solver::Ranks());
  const ContactOnGrid contact = contact_on_grid(scene);
  const double radius = 0.5 * cells_across(contact, std::max(model.grid.n1, model.grid.n2));
  const solver::Reduction& part = model.pressure_part;
  const double mirrored = (part.quadrant() ? 4.0 : 1.0) * (part.diagonal() ? 2.0 : 1.0);
  return {
      .cells = {{model.grid.n1, model.grid.n2}},
      .tolerance = scene.solver.tolerance,
      .unknowns = std::round(2.0 * M_PI * radius * radius / mirrored),
      .bytes = solver::predicted_memory(scene, model).total(),
      .least_bytes = solver::predicted_memory(scene, model, {.pressure = 0.0, .tractions = 0.0}).total(),
      .ranks = ranks,
      .sent_bytes = ranks > 1 ? solver::predicted_sent_bytes(part.grid(), solver::tangential_kernel()) : 0.0,
      .seconds = predicted_seconds(scene, contact)};
}

Json to_json(const SolvePlan& plan) {
  Json json;
  if (!plan.cells) {
    set_missing(json, "cells", kNoGrid);
    json.update({{"unknowns", 0}, {"bytes", 0}, {"least_bytes", 0}});
    set_missing(json, "seconds", "the exact solution takes about a millisecond a step");
    return json;
  }
  json = {{"cells", *plan.cells},
          {"tolerance", plan.tolerance},
          {"unknowns", plan.unknowns},
          {"bytes", plan.bytes},
          {"least_bytes", plan.least_bytes}};
  if (plan.ranks > 1) json.update({{"ranks", plan.ranks}, {"sent_bytes", plan.sent_bytes}});
  set_number(json, "seconds", plan.seconds,
             "measured only for method = \"coulomb\" with operator = \"dcfft\"");
  json.emplace(
      "seconds_from",
      fmt::format("work measured on the paper's sphere, in applications on {0} x {0} cells timed on this "
                  "machine",
                  kReferenceCells));
  if (plan.grids > 1) json.emplace("grids", plan.grids);
  if (!plan.note.empty()) json.emplace("note", plan.note);
  return json;
}

std::string plan_text(const SolvePlan& plan) {
  if (!plan.cells) return text_line("plan", kNoGrid);
  const bool shared = plan.ranks > 1;
  const std::string of_rank =
      shared ? fmt::format(" on each of {} ranks, which send {} bytes for each application", plan.ranks,
                           number_text(plan.sent_bytes))
             : "";
  const std::string text =
      text_line("plan", fmt::format("{}{} x {} cells, {} unknowns, {} to {} bytes{}, about {} s{}",
                                    plan.grids > 1 ? fmt::format("{} grids of ", plan.grids) : "",
                                    (*plan.cells)[0], (*plan.cells)[1], number_text(plan.unknowns),
                                    number_text(plan.least_bytes), number_text(plan.bytes), of_rank,
                                    short_text(plan.seconds), shared ? " on one" : ""));
  return plan.note.empty() ? text : text + text_line("note", plan.note);
}

}  // namespace slipstick::convergence
