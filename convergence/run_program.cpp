#include "convergence/run_program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace slipstick::convergence {
namespace {

/// Where a new program's output goes.
class Redirection {
 public:
  Redirection() { posix_spawn_file_actions_init(&actions_); }
  void send(int descriptor, const std::filesystem::path& file) {
    if (file.empty()) return;
    posix_spawn_file_actions_addopen(&actions_, descriptor, file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  }
  ~Redirection() { posix_spawn_file_actions_destroy(&actions_); }
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;

  const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

int run_program(const std::vector<std::string>& words, const std::filesystem::path& output,
                const std::filesystem::path& complaints) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  Redirection redirection;
  redirection.send(STDOUT_FILENO, output);
  redirection.send(STDERR_FILENO, complaints);
  pid_t child = 0;
  if (posix_spawnp(&child, arguments[0], redirection.actions(), nullptr, arguments.data(), environ) != 0) {
    return -1;
  }
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace slipstick::convergence
