#include "convergence/runs/process_pool.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <new>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "convergence/results/result.hpp"
#include "convergence/runs/progress.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "solver/input/input_error.hpp"
#include "solver/memory.hpp"
#include "solver/model.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// Part of the memory now available that runs may take side by side: other programs live here too.
constexpr double kMemoryPart = 0.7;
/// An interrupt that comes just before the waiting begins is seen after it.
constexpr int kLongestWait = 1000;  // ms

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
  std::optional<Json> found = cache.find(run.name, run.cache_key);
  const fs::path& fields = run.spec.fields;
  const bool refused = found && found->value("status", "") == "refused";
  return refused || fields.empty() || fs::exists(fields) ? std::move(found) : std::nullopt;
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
  Batch(std::vector<Task> tasks, const ProcessPoolOptions& options)
      : options_(options),
        tasks_(std::move(tasks)),
        jobs_(options.jobs > 0 ? static_cast<std::size_t>(options.jobs)
                               : std::max(1U, std::thread::hardware_concurrency())) {
    std::ranges::stable_sort(tasks_, std::greater<>(), &Task::bytes);
  }

  /// Why results are missing, by their names.
  std::map<std::string, std::string> work() {
    Progress progress(tasks_.size(),
                      std::accumulate(tasks_.begin(), tasks_.end(), 0.0,
                                      [](double sum, const Task& task) { return sum + task.bytes; }));
    std::map<std::string, std::string> failures;
    while (next_ < tasks_.size() || !running_.empty()) {
      while (may_start()) start_next();
      for (Worker& worker : take_ended()) {
        const Task& task = *worker.task;
        const std::string failure = failure_of(worker.program.wait());
        progress.finished(task.label, task.bytes);
        if (failure.empty()) continue;
        failures[task.run->name] = failure;
        fmt::print(stderr, "slipstick: {}: {}\n", run_text(task.run->spec), failure);
      }
      if (options_.interrupted && options_.interrupted()) {
        throw std::runtime_error(
            fmt::format("interrupted: {} points are done and kept in {}; the same command goes on "
                        "from there",
                        progress.text(), options_.folder.string()));
      }
    }
    return failures;
  }

 private:
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
  std::vector<Task> tasks_;
  std::size_t jobs_;
  std::size_t next_ = 0;
  std::list<Worker> running_;
  double bytes_ = 0.0;
  /// One process may take all of the first, several together the second.
  double memory_ = solver::memory_within(options_.memory_limit);
  double shared_ = options_.memory_limit ? memory_ : kMemoryPart * memory_;
};

/// The scene solved, or why it cannot be.
Json solve(const PreparedRun& run) {
  const RunSpec& spec = run.spec;
  SolvedScene solved;
  try {
    solved = solve_scene(run.scene, {.rounding = spec.rounding});
  } catch (const solver::OutOfMemory&) {
    throw;
  } catch (const solver::InputError& error) {
    return not_computed("refused", error.what(), spec);
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("memory ran out");
  }
  if (!spec.fields.empty()) write_solution_fields(spec.fields, solved.solution, solved.exact);
  if (spec.profile) solved.result["profile"] = profile_json(solved.solution, solved.exact);
  return std::move(solved.result);
}

}  // namespace

ProcessPool::ProcessPool(ProcessPoolOptions options) : options_(std::move(options)) {}

std::vector<Json> ProcessPool::run_prepared(const std::vector<PreparedRun>& runs) const {
  const ResultCache cache(options_.folder, options_.program);
  std::vector<Task> tasks;
  std::set<std::string> known;
  std::map<std::string, Json> refused;
  for (const PreparedRun& run : runs) {
    if (!known.insert(run.name).second || find(cache, run)) continue;
    Task task = make_task(run, options_.memory_limit);
    if (task.refusal.empty()) {
      tasks.push_back(std::move(task));
    } else {
      refused[run.name] = not_computed("refused", task.refusal, run.spec);
      refused[run.name]["out_of_memory"] = true;
    }
  }
  auto failures = Batch(std::move(tasks), options_).work();
  std::vector<Json> results;
  for (const PreparedRun& run : runs) {
    std::optional<Json> found = find(cache, run);
    std::string& failure = failures[run.name];
    if (failure.empty()) failure = "its result is not on disk";
    const bool is_refused = refused.contains(run.name);
    results.push_back(found        ? *std::move(found)
                      : is_refused ? refused[run.name]
                                   : not_computed("failed", failure, run.spec));
  }
  return results;
}

std::vector<Json> ProcessPool::run(const std::vector<RunSpec>& specs) const {
  std::vector<PreparedRun> runs;
  for (const RunSpec& spec : specs) runs.push_back(prepare_run(spec));
  return run_prepared(runs);
}

Json ProcessPool::run(const RunSpec& spec) const { return run(std::vector{spec}).front(); }

void solve_and_keep(const RunSpec& spec, const fs::path& folder, std::optional<double> memory_limit) {
  PreparedRun run = prepare_run(spec);
  run.scene.memory_limit = memory_limit;
  const ResultCache cache(folder);
  cache.forget(run.name);
  cache.keep(run.name, run.cache_key, solve(run));
}

}  // namespace slipstick::convergence
