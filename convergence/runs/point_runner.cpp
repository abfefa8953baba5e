#include "convergence/runs/point_runner.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "convergence/programs/child_process.hpp"
#include "convergence/runs/progress.hpp"
#include "convergence/runs/result_cache.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// Part of the memory now available that points may take: predictions are good to a few percent, and other
/// programs live here too.
constexpr double kMemoryPart = 0.7;

/// What asks a program to end, and may come to this process alone.
constexpr std::array kInterrupts{SIGINT, SIGTERM, SIGHUP};
/// An interrupt that comes just before the waiting begins is seen after it.
constexpr int kLongestWait = 1000;  // ms

volatile std::sig_atomic_t interrupted = 0;

/// Takes note of an interrupt, for as long as it lives; of those that are ignored, as under nohup, none.
class InterruptScope {
 public:
  InterruptScope() {
    interrupted = 0;
    for (std::size_t i = 0; i < kInterrupts.size(); ++i) {
      struct sigaction action {};
      action.sa_handler = [](int) { interrupted = 1; };  // no SA_RESTART: waiting ends
      sigaction(kInterrupts[i], nullptr, &before_[i]);
      if (before_[i].sa_handler != SIG_IGN) sigaction(kInterrupts[i], &action, nullptr);
    }
  }
  ~InterruptScope() { restore(); }
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  /// Everything as it was before.
  void restore() const {
    for (std::size_t i = 0; i < kInterrupts.size(); ++i) sigaction(kInterrupts[i], &before_[i], nullptr);
  }

 private:
  std::array<struct sigaction, kInterrupts.size()> before_{};
};

/// A point that is not on disk yet.
struct Task {
  Point point;
  std::string name;  ///< of its file
  std::string question;
  std::string label;  ///< for a person
  double bytes = 0.0;
};

/// FNV-1a.
std::uint64_t hash(const std::string& text) {
  std::uint64_t value = 14695981039346656037ULL;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return value;
}

std::string file_name(const Point& point, const std::string& question) {
  return fmt::format("{}-{:016x}", point.scene.stem().string(), hash(question));
}

/// Bytes that can be had without swapping; none known: as if there were enough.
double available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key;
  double kilobytes = 0.0;
  while (file >> key >> kilobytes) {
    if (key == "MemAvailable:") return 1024.0 * kilobytes;
    file.ignore(80, '\n');
  }
  return INFINITY;
}

Task make_task(const Point& point, std::string name, std::string question) {
  Task task{point, std::move(name), std::move(question), point.scene.stem().string(), 0.0};
  const solver::Scene scene = solver::read_scene(point.scene, point.overrides);
  try {
    const solver::Model model = solver::make_model(scene);
    task.label += fmt::format(" {} x {}", model.grid.n1, model.grid.n2);
    task.bytes = predicted_memory(scene, model).total();
  } catch (const solver::InputError&) {  // the point itself will say so
  }
  return task;
}

Json not_computed(const char* status, const std::string& message, const Point& point) {
  return {{"status", status}, {"message", message}, {"run", run_text(point)}};
}

Json solve_or_refuse(const Point& point) {
  try {
    return solve_point(point);
  } catch (const solver::InputError& error) {
    return not_computed("refused", error.what(), point);
  }
}

/// In a process of its own. Returns why the result is not on disk; empty: it is.
std::string solve_and_keep(const Task& task, const Journal& journal) {
  try {
    journal.keep(task.name, task.question, solve_or_refuse(task.point));
    return "";
  } catch (const std::bad_alloc&) {
    return "memory ran out";
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// A task's process, and the pipe that brings why it failed and ends with it.
struct Worker {
  pid_t process;
  int pipe;
  std::size_t task;
  std::string failure;

  /// Waits for what comes next. Returns whether that is its end.
  bool read_on() {
    std::array<char, 4096> buffer{};
    const ssize_t size = ::read(pipe, buffer.data(), buffer.size());
    if (size < 0) return errno != EINTR;
    failure.append(buffer.data(), static_cast<std::size_t>(size));
    return size == 0;
  }
};

/// Empty where nothing speaks against its result, which is on disk then.
std::string how_it_failed(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return fmt::format("its process was killed by signal {}{}", signal,
                       signal == SIGKILL ? ", as where memory runs out" : "");
  }
  const bool failed = WIFEXITED(status) && WEXITSTATUS(status) != EXIT_SUCCESS;
  return failed ? fmt::format("its process ended with code {}", WEXITSTATUS(status)) : "";
}

double total_bytes(const std::vector<Task>& tasks) {
  double bytes = 0.0;
  for (const Task& task : tasks) bytes += task.bytes;
  return bytes;
}

/// The tasks' processes, largest first. Those that still run when this goes are killed.
class Crew {
 public:
  Crew(std::vector<Task> tasks, const Journal& journal, int jobs)
      : tasks_(std::move(tasks)), journal_(journal), jobs_(static_cast<std::size_t>(jobs)) {
    std::stable_sort(tasks_.begin(), tasks_.end(),
                     [](const Task& a, const Task& b) { return a.bytes > b.bytes; });
  }
  ~Crew() {
    for (const Worker& worker : running_) kill(worker.process, SIGKILL);
    for (const Worker& worker : running_) end(worker);
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Why points are missing, by their names.
  std::map<std::string, std::string> work(const fs::path& folder) {
    Progress progress(tasks_.size(), total_bytes(tasks_));
    std::map<std::string, std::string> failures;
    while (next_ < tasks_.size() || !running_.empty()) {
      while (may_start()) start_next();
      for (const Worker& worker : take_ended()) {
        const Task& task = tasks_[worker.task];
        const int status = end(worker);
        progress.finished(task.label, task.bytes);
        const std::string failure = worker.failure.empty() ? how_it_failed(status) : worker.failure;
        if (failure.empty()) continue;
        failures[task.name] = failure;
        fmt::print(stderr, "slipstick: {}: {}\n", run_text(task.point), failure);
      }
      if (interrupted != 0) {
        throw std::runtime_error(
            fmt::format("interrupted: {} points are done and kept in {}; the same command goes on "
                        "from there",
                        progress.text(), folder.string()));
      }
    }
    return failures;
  }

 private:
  bool may_start() const {
    if (next_ == tasks_.size()) return false;
    return running_.empty() ||
           (running_.size() < jobs_ && bytes_ + tasks_[next_].bytes < kMemoryPart * memory_);
  }

  void start_next() {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw std::runtime_error(fmt::format("no pipe: {}", std::strerror(errno)));
    const Task& task = tasks_[next_];
    const pid_t child = fork_child();
    if (child == 0) {
      interrupts_.restore();
      const std::string failure = solve_and_keep(task, journal_);
      const bool told = ::write(ends[1], failure.data(), failure.size()) >= 0;
      _exit(failure.empty() && told ? EXIT_SUCCESS : EXIT_FAILURE);
    }
    close(ends[1]);
    running_.push_back({child, ends[0], next_, ""});
    bytes_ += task.bytes;
    ++next_;
  }

  /// Waits for workers to end, or for an interrupt.
  std::vector<Worker> take_ended() {
    std::vector<pollfd> pipes;
    for (const Worker& worker : running_) pipes.push_back({worker.pipe, POLLIN, 0});
    std::vector<Worker> ended;
    if (poll(pipes.data(), pipes.size(), kLongestWait) <= 0) return ended;
    for (std::size_t i = running_.size(); i-- > 0;) {
      if (pipes[i].revents == 0 || !running_[i].read_on()) continue;
      ended.push_back(std::move(running_[i]));
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      bytes_ -= tasks_[ended.back().task].bytes;
    }
    return ended;
  }

  static int end(const Worker& worker) {
    close(worker.pipe);
    return wait_for_child(worker.process);
  }

  const InterruptScope interrupts_;
  std::vector<Task> tasks_;
  const Journal& journal_;
  std::size_t jobs_;
  std::size_t next_ = 0;
  std::vector<Worker> running_;
  double bytes_ = 0.0;
  double memory_ = available_memory();
};

}  // namespace

PointRunner::PointRunner(fs::path folder, int jobs)
    : folder_(std::move(folder)),
      jobs_(jobs > 0 ? jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

std::vector<Json> PointRunner::run(const std::vector<Point>& points) {
  const Journal journal(folder_);
  std::vector<std::string> questions;
  std::vector<Task> tasks;
  std::set<std::string> known;
  for (const Point& point : points) {
    questions.push_back(question(point));
    if (!known.insert(questions.back()).second) continue;
    std::string name = file_name(point, questions.back());
    if (!journal.find(name, questions.back())) {
      tasks.push_back(make_task(point, std::move(name), questions.back()));
    }
  }
  const auto failures = Crew(std::move(tasks), journal, jobs_).work(folder_);
  std::vector<Json> results;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string name = file_name(points[i], questions[i]);
    const auto failure = failures.find(name);
    std::optional<Json> found = journal.find(name, questions[i]);
    results.push_back(
        found ? *std::move(found)
              : not_computed("failed",
                             failure != failures.end() ? failure->second : "its result is not on disk",
                             points[i]));
  }
  return results;
}

Json PointRunner::run(const Point& point) { return run(std::vector{point}).front(); }

}  // namespace slipstick::convergence
