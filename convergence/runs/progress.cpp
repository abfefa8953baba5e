#include "convergence/runs/progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "convergence/results/output.hpp"

namespace slipstick::convergence {

void Progress::finished(const std::string& label, double weight) {
  ++done_;
  left_ -= weight;
  spent_ += weight;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const auto now = Clock::now();
  const bool last = done_ == total_;
  if (!terminal && !last && now - said_ < std::chrono::seconds(10)) return;
  said_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  std::cerr << fmt::format("{}[{}/{}] {}, about {:.0f} s left{}", terminal ? "\r\033[K" : "", done_, total_,
                           plain_text(label), spent_ > 0.0 ? seconds / spent_ * std::max(left_, 0.0) : 0.0,
                           terminal && !last ? "" : "\n");
}

std::string Progress::text() const { return fmt::format("{} of {}", done_, total_); }

}  // namespace slipstick::convergence
