#include <fftw3.h>
#include <fmt/core.h>
#include <pthread.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <shared_mutex>
#include <string_view>
#include <utility>

#include "convergence/results/exact_result.hpp"
#include "convergence/results/make_record.hpp"
#include "convergence/results/record_text.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/results/solution_fields.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "convergence/solve/accurate_solve.hpp"
#include "interfaces/c/boundary.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/toml_reader.hpp"
#include "solver/scene/scene_keys.hpp"

/// By which FFTW's threads library locks the planner; in no header.
extern "C" void fftw_set_planner_hooks(void (*before)(), void (*after)());

struct slipstick_solution {
  slipstick::solver::Grid grid{};
  std::vector<slipstick::solver::Column> columns;
  std::vector<std::vector<slipstick::solver::Column>> steps;  ///< columns of a history's steps; empty: not kept
  Eigen::ArrayXd pressure;
  slipstick::convergence::Json result;
  std::string json;
  std::string text;
};

namespace slipstick::c {
namespace {

using convergence::Json;
using solver::Scene;

using Columns = std::vector<solver::Column>;

/// Most bytes of the fields of all steps that a solution keeps.
constexpr double kMostStepBytes = 512.0 * 1024 * 1024;
constexpr std::size_t kAllColumns = std::numeric_limits<std::size_t>::max();
/// Columns that are kept of a step: x1 to dissipated.
constexpr std::size_t kStepColumns = 9;

/// The arguments of slipstick_solve().
struct Request {
  solver::SettingsText settings;
  std::vector<std::string> overrides;
  double accuracy;
  slipstick_progress progress;
  void* user;
};

/// Solves run concurrently. A solve that reads files by HDF5's library or changes FFTW's wisdom, of which the
/// process has one each, excludes all others. A forked process has no other threads and gets a new lock.
std::shared_mutex* solving = new std::shared_mutex;
struct PlannerLock {
  explicit PlannerLock(bool exclusive) : shared(*solving, std::defer_lock), exclusively(*solving, std::defer_lock) {
    exclusive ? exclusively.lock() : shared.lock();
  }
  std::shared_lock<std::shared_mutex> shared;
  std::unique_lock<std::shared_mutex> exclusively;
};

bool needs_exclusive(const Scene& scene) {
  const bool reads_files = convergence::input_files(scene).size() > 1;
  return reads_files || scene.solver.rounding_seed != 0;
}

/// FFTW would reuse plans that it made under another rounding, which give other digits: they end with this.
struct PlansOfOneRounding {
  bool drawn;
  ~PlansOfOneRounding() {
    if (drawn) fftw_forget_wisdom();
  }
};

/// The caller's threads may make plans, too, and a process may fork meanwhile. The lock is our own: FFTW's,
/// fftw_make_planner_thread_safe(), would stay locked in a process forked while another thread held it.
std::mutex planning;
void begin_planning() { planning.lock(); }
void end_planning() { planning.unlock(); }
void renew_lock() {
  end_planning();
  solving = new std::shared_mutex;
}
void share_planner() {
  static std::once_flag done;
  std::call_once(done, [] {
    fftw_set_planner_hooks(begin_planning, end_planning);
    pthread_atfork(begin_planning, end_planning, renew_lock);
  });
}

Request request_of(const char* scene, const char* file, size_t n_overrides, const char* const* overrides) {
  if (scene == nullptr) require(file, "file (where scene = NULL)");
  if (n_overrides > 0) require(overrides, "overrides");
  Request request{};
  request.settings =
      scene != nullptr ? solver::SettingsText{scene, file != nullptr ? file : "scene"} : solver::settings_of(file);
  for (size_t i = 0; i < n_overrides; ++i) {
    require(overrides[i], "an override");
    request.overrides.emplace_back(overrides[i]);
  }
  return request;
}

/// The columns of a solution, at most so many.
Columns columns_of(const solver::Solution& solution, const convergence::OracleAnswer& exact, std::size_t most) {
  Columns columns;
  const solver::Index cells = solution.grid.cells();
  std::vector<solver::FieldColumn> known = convergence::solution_columns(solution, exact);
  known.resize(std::min(known.size(), most));
  for (const solver::FieldColumn& column : known) {
    columns.push_back({column.name, Eigen::ArrayXd(cells)});
    column.values(0, cells, columns.back().values.data());
  }
  return columns;
}

/// steps: gets the fields of each step of a history, unless all together may be larger than kMostStepBytes;
/// null: they are not kept.
convergence::SolvedScene find_on_grid(const Scene& scene, const Request& request,
                                      const std::shared_ptr<solver::SolveCache>& cache = {},
                                      solver::Detail detail = solver::Detail::all,
                                      std::vector<Columns>* steps = nullptr) {
  const bool wanted = steps != nullptr && convergence::has_history(scene);
  const double count = static_cast<double>(scene.steps.size()) * scene.cycles;
  const auto on_step = [&](const solver::Solution& at, const convergence::OracleAnswer&) {
    const double bytes = kStepColumns * sizeof(double) * static_cast<double>(at.grid.cells()) * count;
    if (wanted && bytes <= kMostStepBytes) steps->push_back(columns_of(at, {}, kStepColumns));
  };
  const auto progress = [&](int iteration, double change) {
    if (request.progress != nullptr && request.progress(iteration, change, request.user) != 0) throw Stopped{};
  };
  return convergence::solve_scene(scene, {.progress = progress, .on_step = on_step, .cache = cache, .detail = detail});
}

void keep(slipstick_solution& kept, const convergence::SolvedScene& solved, const Scene& scene) {
  kept.grid = solved.solution.grid;
  kept.columns = columns_of(solved.solution, solved.exact, kAllColumns);
  kept.pressure = solved.solution.pressure;
  kept.result = to_json(solved.record);
  kept.text = solve_text(solved.record, solver::Units(scene.units));
}

void answer_exactly(slipstick_solution& kept, const Scene& scene) {
  const auto start = std::chrono::steady_clock::now();
  const convergence::Oracle oracle = convergence::require_oracle(scene);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const convergence::SolveRecord record = convergence::exact_record(scene, oracle, taken.count());
  kept.result = to_json(record);
  kept.text = solve_text(record, solver::Units(scene.units));
  if (!oracle.shear) return;
  convergence::GridColumns fields = convergence::exact_columns(scene, oracle);
  kept.grid = fields.grid;
  kept.columns = std::move(fields.columns);
  kept.pressure = std::move(fields.pressure);
}

/// Returns why the answer is not to be trusted; empty if it is.
std::string solve_as_it_stands(slipstick_solution& kept, const Scene& scene, const Request& request) {
  if (scene.solver.model == solver::ModelChoice::exact) {
    answer_exactly(kept, scene);
    return {};
  }
  const convergence::SolvedScene solved = find_on_grid(scene, request, {}, solver::Detail::all, &kept.steps);
  keep(kept, solved, scene);
  return solved.solution.status == solver::Status::converged ? std::string() : solved.solution.message;
}

/// Answers exactly where possible, unless the scene says otherwise. Returns as solve_as_it_stands().
std::string solve_accurately(slipstick_solution& kept, Scene scene, const Request& request) {
  const convergence::AccuracyTarget target{.error = request.accuracy};
  const bool said = solver::SceneReader(request.settings, request.overrides, solver::scene_keys()).has("solver.model");
  if (!said && convergence::answers_exactly(scene, target.of)) scene.solver.model = solver::ModelChoice::exact;
  convergence::require_reachable(scene, target);
  if (scene.solver.model == solver::ModelChoice::exact) {
    const convergence::Accuracy account = convergence::exact_accuracy(scene, target);
    answer_exactly(kept, scene);
    kept.result["accuracy"] = to_json(account);
    kept.text += accuracy_text(account);
    return {};
  }
  const auto cache = std::make_shared<solver::SolveCache>();
  const convergence::AccurateAnswer answer = convergence::solve_to_accuracy(
      scene, target,
      [&](const Scene& chosen, solver::Detail detail) { return find_on_grid(chosen, request, cache, detail); });
  keep(kept, answer.answer, scene);
  kept.result["accuracy"] = to_json(answer.accuracy);
  const std::string account = accuracy_text(answer.accuracy);
  kept.text += account;
  return answer.reached() ? std::string() : account;
}

int solve(const Request& request, slipstick_solution& kept) {
  share_planner();
  const Scene scene = solver::read_scene_text(request.settings.text, request.settings.file, request.overrides);
  const PlannerLock lock(needs_exclusive(scene));
  const bool accurate = request.accuracy != 0;
  const PlansOfOneRounding plans{scene.solver.rounding_seed != 0};
  const std::string why = accurate ? solve_accurately(kept, scene, request) : solve_as_it_stands(kept, scene, request);
  // Names of files need not be UTF-8; JSON is.
  kept.json = kept.result.dump(2, ' ', false, Json::error_handler_t::replace);
  if (why.empty() && kept.result.at("status") == "converged") return SLIPSTICK_OK;
  set_message(why.c_str());
  return SLIPSTICK_NOT_CONVERGED;
}

/// The columns of the step that a field's name begins with, as "steps[3].", which is taken from the name; the
/// last step's for other names.
const Columns& columns_named(const slipstick_solution& solution, std::string_view& name) {
  constexpr std::string_view kSteps = "steps[";
  constexpr std::string_view kOfStep = "].";
  if (!name.starts_with(kSteps)) return solution.columns;
  std::size_t step = 0;
  const char* const last = name.data() + name.size();
  const char* const end = std::from_chars(name.data() + kSteps.size(), last, step).ptr;
  const std::string_view rest(end, last);
  if (rest.starts_with(kOfStep) && step < solution.steps.size()) {
    name = rest.substr(kOfStep.size());
    return solution.steps[step];
  }
  throw std::invalid_argument(fmt::format("field \"{}\"; allowed: {}", name,
                                          !solution.steps.empty()
                                              ? fmt::format("steps[0] to steps[{}]", solution.steps.size() - 1)
                                              : "fields of the last step, since those of all steps are kept only "
                                                "for histories on a grid, without "
                                                "an accuracy, where they take at most 512 MiB; slipstick solve "
                                                "--fields NAME{step}.csv writes them"));
}

/// The number; if there is none, NaN and `why`.
double number_at(const Json& result, const char* path, std::string& why) {
  const convergence::FoundQuantity found = convergence::find_quantity(result, path);
  if (found.value != nullptr && found.value->is_number()) return found.value->get<double>();
  why = !found.reason.empty() ? fmt::format("{}: {}", path, found.reason)
                              : fmt::format("{}; allowed: a number of the result", path);
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace
}  // namespace slipstick::c

using namespace slipstick;

int slipstick_solve(const char* scene, const char* file, size_t n_overrides, const char* const* overrides,
                    double accuracy, slipstick_progress progress, void* user, slipstick_solution** solution) {
  return c::guarded([&] {
    c::require(solution, "solution");
    *solution = nullptr;
    c::Request request = c::request_of(scene, file, n_overrides, overrides);
    request.accuracy = accuracy;
    request.progress = progress;
    request.user = user;
    auto kept = std::make_unique<slipstick_solution>();
    const int status = c::solve(request, *kept);
    *solution = kept.release();
    return status;
  });
}

void slipstick_solution_free(slipstick_solution* solution) { delete solution; }

int slipstick_solution_number(const slipstick_solution* solution, const char* path, double* value) {
  return c::guarded([&] {
    c::require(solution, "solution");
    c::require(path, "path");
    c::require(value, "value");
    std::string why;
    *value = c::number_at(solution->result, path, why);
    if (why.empty()) return SLIPSTICK_OK;
    c::set_message(why.c_str());
    return SLIPSTICK_BAD_INPUT;
  });
}

const char* slipstick_solution_json(const slipstick_solution* solution) {
  return solution != nullptr ? solution->json.c_str() : "";
}

const char* slipstick_solution_text(const slipstick_solution* solution) {
  return solution != nullptr ? solution->text.c_str() : "";
}

int slipstick_solution_grid(const slipstick_solution* solution, size_t cells[2], double cell_size[2]) {
  return c::guarded([&] {
    c::require(solution, "solution");
    c::require(cells, "cells");
    c::require(cell_size, "cell_size");
    cells[0] = static_cast<size_t>(solution->grid.n1);
    cells[1] = static_cast<size_t>(solution->grid.n2);
    cell_size[0] = solution->grid.h1;
    cell_size[1] = solution->grid.h2;
  });
}

int slipstick_solution_field(const slipstick_solution* solution, const char* name, const double** values,
                             size_t* count) {
  return c::guarded([&] {
    c::require(solution, "solution");
    c::require(name, "name");
    c::require(values, "values");
    c::require(count, "count");
    std::string names;
    std::string_view wanted = name;
    for (const solver::Column& column : c::columns_named(*solution, wanted)) {
      if (column.name == wanted) {
        *values = column.values.data();
        *count = static_cast<size_t>(column.values.size());
        return;
      }
      names += (names.empty() ? "" : ", ") + column.name;
    }
    throw std::invalid_argument(
        fmt::format("field \"{}\"; allowed: {}", name, names.empty() ? "none, there are no fields" : names));
  });
}

const char* slipstick_solution_field_name(const slipstick_solution* solution, size_t index) {
  if (solution == nullptr || index >= solution->columns.size()) return nullptr;
  return solution->columns[index].name.c_str();
}

int slipstick_solution_write(const slipstick_solution* solution, const char* file) {
  return c::guarded([&] {
    c::require(solution, "solution");
    c::require(file, "file");
    solver::require_field_format(file);
    if (solution->columns.empty()) throw std::invalid_argument("the solution has no fields; allowed: one with fields");
    const c::PlannerLock lock(true);
    solver::write_fields(file, solution->grid, solution->columns, solution->pressure);
  });
}
