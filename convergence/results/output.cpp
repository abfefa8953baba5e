#include "convergence/results/output.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <new>
#include <system_error>

#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace {

/// Calls; an InputError about the path gets the name of the option in front.
template <typename Call>
void naming(const std::string& option, const std::string& path, const Call& call) {
  try {
    call();
  } catch (const solver::InputError& error) {
    const std::string complaint = error.what();
    const std::string_view named = solver::InputError(path, "").what();
    throw solver::InputError(fmt::format("{} {}", option, path), complaint.substr(named.size()));
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

void append_option_file(const std::string& option, const std::string& path, const std::string& text) {
  std::string all;
  naming(option, path, [&] {
    if (std::filesystem::is_regular_file(path))
      all = solver::read_input_file(path, solver::kLargestJson, "a text file");
  });
  if (!all.empty() && !all.ends_with('\n')) all += '\n';
  write_option_file(option, path, all + text);
}

std::string plain_text(std::string_view text) {
  const std::string printable = solver::printable(text);
  const std::string_view all = printable;
  std::string plain;
  bool line_begins = true;  // a server may skip any blank, and Unicode has many
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string_view rest = all.substr(i);
    const bool commands = (line_begins && rest.starts_with("::")) || rest.starts_with("##[") ||
                          rest.starts_with("##vso[") || rest.starts_with("##teamcity[");
    plain += commands ? fmt::format("\\x{:02x}", all[i]) : std::string(1, all[i]);
    const bool blank = all[i] == ' ' || all[i] == '\t' || static_cast<unsigned char>(all[i]) >= 0x80;
    line_begins = all[i] == '\n' || (line_begins && blank);
  }
  return plain;
}

std::string failure_text(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return "memory ran out; allowed: fewer cells or side-by-side solves (--jobs), or more memory (ulimit "
           "-v); --memory-limit refuses in time what is too large";
  }
  const auto* const failure = dynamic_cast<const std::system_error*>(&error);
  if (failure != nullptr && failure->code() == std::errc::resource_unavailable_try_again) {
    return "no more threads or processes can be started; allowed: fewer of them (solver.threads, --jobs), or "
           "a higher limit (ulimit -u, ulimit -v)";
  }
  return error.what();
}

void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);  // gets the lowest number that is free
  }
}

void write_standard_output(std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0 &&
                       std::ferror(stdout) == 0;
  if (!written) throw solver::InputError("standard output", solver::why_not_written(errno));
}

}  // namespace slipstick::convergence
