#include "convergence/programs/run_program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "convergence/programs/child_process.hpp"

namespace slipstick::convergence {
namespace {

/// Whether what is written on a descriptor now goes to the file; empty: where it went before.
bool redirect(int descriptor, const std::filesystem::path& file) {
  if (file.empty()) return true;
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  return opened >= 0 && dup2(opened, descriptor) >= 0;
}

}  // namespace

pid_t start_program(const std::vector<std::string>& words, const std::filesystem::path& output,
                    const std::filesystem::path& complaints) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = fork_child();
  if (child > 0) return child;
  if (redirect(STDOUT_FILENO, output) && redirect(STDERR_FILENO, complaints)) {
    execvp(arguments[0], arguments.data());
  }
  _exit(kNotStarted);
}

int run_program(const std::vector<std::string>& words, const std::filesystem::path& output,
                const std::filesystem::path& complaints) {
  const int status = wait_for_child(start_program(words, output, complaints));
  return WIFEXITED(status) && WEXITSTATUS(status) != kNotStarted ? WEXITSTATUS(status) : -1;
}

}  // namespace slipstick::convergence
