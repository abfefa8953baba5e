#include "convergence/runs/process_pool.hpp"

#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <list>
#include <numeric>
#include <thread>
#include <utility>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/results/output.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/progress.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/worker.hpp"
#include "convergence/system/machine.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"
#include "solver/model/make_model.hpp"
#include "solver/model/memory.hpp"
#include "solver/model/memory_plan.hpp"

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

/// The folder of finished results, and those that it joins.
class JoinedCaches {
 public:
  explicit JoinedCaches(const ProcessPoolOptions& options) : own_(options.folder, options.program) {
    for (const fs::path& folder : options.joined) others_.push_back(own_.in(folder));
  }

  const ResultCache& own() const { return own_; }

  std::optional<Json> find_or_join(const PreparedRun& run) const {
    if (std::optional<Json> found = find(own_, run)) return found;
    for (const ResultCache& other : others_) {
      std::optional<Json> found = find(other, run);
      if (!found) continue;
      own_.keep(run.name, run.cache_key, *found, run.spec.fields);
      return found;
    }
    return std::nullopt;
  }

 private:
  ResultCache own_;
  std::vector<ResultCache> others_;
};

/// What a process that failed says, or how it ended; empty where nothing speaks against its result.
std::string failure_of(const ProgramEnd& end) {
  constexpr std::string_view kName = "slipstick: ";
  std::string said = end.output.substr(0, end.output.find_last_not_of('\n') + 1);
  if (said.starts_with(kName)) said.erase(0, kName.size());
  if (end.code > 0 && !said.empty()) return said;
  return end.code == 0 ? "" : "its process " + end.trouble;
}

/// A run that needs more has a worker to itself, so that it begins with all the memory that it may take and
/// gives all of it back; what starting a process takes is little beside it.
constexpr double kMostOfMany = 128.0 * 0x1p20;

/// Whether a run needs a worker to itself. What FFTW plans while numbers are rounded at random is no other
/// run's.
bool is_alone(const Task& task) { return task.bytes > kMostOfMany || task.run->scene.rounding_seed != 0; }

/// The work on some tasks, largest first.
class TaskQueue {
 public:
  TaskQueue(std::vector<Task> tasks, const ResultCache& cache, const ProcessPoolOptions& options)
      : options_(options),
        cache_(cache),
        tasks_(std::move(tasks)),
        jobs_(options.jobs > 0 ? static_cast<std::size_t>(options.jobs)
                               : std::max(1U, std::thread::hardware_concurrency())) {
    std::ranges::stable_sort(tasks_, {}, [](const Task& task) {
      // One worker takes runs that are rounded alike.
      return std::pair(-task.bytes, static_cast<int>(task.run->spec.rounding));
    });
  }

  /// The results, by their names. Each is read when its run is finished: another program may share the
  /// folder.
  std::map<std::string, Json> work() {
    Progress progress(tasks_.size(),
                      std::accumulate(tasks_.begin(), tasks_.end(), 0.0,
                                      [](double sum, const Task& task) { return sum + task.bytes; }));
    std::map<std::string, Json> results;
    while (next_ < tasks_.size() || busy_ > 0) {
      while (may_start()) start_next();
      for (const auto& [task, failure] : take_finished(progress)) {
        progress.finished(task->label, task->bytes);
        results[task->run->name] = result_of(*task->run, failure);
      }
      if (options_.interrupted && options_.interrupted()) stop(progress, "interrupted");
    }
    end_waiting();
    return results;
  }

  /// The same in this process, where no other can be started: one after another.
  std::map<std::string, Json> work_here() {
    Progress progress(tasks_.size(), static_cast<double>(tasks_.size()));
    const auto shared = std::make_shared<solver::SolveCache>();
    std::map<std::string, Json> results;
    for (const Task& task : tasks_) {
      std::string failure;
      try {
        keep_result_of(*task.run, options_.memory_limit, shared, cache_);
      } catch (const solver::InputError& error) {
        stop(progress, error.what());
      } catch (const std::exception& error) {
        failure = error.what();
      }
      progress.finished(task.label, 1.0);
      results[task.run->name] = result_of(*task.run, failure);
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
    std::cerr << plain_text(fmt::format("slipstick: {}: {}\n", run_text(run.spec), failure));
    return not_computed("failed", failure, run.spec);
  }

  /// A worker and what it does; null: it waits.
  struct Hand {
    Hand(const ProcessPoolOptions& options, std::optional<double> memory_limit, const Task* first)
        : worker(options.program, options.folder, memory_limit),
          task(first),
          rounding(first->run->spec.rounding) {}
    Worker worker;
    const Task* task;
    Rounding rounding;  ///< of all its runs: FFTW remembers plans, which it chose by rounded costs
  };
  struct Finished {
    const Task* task;
    std::string failure;  ///< empty: none
  };

  bool may_start() const {
    if (next_ == tasks_.size()) return false;
    return busy_ == 0 || (busy_ < jobs_ && bytes_ + tasks_[next_].bytes < shared_);
  }

  void start_next() {
    // What is left now is less by what the others take.
    const auto limit = std::isfinite(memory_) ? std::optional(memory_) : std::nullopt;
    const Task* const task = &tasks_[next_++];
    auto hand = std::ranges::find_if(hands_, [&](const Hand& other) {
      return other.task == nullptr && other.rounding == task->run->spec.rounding && !is_alone(*task);
    });
    if (hand == hands_.end()) {
      end_waiting();
      hand = hands_.emplace(hands_.end(), options_, limit, task);
    }
    hand->task = task;
    hand->worker.start(task->run->spec);
    bytes_ += task->bytes;
    ++busy_;
  }

  void end_waiting() {
    hands_.remove_if([](Hand& hand) {
      if (hand.task == nullptr) hand.worker.wait();
      return hand.task == nullptr;
    });
  }

  /// Waits for runs to be finished, or for an interrupt.
  std::vector<Finished> take_finished(const Progress& progress) {
    std::vector<pollfd> outputs;
    for (const Hand& hand : hands_) outputs.push_back({hand.worker.output(), POLLIN, 0});
    std::vector<Finished> finished;
    if (poll(outputs.data(), outputs.size(), kLongestWait) <= 0) return finished;
    auto next = hands_.begin();
    for (const pollfd& output : outputs) {
      const auto hand = next++;
      if (output.revents == 0) continue;
      const Worker::Said said = hand->worker.next();
      if (said == Worker::Said::more) continue;
      const Task* const task = std::exchange(hand->task, nullptr);
      std::string failure;
      if (said == Worker::Said::ended || task == nullptr || is_alone(*task)) {
        const ProgramEnd end = hand->worker.wait();
        failure = failure_of(end);
        hands_.erase(hand);
        if (end.code == kNotKept) stop(progress, failure);
      }
      if (task == nullptr) continue;  // it ended while it waited: nothing is lost
      bytes_ -= task->bytes;
      --busy_;
      finished.push_back({task, std::move(failure)});
    }
    return finished;
  }

  const ProcessPoolOptions& options_;
  const ResultCache& cache_;
  std::vector<Task> tasks_;
  std::size_t jobs_;
  std::size_t next_ = 0;
  std::list<Hand> hands_;
  std::size_t busy_ = 0;
  double bytes_ = 0.0;  ///< of what runs
  /// One run may take all of the first, several together the second.
  double memory_ = solver::memory_within(options_.memory_limit);
  double shared_ = options_.memory_limit ? memory_ : kMemoryPart * memory_;
};

}  // namespace

ProcessPool::ProcessPool(ProcessPoolOptions options) : options_(std::move(options)) {}

std::vector<PreparedRun> ProcessPool::with_versions(const std::vector<PreparedRun>& runs) const {
  std::vector<PreparedRun> all = runs;
  std::map<fs::path, std::string> versions;
  for (PreparedRun& run : all) {
    const fs::path& file = run.scene.program;
    if (file.empty()) continue;
    require_allowed(run.scene, options_.programs);
    if (!versions.contains(file)) versions[file] = version_of(read_solver_program(file), options_.program);
    run.spec.program_version = versions[file];
    run = prepare_run(run.spec);
  }
  return all;
}

std::vector<Json> ProcessPool::run_prepared(const std::vector<PreparedRun>& as_they_came) const {
  const std::vector<PreparedRun> runs = with_versions(as_they_came);
  const JoinedCaches caches(options_);
  std::vector<Task> tasks;
  std::map<std::string, Json> known;
  for (const PreparedRun& run : runs) {
    const auto [place, is_new] = known.try_emplace(run.name);
    if (!is_new) continue;
    std::optional<Json> found = caches.find_or_join(run);
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
  TaskQueue queue(std::move(tasks), caches.own(), options_);
  for (auto& [name, result] : starts_programs() ? queue.work() : queue.work_here())
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

std::vector<PreparedRun> ProcessPool::missing(const std::vector<PreparedRun>& as_they_came) const {
  const std::vector<PreparedRun> runs = with_versions(as_they_came);
  const JoinedCaches caches(options_);
  std::vector<PreparedRun> missing;
  for (const PreparedRun& run : runs) {
    if (!caches.find_or_join(run)) missing.push_back(run);
  }
  return missing;
}

Json ProcessPool::run(const RunSpec& spec) const { return run(std::vector{spec}).front(); }

}  // namespace slipstick::convergence
