#include "convergence/runs/process_pool.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <list>
#include <map>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "convergence/results/result.hpp"
#include "convergence/runs/progress.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"
#include "solver/memory.hpp"
#include "solver/model.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// Part of the memory now available that runs may take side by side: other programs live here too.
constexpr double kMemoryPart = 0.7;
/// An interrupt that comes just before the waiting begins is seen after it.
constexpr int kLongestWait = 1000;  // ms
/// The exit code of a process whose result, or the fields beside it, could not be written.
constexpr int kNotKept = 3;

/// A run that is not on disk yet.
struct Task {
  const PreparedRun* run;
  std::string label;  ///< for a person
  double bytes = 0.0;
  std::string refusal = {};  ///< why it is not even started; empty: it is
};

/// A task's process.
struct Worker {
  Worker(const Task& of, const std::vector<std::string>& words, const fs::path& tied_by)
      : program(words, {.captured = Captured::everything, .tied_by = tied_by}), task(&of) {}

  Program program;
  const Task* task;
};

Task make_task(const PreparedRun& run, std::optional<double> memory_limit) {
  Task task{&run, run.spec.scene.stem().string()};
  solver::Scene scene = run.scene;
  scene.memory_limit = memory_limit;
  try {
    const solver::Model model = solver::make_model(scene);
    task.label += fmt::format(" {} x {}", model.grid.n1, model.grid.n2);
    task.bytes = predicted_memory(scene, model).total();
  } catch (const solver::OutOfMemory& error) {  // kept nowhere: with more memory it has an answer
    task.refusal = error.what();
  } catch (const solver::InputError&) {  // the run itself will say so
  }
  return task;
}

std::optional<Json> find(const ResultCache& cache, const PreparedRun& run) {
  return cache.find(run.name, run.cache_key, run.spec.fields);
}

Json not_computed(const char* status, const std::string& message, const RunSpec& spec) {
  return {{"status", status}, {"message", message}, {"run", run_text(spec)}};
}

/// What a process that failed says, or how it ended; empty where nothing speaks against its result.
std::string failure_of(const ProgramEnd& end) {
  constexpr std::string_view kName = "slipstick: ";
  std::string said = end.output.substr(0, end.output.find_last_not_of('\n') + 1);
  if (said.starts_with(kName)) said.erase(0, kName.size());
  if (end.code > 0 && !said.empty()) return said;
  return end.code == 0 ? "" : "its process " + end.trouble;
}

/// The processes of some tasks, largest first.
class Batch {
 public:
  Batch(std::vector<Task> tasks, const ResultCache& cache, const ProcessPoolOptions& options)
      : options_(options),
        cache_(cache),
        tasks_(std::move(tasks)),
        jobs_(options.jobs > 0 ? static_cast<std::size_t>(options.jobs)
                               : std::max(1U, std::thread::hardware_concurrency())) {
    std::ranges::stable_sort(tasks_, std::greater<>(), &Task::bytes);
  }

  /// The results, by their names. Each is read when its process ends: another program may share the folder.
  std::map<std::string, Json> work() {
    Progress progress(tasks_.size(),
                      std::accumulate(tasks_.begin(), tasks_.end(), 0.0,
                                      [](double sum, const Task& task) { return sum + task.bytes; }));
    std::map<std::string, Json> results;
    while (next_ < tasks_.size() || !running_.empty()) {
      while (may_start()) start_next();
      for (Worker& worker : take_ended()) {
        const Task& task = *worker.task;
        const ProgramEnd end = worker.program.wait();
        if (end.code == kNotKept) stop(progress, failure_of(end));
        progress.finished(task.label, task.bytes);
        results[task.run->name] = result_of(*task.run, failure_of(end));
      }
      if (options_.interrupted && options_.interrupted()) stop(progress, "interrupted");
    }
    return results;
  }

 private:
  [[noreturn]] void stop(const Progress& progress, const std::string& why) const {
    throw std::runtime_error(
        fmt::format("{}: {} points are done and kept in {}; the same command goes on from there", why,
                    progress.text(), options_.folder.string()));
  }

  Json result_of(const PreparedRun& run, std::string failure) const {
    if (std::optional<Json> found = find(cache_, run)) return *std::move(found);
    if (failure.empty()) failure = "its result is not on disk";
    std::cerr << fmt::format("slipstick: {}: {}\n", run_text(run.spec), failure);
    return not_computed("failed", failure, run.spec);
  }

  bool may_start() const {
    if (next_ == tasks_.size()) return false;
    return running_.empty() || (running_.size() < jobs_ && bytes_ + tasks_[next_].bytes < shared_);
  }

  void start_next() {
    const Task& task = tasks_[next_++];
    const RunSpec& spec = task.run->spec;
    std::vector<std::string> words{options_.program, "solve", "--keep", options_.folder};
    if (spec.rounding != Rounding::nearest) {
      words.insert(words.end(), {"--rounding", spec.rounding == Rounding::upward ? "upward" : "downward"});
    }
    if (spec.variant != Variant::none) words.insert(words.end(), {"--variant", to_string(spec.variant)});
    if (!spec.fields.empty()) words.insert(words.end(), {"--fields", spec.fields});
    if (spec.profile) words.emplace_back("--profile");
    if (spec.step_before) words.emplace_back("--step-before");
    // What is left now is less by what the others take.
    if (std::isfinite(memory_)) words.insert(words.end(), {"--memory-limit", fmt::format("{:.0f}", memory_)});
    for (const std::string& assignment : spec.overrides) words.insert(words.end(), {"--set", assignment});
    words.insert(words.end(), {"--", spec.scene});
    running_.emplace_back(task, words, options_.program);
    bytes_ += task.bytes;
  }

  /// Waits for workers to end, or for an interrupt.
  std::list<Worker> take_ended() {
    std::vector<pollfd> outputs;
    for (const Worker& worker : running_) outputs.push_back({worker.program.output(), POLLIN, 0});
    std::list<Worker> ended;
    if (poll(outputs.data(), outputs.size(), kLongestWait) <= 0) return ended;
    auto worker = running_.begin();
    for (const pollfd& output : outputs) {
      const auto here = worker++;
      if (output.revents == 0 || !here->program.read_on()) continue;
      bytes_ -= here->task->bytes;
      ended.splice(ended.end(), running_, here);
    }
    return ended;
  }

  const ProcessPoolOptions& options_;
  const ResultCache& cache_;
  std::vector<Task> tasks_;
  std::size_t jobs_;
  std::size_t next_ = 0;
  std::list<Worker> running_;
  double bytes_ = 0.0;
  /// One process may take all of the first, several together the second.
  double memory_ = solver::memory_within(options_.memory_limit);
  double shared_ = options_.memory_limit ? memory_ : kMemoryPart * memory_;
};

/// Solves the scene and writes its fields; or why it cannot be solved.
Json solve(const PreparedRun& run) {
  const RunSpec& spec = run.spec;
  SolvedScene solved;
  std::optional<solver::Solution> latest;
  std::optional<solver::Solution> before;
  const auto on_step = [&](const solver::Solution& at, const OracleAnswer&) {
    if (!spec.step_before) return;
    before = std::exchange(latest, at);
  };
  try {
    solved = solve_scene(run.scene, {.on_step = on_step, .rounding = spec.rounding});
  } catch (const solver::OutOfMemory&) {
    throw;
  } catch (const solver::InputError& error) {
    return not_computed("refused", error.what(), spec);
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("memory ran out");
  }
  if (!spec.fields.empty()) write_solution_fields(spec.fields, solved.solution, solved.exact);
  if (!spec.fields.empty() && before) write_solution_fields(step_before_file(spec.fields), *before, {});
  if (spec.profile) solved.result["profile"] = profile_json(solved.solution, solved.exact);
  return std::move(solved.result);
}

}  // namespace

ProcessPool::ProcessPool(ProcessPoolOptions options) : options_(std::move(options)) {}

std::vector<Json> ProcessPool::run_prepared(const std::vector<PreparedRun>& runs) const {
  const ResultCache cache(options_.folder, options_.program);
  std::vector<Task> tasks;
  std::map<std::string, Json> known;
  for (const PreparedRun& run : runs) {
    const auto [place, is_new] = known.try_emplace(run.name);
    if (!is_new) continue;
    std::optional<Json> found = find(cache, run);
    if (found) {
      place->second = *std::move(found);
      continue;
    }
    Task task = make_task(run, options_.memory_limit);
    if (task.refusal.empty()) {
      tasks.push_back(std::move(task));
    } else {
      place->second = not_computed("refused", task.refusal, run.spec);
      place->second["out_of_memory"] = true;
    }
  }
  if (!tasks.empty()) solver::require_writable(options_.folder);
  for (auto& [name, result] : Batch(std::move(tasks), cache, options_).work())
    known[name] = std::move(result);
  std::vector<Json> results;
  for (const PreparedRun& run : runs) results.push_back(known[run.name]);
  return results;
}

std::vector<Json> ProcessPool::run(const std::vector<RunSpec>& specs) const {
  std::vector<PreparedRun> runs;
  for (const RunSpec& spec : specs) runs.push_back(prepare_run(spec));
  return run_prepared(runs);
}

Json ProcessPool::run(const RunSpec& spec) const { return run(std::vector{spec}).front(); }

int solve_and_keep(const RunSpec& spec, const fs::path& folder, std::optional<double> memory_limit) {
  PreparedRun run = prepare_run(spec);
  run.scene.memory_limit = memory_limit;
  try {
    const ResultCache cache(folder);
    cache.keep(run.name, run.cache_key, solve(run), spec.fields);
    return 0;
  } catch (const solver::OutOfMemory&) {
    throw;
  } catch (const solver::InputError& error) {  // of the scene it is part of the result
    std::cerr << fmt::format("slipstick: {}\n", error.what());
    return kNotKept;
  }
}

}  // namespace slipstick::convergence
