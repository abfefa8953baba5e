#include "convergence/runs/process_pool.hpp"

#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <list>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>
#include <utility>

#include "convergence/results/output.hpp"
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

/// Part of the free memory that runs may take side by side; the rest is left to other programs.
constexpr double kMemoryPart = 0.7;
/// ms; an interrupt that comes just before poll() begins to wait is noticed after it.
constexpr int kLongestWait = 1000;

/// A run without a result on disk.
struct Task {
  const PreparedRun* run;
  std::string label;  ///< for a person
  double bytes = 0.0;
  std::string refusal = {};  ///< why it is not started; empty: it is
};

Task make_task(const PreparedRun& run, std::optional<double> memory_limit) {
  Task task{&run, run.spec.scene.stem().string()};
  solver::Scene scene = run.scene;
  scene.solver.memory_limit = memory_limit;
  try {
    const solver::Model model = solver::make_model(scene);
    task.label += fmt::format(" {} x {}", model.grid.n1, model.grid.n2);
    task.bytes = predicted_memory(scene, model).total();
  } catch (const solver::OutOfMemory& error) {  // not kept on disk: more memory would give an answer
    task.refusal = error.what();
  } catch (const solver::InputError&) {  // the run gives the same message
  }
  return task;
}

/// The kept result of a run, parsed here and nowhere else; none where it is no result of a solve.
std::optional<SolveRecord> find(const ResultCache& cache, const PreparedRun& run) {
  const std::optional<Json> kept = cache.find(run.name, run.cache_key, run.spec.fields);
  if (!kept) return std::nullopt;
  try {
    return from_json(*kept);
  } catch (const solver::InputError&) {
    return std::nullopt;
  }
}

/// The message of a process that failed, or how it ended; empty where its result counts.
std::string failure_of(const ProgramEnd& end) {
  constexpr std::string_view kName = "slipstick: ";
  std::string message = end.output.substr(0, end.output.find_last_not_of('\n') + 1);
  if (message.starts_with(kName)) message.erase(0, kName.size());
  if (end.code > 0 && !message.empty()) return message;
  return end.code == 0 ? "" : "its process " + end.trouble;
}

/// A larger run has a worker to itself: the process starts with all the memory that it may take, and returns
/// it at its end. The start of a process costs little compared with such a run.
constexpr double kMostShared = 128.0 * 0x1p20;  // bytes

/// Whether a run needs a worker to itself. FFTW's plans depend on the rounding, so that no other run may use
/// plans made under random rounding.
bool needs_own_worker(const Task& task) {
  return task.bytes > kMostShared || task.run->scene.solver.rounding_seed != 0;
}

/// Works through tasks, the largest first.
class TaskQueue {
 public:
  TaskQueue(std::vector<Task> tasks, const ResultCache& cache, const ProcessPoolOptions& options)
      : options_(options),
        cache_(cache),
        tasks_(std::move(tasks)),
        jobs_(options.jobs > 0 ? static_cast<std::size_t>(options.jobs)
                               : std::max(1U, std::thread::hardware_concurrency())) {
    std::ranges::stable_sort(tasks_, {}, [](const Task& task) {
      // All runs of a worker have one rounding.
      return std::pair(-task.bytes, static_cast<int>(task.run->spec.rounding));
    });
  }

  /// The records by the names of their runs. Each is read at the end of its run, since another program may
  /// share the folder.
  std::map<std::string, SolveRecord> work() {
    std::map<std::string, SolveRecord> records;
    while (next_ < tasks_.size() || busy_ > 0) {
      while (may_start()) start_next();
      for (const auto& [task, failure] : take_finished()) {
        records[task->run->name] = record_of(*task, failure);
      }
      if (is_interrupted()) stop("interrupted");
    }
    end_idle();
    return records;
  }

  /// The same in this process, one run after another, on systems where it can start no other.
  std::map<std::string, SolveRecord> work_here() {
    const auto shared = std::make_shared<solver::SolveCache>();
    std::map<std::string, SolveRecord> records;
    for (const Task& task : tasks_) {
      std::string failure;
      try {
        keep_result_of(*task.run, options_.memory_limit, shared, cache_);
      } catch (const solver::InputError& error) {
        stop(error.what());
      } catch (const std::exception& error) {
        failure = error.what();
      }
      records[task.run->name] = record_of(task, failure);
      if (is_interrupted()) stop("interrupted");
    }
    return records;
  }

 private:
  bool is_interrupted() const { return options_.interrupted != nullptr && options_.interrupted(); }

  [[noreturn]] void stop(const std::string& why) const {
    options_.progress->end();
    throw std::runtime_error(fmt::format("{}: {} points are done and kept in {}; the same command goes on from there",
                                         why, options_.progress->text(), options_.folder.string()));
  }

  /// Of a task that is done.
  SolveRecord record_of(const Task& task, std::string failure) const {
    const PreparedRun& run = *task.run;
    options_.progress->finished(task.label, task.bytes);
    if (std::optional<SolveRecord> found = find(cache_, run)) return *std::move(found);
    if (failure.empty()) failure = "its result is not on disk";
    std::cerr << plain_text(fmt::format("slipstick: {}: {}\n", run_text(run.spec), failure));
    return not_computed(RunStatus::failed, failure, run.spec);
  }

  struct PooledWorker {
    PooledWorker(const ProcessPoolOptions& options, std::optional<double> memory_limit, const Task* first)
        : worker(options.program, options.folder, memory_limit), task(first), rounding(first->run->spec.rounding) {}
    Worker worker;
    const Task* task;   ///< nullptr: idle
    Rounding rounding;  ///< of all its runs: FFTW keeps plans, which it chose by rounded costs
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
    // The limit of all runs, since the free memory now excludes the running solves.
    const auto limit = std::isfinite(memory_) ? std::optional(memory_) : std::nullopt;
    const Task* const task = &tasks_[next_++];
    auto pooled = std::ranges::find_if(workers_, [&](const PooledWorker& other) {
      return other.task == nullptr && other.rounding == task->run->spec.rounding && !needs_own_worker(*task);
    });
    if (pooled == workers_.end()) {
      end_idle();
      pooled = workers_.emplace(workers_.end(), options_, limit, task);
    }
    pooled->task = task;
    pooled->worker.start(task->run->spec);
    bytes_ += task->bytes;
    ++busy_;
  }

  void end_idle() {
    workers_.remove_if([](PooledWorker& pooled) {
      if (pooled.task == nullptr) pooled.worker.wait();
      return pooled.task == nullptr;
    });
  }

  /// Waits until a run is finished, or for an interrupt.
  std::vector<Finished> take_finished() {
    std::vector<pollfd> outputs;
    for (const PooledWorker& pooled : workers_) outputs.push_back({pooled.worker.output(), POLLIN, 0});
    std::vector<Finished> finished;
    if (poll(outputs.data(), outputs.size(), kLongestWait) <= 0) return finished;
    auto next = workers_.begin();
    for (const pollfd& output : outputs) {
      const auto pooled = next++;
      if (output.revents == 0) continue;
      const Worker::Event event = pooled->worker.next();
      if (event == Worker::Event::output) continue;
      const Task* const task = std::exchange(pooled->task, nullptr);
      std::string failure;
      if (event == Worker::Event::ended || task == nullptr || needs_own_worker(*task)) {
        const ProgramEnd end = pooled->worker.wait();
        failure = failure_of(end);
        workers_.erase(pooled);
        if (end.code == kNotKept) stop(failure);
      }
      if (task == nullptr) continue;  // it ended while it was idle: nothing is lost
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
  std::list<PooledWorker> workers_;
  std::size_t busy_ = 0;
  double bytes_ = 0.0;  ///< predicted, of the running solves
  /// Bytes that one run may take, and several runs together.
  double memory_ = solver::memory_within(options_.memory_limit);
  double shared_ = options_.memory_limit ? memory_ : kMemoryPart * memory_;
};

}  // namespace

ProcessPool::ProcessPool(ProcessPoolOptions options) : options_(std::move(options)) {}

std::vector<PreparedRun> ProcessPool::with_versions(const std::vector<PreparedRun>& runs) const {
  std::vector<PreparedRun> all = runs;
  std::map<fs::path, std::string> versions;
  for (PreparedRun& run : all) {
    const fs::path& file = run.scene.solver.program;
    if (file.empty()) continue;
    require_allowed(run.scene, options_.programs);
    if (!versions.contains(file)) versions[file] = version_of(read_solver_program(file), options_.program);
    run.spec.program_version = versions[file];
    run = prepare_run(run.spec);
  }
  return all;
}

std::vector<SolveRecord> ProcessPool::run_prepared(const std::vector<PreparedRun>& unversioned) const {
  const std::vector<PreparedRun> runs = with_versions(unversioned);
  const ResultCache cache(options_.folder, options_.program);
  std::vector<Task> tasks;
  std::map<std::string, SolveRecord> known;
  for (const PreparedRun& run : runs) {
    const auto [place, is_new] = known.try_emplace(run.name);
    if (!is_new) continue;
    if (std::optional<SolveRecord> found = find(cache, run)) {
      place->second = *std::move(found);
      continue;
    }
    if (options_.lacking != nullptr) {
      options_.lacking->push_back(run);
      place->second = not_computed(RunStatus::refused, "it is listed, and not solved", run.spec);
      continue;
    }
    Task task = make_task(run, options_.memory_limit);
    if (task.refusal.empty()) {
      tasks.push_back(std::move(task));
    } else {
      place->second = not_computed(RunStatus::refused, task.refusal, run.spec);
      place->second.out_of_memory = true;
    }
  }
  if (!tasks.empty()) solver::require_writable(options_.folder);
  const double weight =
      std::accumulate(tasks.begin(), tasks.end(), 0.0, [](double sum, const Task& task) { return sum + task.bytes; });
  options_.progress->begin_runs(tasks.size(), weight, known.size());
  TaskQueue queue(std::move(tasks), cache, options_);
  for (auto& [name, record] : starts_programs() ? queue.work() : queue.work_here()) {
    known[name] = std::move(record);
  }
  std::vector<SolveRecord> records;
  for (const PreparedRun& run : runs) records.push_back(known[run.name]);
  return records;
}

std::vector<SolveRecord> ProcessPool::run(const std::vector<RunSpec>& specs) const {
  std::vector<PreparedRun> runs;
  for (const RunSpec& spec : specs) runs.push_back(prepare_run(spec));
  return run_prepared(runs);
}

std::vector<SolveRecord> ProcessPool::run_or_refuse(const std::vector<RunSpec>& specs) const {
  std::vector<SolveRecord> records(specs.size());
  std::vector<PreparedRun> readable;
  std::vector<SolveRecord*> places;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    try {
      readable.push_back(prepare_run(specs[i]));
      places.push_back(&records[i]);
    } catch (const solver::InputError& error) {
      records[i] = not_computed(RunStatus::refused, error.what(), specs[i]);
    }
  }
  std::vector<SolveRecord> solved = run_prepared(readable);
  for (std::size_t k = 0; k < solved.size(); ++k) *places[k] = std::move(solved[k]);
  return records;
}

}  // namespace slipstick::convergence
