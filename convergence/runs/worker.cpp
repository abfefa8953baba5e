#include "convergence/runs/worker.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <iostream>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/result.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "solver/input/input_error.hpp"
#include "solver/memory.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// What a worker says when a run is finished: no message has it.
constexpr char kFinished = '\0';

std::vector<std::string> worker_words(const fs::path& program, const fs::path& folder,
                                      std::optional<double> memory_limit) {
  std::vector<std::string> words{program, "solve", "--keep", folder};
  if (memory_limit) words.insert(words.end(), {"--memory-limit", fmt::format("{:.0f}", *memory_limit)});
  words.emplace_back("-");
  return words;
}

/// Any bytes, after how many they are.
std::string counted(const std::string& word) { return fmt::format("{}:{}", word.size(), word); }

/// Empty: the input has ended.
std::optional<std::string> next_word(std::istream& input) {
  std::size_t size = 0;
  std::string word;
  if (!(input >> size) || input.get() != ':') return std::nullopt;
  word.resize(size);
  if (!input.read(word.data(), static_cast<std::streamsize>(size))) return std::nullopt;
  return word;
}

/// As next_run() reads it.
std::string text_of(const RunSpec& run) {
  std::string text = counted(run.scene) + counted(std::to_string(static_cast<int>(run.rounding))) +
                     counted(to_string(run.variant)) + counted(run.fields) +
                     counted(run.step_before ? "yes" : "") + counted(run.profile ? "yes" : "") +
                     counted(run.program_version) + counted(std::to_string(run.overrides.size()));
  for (const std::string& assignment : run.overrides) text += counted(assignment);
  return text;
}

std::optional<RunSpec> next_run(std::istream& input) {
  std::optional<std::string> word;
  const auto next = [&] { return (word = next_word(input)).value_or(""); };
  const auto number = [&] { return std::atoi(next().c_str()); };
  RunSpec run{.scene = next()};
  if (!word) return std::nullopt;
  run.rounding = static_cast<Rounding>(number());
  run.variant = variant_of(next());
  run.fields = next();
  run.step_before = !next().empty();
  run.profile = !next().empty();
  run.program_version = next();
  for (int left = number(); left > 0; --left) run.overrides.push_back(next());
  return word ? std::optional(run) : std::nullopt;
}

/// Solves the scene and writes its fields; or why it cannot be solved.
Json solve(const PreparedRun& run, const std::shared_ptr<solver::SolveCache>& cache) {
  const RunSpec& spec = run.spec;
  SolvedScene solved;
  std::optional<solver::Solution> latest;
  std::optional<solver::Solution> before;
  const auto on_step = [&](const solver::Solution& at, const OracleAnswer&) {
    if (!spec.step_before) return;
    before = std::exchange(latest, at);
  };
  try {
    const bool exact = run.scene.model == solver::ModelChoice::exact;
    if (exact && spec.fields.empty() && !spec.profile)
      return exact_result(run.scene, require_oracle(run.scene), 0.0);
    solved = solve_scene(
        run.scene, {.on_step = on_step,
                    .rounding = spec.rounding,
                    .cache = cache,
                    .programs = {.all = true, .tied_by = kOwnProgram, .version = spec.program_version}});
  } catch (const solver::OutOfMemory&) {
    throw;
  } catch (const solver::InputError& error) {
    return not_computed("refused", error.what(), spec);
  } catch (const ProgramFailure& error) {
    return not_computed("failed", error.what(), spec);
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("memory ran out");
  }
  if (!spec.fields.empty()) write_solution_fields(spec.fields, solved.solution, solved.exact);
  if (!spec.fields.empty() && before) write_solution_fields(step_before_file(spec.fields), *before, {});
  if (spec.profile) solved.result["profile"] = profile_json(solved.solution, solved.exact);
  return std::move(solved.result);
}

}  // namespace

Worker::Worker(const fs::path& program, const fs::path& folder, std::optional<double> memory_limit)
    : program_(worker_words(program, folder, memory_limit),
               {.captured = Captured::everything, .fed = true, .tied_by = program}) {}

void Worker::start(const RunSpec& run) { program_.feed(text_of(run)); }

Worker::Said Worker::next() {
  if (program_.read_on()) return Said::ended;
  if (!program_.captured().ends_with(kFinished)) return Said::more;
  program_.forget_captured();
  return Said::finished;
}

ProgramEnd Worker::wait() {
  let_end();
  return program_.wait();
}

int serve_runs(const fs::path& folder, std::optional<double> memory_limit) {
  const auto shared = std::make_shared<solver::SolveCache>();
  std::optional<ResultCache> cache;
  while (const std::optional<RunSpec> spec = next_run(std::cin)) {
    PreparedRun run = prepare_run(*spec);
    run.scene.memory_limit = memory_limit;
    if (run.scene.threads == 0) run.scene.threads = 1;  // its processor is one of those that solve
    try {
      if (!cache) cache.emplace(folder);
      cache->keep(run.name, run.cache_key, solve(run, shared), spec->fields);
    } catch (const solver::OutOfMemory&) {
      throw;
    } catch (const solver::InputError& error) {  // of the scene it is part of the result
      std::cerr << plain_text(fmt::format("slipstick: {}\n", error.what()));
      return kNotKept;
    }
    std::cout << kFinished << std::flush;
  }
  return 0;
}

}  // namespace slipstick::convergence
