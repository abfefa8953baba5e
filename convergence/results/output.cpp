#include "convergence/results/output.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace {

/// Calls, and names the option in front of what is said of the path.
template <typename Call>
void naming(const std::string& option, const std::string& path, const Call& call) {
  try {
    call();
  } catch (const solver::InputError& error) {
    const std::string complaint = error.what();
    throw solver::InputError(fmt::format("{} {}", option, path), complaint.substr(path.size() + 2));
  }
}

}  // namespace

void require_output(const std::string& option, const std::string& path) {
  if (!path.empty()) naming(option, path, [&] { solver::require_place_for(path); });
}

void write_option_file(const std::string& option, const std::string& path, const std::string& text) {
  if (path.empty()) return;
  naming(option, path, [&] { solver::write_whole_file(path, text); });
}

void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);  // gets the lowest number that is free
  }
}

void write_standard_output(std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() &&
                       std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (!written) throw solver::InputError("standard output", solver::why_not_written(errno));
}

}  // namespace slipstick::convergence
