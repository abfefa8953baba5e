#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace slipstick::convergence {

/// Says on standard error how far work is: one line on a terminal, rewritten; elsewhere a line now and then.
/// Where nobody can read it, nothing.
class Progress {
 public:
  /// weight: of all the work together, in the unit in which its parts are given.
  Progress(std::size_t parts, double weight) : total_(parts), left_(weight) {}

  /// A part of so much weight is done.
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
