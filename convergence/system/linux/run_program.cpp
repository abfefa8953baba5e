#include "convergence/system/run_program.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "convergence/results/output.hpp"

#ifdef __linux__
#include <sys/prctl.h>
#endif

extern char** environ;

namespace slipstick::convergence {
namespace {

/// The exit code of a program that could not be started, as shells have it.
constexpr int kNotStarted = 127;
/// Words of a command line that starts a program by way of slipstick: kTied, the process id of the parent,
/// then kStart or kGuard and the words of the other program. kGuard: no descendant may outlive it.
constexpr std::string_view kTied = "--tied-to";
constexpr std::string_view kStart = "start";
constexpr std::string_view kGuard = "guard";
/// Time between two polls for the end of a program without captured output.
constexpr std::chrono::milliseconds kLook{5};

#ifdef __linux__
/// Number of searches for remaining descendants, kLook apart: a process inside a kernel call may survive a
/// SIGKILL for a while.
constexpr int kMostLooks = 1000;

bool is_child(const std::filesystem::path& process) {
  std::ifstream file(process / "stat");
  const std::string stat{std::istreambuf_iterator<char>(file), {}};
  const auto name_ends = stat.rfind(')');  // "pid (name) state parent"
  return name_ends != std::string::npos && name_ends + 4 < stat.size() &&
         std::atoi(stat.c_str() + name_ends + 4) == getpid();
}

/// Kills all descendants. This process is a subreaper: a descendant whose parent ends becomes its child, so
/// killing children repeatedly reaches all.
void kill_descendants() {
  for (int look = 0; look < kMostLooks; ++look) {
    pid_t ended = 0;
    do ended = waitpid(-1, nullptr, WNOHANG);
    while (ended > 0);
    if (ended < 0) return;  // there is none
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
      const pid_t process = std::atoi(entry.path().filename().c_str());
      if (process > 0 && is_child(entry.path())) kill(process, SIGKILL);
    }
    std::this_thread::sleep_for(kLook);
  }
}

/// Starts a program and waits for its end, or for SIGTERM, which the kernel also sends when the parent ends.
/// Then kills all descendants and ends with the program's exit code or signal.
[[noreturn]] void guard(char** words, pid_t parent) {
  sigset_t awaited;
  sigset_t before;
  sigemptyset(&awaited);
  for (const int each : {SIGCHLD, SIGTERM}) sigaddset(&awaited, each);
  std::signal(SIGCHLD, SIG_DFL);
  sigprocmask(SIG_BLOCK, &awaited, &before);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(EXIT_FAILURE);
  const pid_t program = fork();
  if (program == 0) {
    setpgid(0, 0);
    sigprocmask(SIG_SETMASK, &before, nullptr);
    execvp(words[0], words);
    _exit(kNotStarted);
  }
  int signal = program < 0 ? SIGTERM : 0;
  int status = 0;
  bool ended = false;
  while (!ended && signal != SIGTERM) {
    sigwait(&awaited, &signal);
    int of_one = 0;
    for (pid_t one = 0; (one = waitpid(-1, &of_one, WNOHANG)) > 0;) {
      if (one != program) continue;
      ended = true;
      status = of_one;
    }
  }
  kill_descendants();
  if (!ended) _exit(kNotStarted);
  if (WIFEXITED(status)) _exit(WEXITSTATUS(status));
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  std::signal(WTERMSIG(status), SIG_DFL);
  sigemptyset(&before);
  sigprocmask(SIG_SETMASK, &before, nullptr);
  raise(WTERMSIG(status));
  _exit(EXIT_FAILURE);
}
#endif

std::vector<std::string> tied(const std::vector<std::string>& words, const std::string& program, bool guarded) {
  if (program.empty()) return words;
  std::vector<std::string> all{program, std::string(kTied), std::to_string(getpid())};
  const bool itself = words.front() == program;
  if (!itself) all.emplace_back(guarded ? kGuard : kStart);
  all.insert(all.end(), words.begin() + (itself ? 1 : 0), words.end());
  return all;
}

/// Empty: none.
std::string trouble_of(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return fmt::format("was killed by signal {}{}", signal, signal == SIGKILL ? ", as where memory runs out" : "");
  }
  return WEXITSTATUS(status) == 0 ? "" : fmt::format("ended with code {}", WEXITSTATUS(status));
}

ProgramEnd not_started(int error) {
  return {.started = false,
          .output = {},
          .trouble = "not started: " + failure_text(std::system_error(error, std::generic_category()))};
}

}  // namespace

Program::Program(const std::vector<std::string>& words, const ProgramOptions& options) {
  own_group_ = options.own_group;
#ifdef __linux__
  guarded_ = own_group_ && !options.tied_by.empty();
#endif
  std::vector<std::string> all = tied(words, options.tied_by, guarded_);
  std::vector<char*> arguments;
  for (std::string& word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> ends{-1, -1};
  std::array<int, 2> feed{-1, -1};
  const bool pipes = options.captured == Captured::nothing || pipe2(ends.data(), O_CLOEXEC) == 0;
  output_ = ends[0];
  // A socket, since writing to one whose reader has ended need not end this process.
  if (!pipes || (options.fed && socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, feed.data()) != 0)) {
    const std::string why = std::strerror(errno);
    for (int& end : ends) close_descriptor(end);
    throw std::runtime_error(fmt::format("no pipe: {}", why));
  }
  input_ = feed[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (input_ >= 0) posix_spawn_file_actions_adddup2(&actions, feed[1], STDIN_FILENO);
  if (output_ >= 0) {
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    if (options.captured == Captured::everything) {
      posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    }
  }
  if (!options.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, options.folder.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  if (own_group_) posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int error = posix_spawnp(&process_, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close_descriptor(ends[1]);
  close_descriptor(feed[1]);
  if (error == 0) return;
  process_ = -1;
  end_ = not_started(error);
}

Program::~Program() {
  stop();
  close_descriptor(output_);
  wait();
}

void Program::stop() {
  if (process_ <= 0) return;
  if (guarded_) {
    kill(process_, SIGTERM);
  } else {
    kill(own_group_ ? -process_ : process_, SIGKILL);
  }
}

void Program::close_descriptor(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

void Program::feed(std::string_view text) {
  while (!text.empty()) {
    const ssize_t size = send(input_, text.data(), text.size(), MSG_NOSIGNAL);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return;
    text.remove_prefix(static_cast<std::size_t>(size));
  }
}

bool Program::read_on() {
  if (output_ < 0) return true;
  std::array<char, 65536> buffer{};
  const ssize_t size = read(output_, buffer.data(), buffer.size());
  if (size < 0 && errno == EINTR) return false;
  if (size > 0) end_.output.append(buffer.data(), static_cast<std::size_t>(size));
  if (size <= 0) close_descriptor(output_);
  return size <= 0;
}

bool Program::reap(bool wait) {
  if (process_ <= 0) return true;
  int status = 0;
  rusage used{};
  pid_t found = 0;
  do found = wait4(process_, &status, wait ? 0 : WNOHANG, &used);
  while (found < 0 && errno == EINTR);
  if (found == 0) return false;
  process_ = -1;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  end_.cpu_seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
  if (found < 0) {
    end_.trouble = "ended, exit status unavailable";
  } else if (WIFEXITED(status) && WEXITSTATUS(status) == kNotStarted) {
    end_ = not_started(ENOENT);
  } else {
    end_.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    end_.trouble = trouble_of(status);
  }
  return true;
}

ProgramEnd Program::wait() {
  end_feed();
  while (!read_on()) {
  }
  reap(true);
  return end_;
}

ProgramEnd Program::wait_at_most(double seconds, std::size_t kept) {
  using Clock = std::chrono::steady_clock;
  end_feed();
  const auto start = Clock::now();
  const pid_t group = process_;
  const auto read_available = [&](int wait) {
    pollfd ready{output_, POLLIN, 0};
    if (output_ < 0 || poll(&ready, 1, wait) <= 0) return false;
    read_on();
    if (end_.output.size() > kept) end_.output.erase(0, end_.output.size() - kept);
    return true;
  };
  while (!reap(false)) {
    if (std::chrono::duration<double>(Clock::now() - start).count() > seconds) {
      stop();
      reap(true);
      end_.code = -1;
      end_.trouble = fmt::format("took longer than {:g} s and was stopped", seconds);
      break;
    }
    if (output_ < 0) std::this_thread::sleep_for(kLook);
    read_available(static_cast<int>(kLook.count()));
  }
  while (read_available(0)) {
  }
  // Descendants of the program could keep its output open for ever.
  if (own_group_ && !guarded_ && group > 0) kill(-group, SIGKILL);
  close_descriptor(output_);
  return end_;
}

ProgramEnd run_program(const std::vector<std::string>& words, const ProgramOptions& options) {
  return Program(words, options).wait();
}

void die_with_parent(int& argc, char**& argv) {
  if (argc < 4 || argv[1] != kTied) return;
#ifdef __linux__
  if (argv[3] == kGuard) guard(argv + 4, std::atoi(argv[2]));
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != std::atoi(argv[2])) _exit(EXIT_FAILURE);  // the parent ended before prctl()
#endif
  argv[2] = argv[0];
  argv += 2;
  argc -= 2;
  if (argv[1] != kStart) return;
  execvp(argv[2], argv + 2);
  _exit(kNotStarted);
}

}  // namespace slipstick::convergence
