#include "convergence/point_runner.hpp"

#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "convergence/journal.hpp"
#include "convergence/progress.hpp"
#include "solver/input_error.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// Part of the memory now available that points may take: predictions are good to a few percent, and other
/// programs live here too.
constexpr double kMemoryPart = 0.7;

volatile std::sig_atomic_t interrupted = 0;

/// Takes note of an interrupt, for as long as it lives.
class InterruptScope {
 public:
  InterruptScope() {
    interrupted = 0;
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };  // no SA_RESTART: waiting ends
    sigaction(SIGINT, &action, &before_);
  }
  ~InterruptScope() { sigaction(SIGINT, &before_, nullptr); }
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

 private:
  struct sigaction before_ {};
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

Json not_computed(const char* status, const std::string& message) {
  return {{"status", status}, {"message", message}};
}

Json solve_or_refuse(const Point& point) {
  try {
    return solve_point(point);
  } catch (const solver::InputError& error) {
    return not_computed("refused", error.what());
  }
}

/// In a process of its own. Returns its number.
pid_t start(const Task& task, const Journal& journal) {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(fmt::format("no further process: {}", std::strerror(errno)));
  if (child > 0) return child;
  std::signal(SIGINT, SIG_DFL);
  int status = EXIT_SUCCESS;
  try {
    journal.keep(task.name, task.question, solve_or_refuse(task.point));
  } catch (const std::exception& error) {
    fmt::print(stderr, "slipstick: {}: {}\n", task.label, error.what());
    status = EXIT_FAILURE;
  }
  std::fflush(nullptr);
  _exit(status);
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return fmt::format("its process was killed by signal {}{}", signal,
                       signal == SIGKILL ? ", as where memory runs out" : "");
  }
  return fmt::format("its process ended with code {}", WEXITSTATUS(status));
}

double total_bytes(const std::vector<Task>& tasks) {
  double bytes = 0.0;
  for (const Task& task : tasks) bytes += task.bytes;
  return bytes;
}

/// The tasks' processes, largest first.
class Crew {
 public:
  Crew(std::vector<Task> tasks, const Journal& journal, int jobs)
      : tasks_(std::move(tasks)), journal_(journal), jobs_(static_cast<std::size_t>(jobs)) {
    std::stable_sort(tasks_.begin(), tasks_.end(),
                     [](const Task& a, const Task& b) { return a.bytes > b.bytes; });
  }

  /// Why points are missing, by their names.
  std::map<std::string, std::string> work(const fs::path& folder) {
    const InterruptScope scope;
    Progress progress(tasks_.size(), total_bytes(tasks_));
    std::map<std::string, std::string> failures;
    while (next_ < tasks_.size() || !running_.empty()) {
      while (may_start()) start_next();
      int status = 0;
      const pid_t child = waitpid(-1, &status, 0);
      if (interrupted != 0)
        stop(
            fmt::format("interrupted: {} points are done and kept in {}; the same command goes on "
                        "from there",
                        progress.text(), folder.string()));
      const auto found = running_.find(child);
      if (found == running_.end()) continue;
      const Task& task = tasks_[found->second];
      if (status != 0) failures[task.name] = how_it_ended(status);
      bytes_ -= task.bytes;
      running_.erase(found);
      progress.finished(task.label, task.bytes);
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
    running_[start(tasks_[next_], journal_)] = next_;
    bytes_ += tasks_[next_].bytes;
    ++next_;
  }

  [[noreturn]] void stop(const std::string& message) {
    for (const auto& [child, task] : running_) kill(child, SIGTERM);
    for (const auto& [child, task] : running_) waitpid(child, nullptr, 0);
    throw std::runtime_error(message);
  }

  std::vector<Task> tasks_;
  const Journal& journal_;
  std::size_t jobs_;
  std::size_t next_ = 0;
  std::map<pid_t, std::size_t> running_;
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
    results.push_back(found
                          ? *std::move(found)
                          : not_computed("failed", failure != failures.end() ? failure->second
                                                                             : "its result is not on disk"));
  }
  return results;
}

Json PointRunner::run(const Point& point) { return run(std::vector{point}).front(); }

}  // namespace slipstick::convergence
