#include "solver/input/run_apart.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <system_error>

#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace slipstick::solver {
namespace {

/// Reading the largest file takes a few seconds.
constexpr rlim_t kSeconds = 10;
/// Beside what the process has when it starts: the largest dataset, and what a library keeps of its file.
constexpr rlim_t kBytes = rlim_t{2} << 30;

/// Address space of this process.
rlim_t bytes_held() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGE_SIZE));
}

void limit(decltype(RLIMIT_AS) resource, rlim_t most) {
  rlimit now{};
  getrlimit(resource, &now);
  now.rlim_cur = std::min(now.rlim_max, most);
  setrlimit(resource, &now);
}

void send_all(int descriptor, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t sent = write(descriptor, bytes, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) throw std::runtime_error("nobody reads");
    bytes += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

/// What the new process does. It leaves without the old one's clean-up: buffers and handlers are not its own.
[[noreturn]] void be_apart(const std::function<void(const Send&)>& work, int to) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // whoever waits for this may be killed
#endif
  for (const int deadly : {SIGSEGV, SIGBUS, SIGABRT, SIGXCPU, SIGPIPE}) std::signal(deadly, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, kSeconds);
  limit(RLIMIT_AS, bytes_held() + kBytes);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDERR_FILENO);
  try {
    work([to](const void* bytes, std::size_t size) { send_all(to, static_cast<const char*>(bytes), size); });
  } catch (const std::exception&) {  // what was sent is not all: the caller sees that
  }
  _exit(0);
}

std::string receive(int from, std::size_t largest) {
  std::string bytes;
  std::array<char, 1 << 16> buffer;
  while (bytes.size() < largest) {
    const ssize_t size = read(from, buffer.data(), std::min(buffer.size(), largest - bytes.size()));
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    bytes.append(buffer.data(), static_cast<std::size_t>(size));
  }
  return bytes;
}

}  // namespace

std::string run_apart(const std::function<void(const Send&)>& work, std::size_t largest) {
  std::array<int, 2> ends{};
  const auto fail = [] {
    throw std::system_error(errno, std::generic_category(), "no process to read with");
  };
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail();
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    be_apart(work, ends[1]);
  }
  const int error = errno;
  close(ends[1]);
  std::string bytes = child > 0 ? receive(ends[0], largest) : "";
  close(ends[0]);
  errno = error;
  if (child < 0) fail();
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  return bytes;
}

}  // namespace slipstick::solver
