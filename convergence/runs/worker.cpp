#include "convergence/runs/worker.hpp"

#include <fmt/core.h>

#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/oracle/exact_stresses.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/results/make_record.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/solution_fields.hpp"
#include "convergence/runs/run_list.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "convergence/system/machine.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/memory.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// A worker writes it when a run is finished; no message contains it.
constexpr char kFinished = '\0';

std::vector<std::string> worker_words(const fs::path& program, const fs::path& folder,
                                      std::optional<double> memory_limit) {
  std::vector<std::string> words{program, "solve", "--keep", folder};
  if (memory_limit) words.insert(words.end(), {"--memory-limit", fmt::format("{:.0f}", *memory_limit)});
  words.emplace_back("-");
  return words;
}

/// A run as CBOR, whose texts may be any bytes.
std::string text_of(const RunSpec& run) {
  std::string bytes;
  Json::to_cbor(to_json(run), bytes);
  return bytes;
}

/// Missing at the end of the input, and for an input that is no run.
std::optional<RunSpec> next_run(std::istream& input) {
  const Json run = Json::from_cbor(input, false, false);
  return run.is_object() ? std::optional(run_of(run, "standard input")) : std::nullopt;
}

/// Solves the scene and writes its fields; a scene that cannot be solved is refused or failed.
SolveRecord solve(const PreparedRun& run, const std::shared_ptr<solver::SolveCache>& cache) {
  const RunSpec& spec = run.spec;
  SolvedScene solved;
  std::optional<solver::Solution> latest;
  std::optional<solver::Solution> before;
  const auto on_step = [&](const solver::Solution& at, const OracleAnswer&) {
    if (!spec.step_before) return;
    before = std::exchange(latest, at);
  };
  try {
    const bool exact = run.scene.solver.model == solver::ModelChoice::exact;
    if (exact && spec.fields.empty() && !spec.profile) return exact_record(run.scene, require_oracle(run.scene), 0.0);
    solved =
        solve_scene(run.scene, {.on_step = on_step,
                                .rounding = spec.rounding,
                                .cache = cache,
                                .programs = {.all = true, .tied_by = own_program(), .version = spec.program_version}});
  } catch (const solver::OutOfMemory&) {
    throw;
  } catch (const solver::InputError& error) {
    return not_computed(RunStatus::refused, error.what(), spec);
  } catch (const ProgramFailure& error) {
    return not_computed(RunStatus::failed, error.what(), spec);
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("memory ran out");
  }
  if (!spec.fields.empty()) write_solution_fields(spec.fields, solved.solution, solved.exact);
  if (!spec.fields.empty() && before) write_solution_fields(step_before_file(spec.fields), *before, {});
  if (spec.profile) solved.record.profile = make_profile(solved.solution, solved.exact);
  if (std::string reason; spec.stress_error) {
    const FieldError error = stress_error(run.scene, solved.solution, reason);
    solved.record.stress_error = make_field_error(error, reason);
  }
  return std::move(solved.record);
}

}  // namespace

Worker::Worker(const fs::path& program, const fs::path& folder, std::optional<double> memory_limit)
    : program_(worker_words(program, folder, memory_limit),
               {.captured = Captured::everything, .fed = true, .tied_by = program}) {}

void Worker::start(const RunSpec& run) { program_.feed(text_of(run)); }

Worker::Event Worker::next() {
  if (program_.read_on()) return Event::ended;
  if (!program_.captured().ends_with(kFinished)) return Event::output;
  program_.clear_captured();
  return Event::finished;
}

ProgramEnd Worker::wait() {
  program_.end_feed();
  return program_.wait();
}

void keep_result_of(PreparedRun run, std::optional<double> memory_limit,
                    const std::shared_ptr<solver::SolveCache>& shared, const ResultCache& cache) {
  run.scene.solver.memory_limit = memory_limit;
  if (run.scene.solver.threads == 0) run.scene.solver.threads = 1;  // the other processors solve other runs
  cache.keep(run.name, run.cache_key, to_json(solve(run, shared)), run.spec.fields);
}

int serve_runs(const fs::path& folder, std::optional<double> memory_limit) {
  const auto shared = std::make_shared<solver::SolveCache>();
  std::optional<ResultCache> cache;
  while (const std::optional<RunSpec> spec = next_run(std::cin)) {
    try {
      if (!cache) cache.emplace(folder);
      keep_result_of(prepare_run(*spec), memory_limit, shared, *cache);
    } catch (const solver::OutOfMemory&) {
      throw;
    } catch (const solver::InputError& error) {  // a file; a complaint about the scene is its result
      std::cerr << plain_text(fmt::format("slipstick: {}\n", error.what()));
      return kNotKept;
    }
    std::cout << kFinished << std::flush;
  }
  return 0;
}

}  // namespace slipstick::convergence
