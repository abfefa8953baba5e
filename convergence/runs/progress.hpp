#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace slipstick::convergence {

/// Progress on standard error: on a terminal one line, rewritten; elsewhere a line every ten seconds.
class Progress {
 public:
  /// weight: total work, in any unit.
  Progress(std::size_t parts, double weight) : total_(parts), left_(weight) {}

  /// A part is done; weight: its work, in the same unit.
  void finished(const std::string& label, double weight);

  /// "3 of 12".
  std::string text() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::size_t total_;
  std::size_t done_ = 0;
  double left_;
  double spent_ = 0.0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point said_ = start_;
};

}  // namespace slipstick::convergence
