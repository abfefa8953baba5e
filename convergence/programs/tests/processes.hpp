#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>
#include <vector>

#include "solver/input/tests/scratch_folder.hpp"

namespace slipstick {

/// In the environment of each process that is to be found again, with a value that no other test has.
inline constexpr const char* kMarker = "SLIPSTICK_TEST_MARKER";

/// The processes that run with the marker at this value; none where the system does not show them.
inline std::vector<pid_t> marked_processes(const std::string& value) {
  std::vector<pid_t> found;
  std::error_code error;
  const std::string assignment = std::string(kMarker) + "=" + value + '\0';
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
    const pid_t process = std::atoi(entry.path().filename().c_str());
    if (process <= 0) continue;
    // The file is empty for a process that has ended and is not yet waited for.
    if (file_text(entry.path() / "environ").find(assignment) != std::string::npos) found.push_back(process);
  }
  return found;
}

/// Whether something comes true within two minutes, longer than it takes on any machine.
template <typename Condition>
bool comes_true(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

}  // namespace slipstick
