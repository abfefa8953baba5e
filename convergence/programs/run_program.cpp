#include "convergence/programs/run_program.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "convergence/results/output.hpp"

#ifdef __linux__
#include <sys/prctl.h>
#endif

extern char** environ;

namespace slipstick::convergence {
namespace {

/// The exit code of a program that could not be started, as shells have it.
constexpr int kNotStarted = 127;
/// Before the number of the parent that a tied program must not outlive.
constexpr std::string_view kTied = "--tied-to";
/// Before the words of another program.
constexpr std::string_view kStart = "start";

std::vector<std::string> tied(const std::vector<std::string>& words, const std::string& program) {
  if (program.empty()) return words;
  std::vector<std::string> all{program, std::string(kTied), std::to_string(getpid())};
  const bool itself = words.front() == program;
  if (!itself) all.emplace_back(kStart);
  all.insert(all.end(), words.begin() + (itself ? 1 : 0), words.end());
  return all;
}

/// Empty: none.
std::string trouble_of(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return fmt::format("was killed by signal {}{}", signal,
                       signal == SIGKILL ? ", as where memory runs out" : "");
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
  std::vector<std::string> all = tied(words, options.tied_by);
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
  const int error = posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close_descriptor(ends[1]);
  close_descriptor(feed[1]);
  if (error == 0) return;
  process_ = -1;
  end_ = not_started(error);
}

Program::~Program() {
  if (process_ > 0) kill(process_, SIGKILL);
  close_descriptor(output_);
  wait();
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

ProgramEnd Program::wait() {
  end_feed();
  while (!read_on()) {
  }
  if (process_ <= 0) return end_;
  int status = 0;
  pid_t found = 0;
  do found = waitpid(process_, &status, 0);
  while (found < 0 && errno == EINTR);
  process_ = -1;
  if (found < 0) {
    end_.trouble = "ended, and nobody says how";
  } else if (WIFEXITED(status) && WEXITSTATUS(status) == kNotStarted) {
    end_ = not_started(ENOENT);
  } else {
    end_.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    end_.trouble = trouble_of(status);
  }
  return end_;
}

ProgramEnd run_program(const std::vector<std::string>& words, const ProgramOptions& options) {
  return Program(words, options).wait();
}

void obey_tie(int& argc, char**& argv) {
  if (argc < 4 || argv[1] != kTied) return;
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != std::atoi(argv[2])) _exit(EXIT_FAILURE);  // it was gone before that
#endif
  argv[2] = argv[0];
  argv += 2;
  argc -= 2;
  if (argv[1] != kStart) return;
  execvp(argv[2], argv + 2);
  _exit(kNotStarted);
}

}  // namespace slipstick::convergence
