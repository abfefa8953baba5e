#include "convergence/solve/plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <nlohmann/json.hpp>

#include "convergence/programs/temporary_folder.hpp"
#include "convergence/results/exact_result.hpp"
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

constexpr solver::Index kTimedCells = 128;  // along each side

std::size_t states_of(const StressFiles& files, const Scene& scene) {
  return files.fatigue.any() ? scene.steps.size() : 0;
}

/// CPU seconds for a depth on kTimedCells^2 cells, under Hertz' pressure in torsion: the mean of the
/// first four.
double timed_seconds(StressFiles files, const Scene& scene, const solver::Grid& grid) {
  constexpr double kCells = kTimedCells;
  solver::Solution solution;
  solution.grid = {kTimedCells, kTimedCells, grid.h1 * static_cast<double>(grid.n1) / kCells,
                   grid.h2 * static_cast<double>(grid.n2) / kCells};
  const Eigen::ArrayXd x1 = solver::cell_x1(solution.grid) / (0.4 * kCells * solution.grid.h1);
  const Eigen::ArrayXd x2 = solver::cell_x2(solution.grid) / (0.4 * kCells * solution.grid.h2);
  solution.pressure = (1.0 - x1.square() - x2.square()).max(0.0).sqrt();
  solution.traction.resize(2 * x1.size());
  solution.traction << -0.1 * x2 * solution.pressure, 0.1 * x1 * solution.pressure;
  std::vector<solver::SolutionFields> cycle(states_of(files, scene), solution);
  for (std::size_t i = 0; i < cycle.size(); i += 2) cycle[i].traction *= -1.0;
  const TemporaryFolder folder;
  files.file = folder / std::filesystem::path(files.file).filename().c_str();
  files.depths.resize(std::min<std::size_t>(4, files.depths.size()));
  std::clock_t quickest = std::numeric_limits<std::clock_t>::max();
  for (int round = 0; round < 3; ++round) {
    const std::clock_t start = std::clock();
    write_stresses(files, scene, solution, cycle);
    quickest = std::min(std::clock() - start, quickest);
  }
  return static_cast<double>(quickest) / CLOCKS_PER_SEC / static_cast<double>(files.depths.size());
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
  const solver::Model model = solver::make_model(scene, ranks > 1 ? solver::Ranks::planned(ranks) : solver::Ranks());
  const ContactOnGrid contact = contact_on_grid(scene);
  const double radius = 0.5 * cells_across(contact, std::max(model.grid.n1, model.grid.n2));
  const solver::Reduction& part = model.pressure_part;
  const double mirrored = (part.quadrant() ? 4.0 : 1.0) * (part.diagonal() ? 2.0 : 1.0);
  return {.cells = {{model.grid.n1, model.grid.n2}},
          .tolerance = scene.solver.tolerance,
          .unknowns = std::round(2.0 * M_PI * radius * radius / mirrored),
          .bytes = solver::predicted_memory(scene, model).total(),
          .least_bytes = solver::predicted_memory(scene, model, {.pressure = 0.0, .tractions = 0.0}).total(),
          .ranks = ranks,
          .sent_bytes = ranks > 1 ? solver::predicted_sent_bytes(part.grid(), solver::tangential_kernel()) : 0.0,
          .seconds = predicted_seconds(scene, contact)};
}

StressPlan plan_stresses(const StressFiles& files, const Scene& scene) {
  const solver::Grid grid = solver::make_model(scene).grid_in_m();
  const auto depths = static_cast<double>(files.depths.size());
  const auto work = [](double cells) { return cells * std::log(cells + 1.0); };
  const double growth = work(static_cast<double>(grid.cells())) / work(kTimedCells * kTimedCells);
  return {.planes = depths * static_cast<double>(files.bodies(scene).size() * (1 + states_of(files, scene))),
          .bytes = solver::memory_of_stresses(grid, states_of(files, scene)),
          .seconds = timed_seconds(files, scene, grid) * depths * growth};
}

void require_memory(const StressFiles& files, const Scene& scene) {
  const solver::Grid grid = solver::make_model(scene).grid;
  solver::require_memory(scene, grid, solver::memory_of_stresses(grid, states_of(files, scene)));
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
  set_number(json, "seconds", plan.seconds, "measured only for method = \"coulomb\" with operator = \"dcfft\"");
  json.emplace("seconds_from",
               fmt::format("work measured on the paper's sphere, in applications on {0} x {0} cells timed on this "
                           "machine",
                           kReferenceCells));
  if (plan.grids > 1) json.emplace("grids", plan.grids);
  if (!plan.note.empty()) json.emplace("note", plan.note);
  if (const auto& stresses = plan.stresses)
    json["stresses"] = {{"planes", stresses->planes}, {"bytes", stresses->bytes}, {"seconds", stresses->seconds}};
  return json;
}

std::string plan_text(const SolvePlan& plan) {
  if (!plan.cells) return text_line("plan", kNoGrid);
  const bool shared = plan.ranks > 1;
  const std::string of_rank = shared ? fmt::format(" on each of {} ranks, which send {} bytes for each application",
                                                   plan.ranks, number_text(plan.sent_bytes))
                                     : "";
  std::string text = text_line(
      "plan", fmt::format("{}{} x {} cells, {} unknowns, {} to {} bytes{}, about {} s{}",
                          plan.grids > 1 ? fmt::format("{} grids of ", plan.grids) : "", (*plan.cells)[0],
                          (*plan.cells)[1], number_text(plan.unknowns), number_text(plan.least_bytes),
                          number_text(plan.bytes), of_rank, short_text(plan.seconds), shared ? " on one" : ""));
  if (const auto& stresses = plan.stresses)
    text += text_line("stresses",
                      fmt::format("{} planes, {} bytes, about {} s after the solve", number_text(stresses->planes),
                                  number_text(stresses->bytes), short_text(stresses->seconds)));
  return plan.note.empty() ? text : text + text_line("note", plan.note);
}

}  // namespace slipstick::convergence
