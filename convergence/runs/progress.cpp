#include "convergence/runs/progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "convergence/results/output.hpp"

namespace slipstick::convergence {
namespace {

double seconds_between(Progress::Clock::time_point start, Progress::Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

}  // namespace

std::string duration_text(double seconds) {
  constexpr double kInSeconds = 99.5;
  if (!(seconds >= 0.5)) return "";
  return seconds < kInSeconds ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} min", seconds / 60.0);
}

void Progress::begin(const std::string& stage, Clock::time_point now) {
  const auto from = stages_.begin() + static_cast<std::ptrdiff_t>(next_);
  const auto found = std::find_if(from, stages_.end(), [&](const Stage& each) { return each.name == stage; });
  if (found == stages_.end()) return;
  const bool was_kept = stage_asked_ > 0 && stage_runs_ == 0;
  if (next_ > 0 && !was_kept) {  // finished runs that were kept take no time
    const double part = stage_asked_ > 0 ? static_cast<double>(stage_runs_) / static_cast<double>(stage_asked_) : 1.0;
    done_share_ += part * stages_[next_ - 1].share;
    done_seconds_ += seconds_between(stage_start_, now);
  }
  next_ = static_cast<std::size_t>(found - stages_.begin()) + 1;
  stage_start_ = now;
  stage_asked_ = stage_runs_ = runs_ = runs_done_ = 0;
  spent_ = left_ = 0.0;
  said_ = {};
  print("", false, now);
}

void Progress::begin_runs(std::size_t runs, double weight, std::size_t asked, Clock::time_point now) {
  stage_asked_ += asked;
  stage_runs_ += runs;
  runs_ = runs;
  runs_done_ = 0;
  left_ = weight;
  spent_ = 0.0;
  start_ = now;
  if (stages_.empty()) said_ = now;
}

void Progress::finished(const std::string& label, double weight, Clock::time_point now) {
  ++runs_done_;
  left_ -= weight;
  spent_ += weight;
  print(fmt::format("[{}/{}] {}", runs_done_, runs_, plain_text(label)), runs_done_ == runs_, now);
}

double Progress::seconds_left(Clock::time_point now) const {
  const double runs_left = spent_ > 0.0 ? seconds_between(start_, now) / spent_ * std::max(left_, 0.0)
                           : runs_ > 0  ? std::nan("")
                                        : 0.0;
  if (next_ == 0) return runs_left;
  const double in_stage = seconds_between(stage_start_, now);
  double later = 0.0;
  for (std::size_t i = next_; i < stages_.size(); ++i) later += stages_[i].share;
  const double share = stages_[next_ - 1].share;
  if (done_share_ > 0.0) {
    const double speed = done_seconds_ / done_share_;
    const double by_share = std::max(speed * share - in_stage, 0.0);
    // The first runs of a group say little about the others.
    const double known = spent_ > 0.0 ? spent_ / (spent_ + std::max(left_, 0.0)) : 0.0;
    const double in_this = known > 0.0 ? known * runs_left + (1.0 - known) * by_share : by_share;
    return in_this + speed * later;
  }
  if (runs_ == 0) return std::nan("");
  return runs_left + (in_stage + runs_left) / share * later;
}

void Progress::print(std::string text, bool last, Clock::time_point now) {
  constexpr std::chrono::seconds kSilence(10);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const bool ends_line = last && stages_.empty();
  if (!terminal && !ends_line && now - said_ < kSilence) return;
  said_ = now;
  if (next_ > 0) {
    const Stage& stage = stages_[next_ - 1];
    text = fmt::format("{} of {}: {}{}{}{}{}", next_, stages_.size(), plain_text(stage.scene),
                       stage.scene.empty() ? "" : ": ", stage.name, text.empty() ? "" : ", ", text);
  }
  const std::string left = duration_text(seconds_left(now));
  if (!left.empty()) text += fmt::format(", about {} left", left);
  line_is_open_ = terminal && !ends_line;
  std::cerr << (terminal ? "\r\033[K" : "") << text << (line_is_open_ ? "" : "\n") << std::flush;
}

void Progress::end() {
  if (line_is_open_) std::cerr << '\n';
  line_is_open_ = false;
}

std::string Progress::text() const { return fmt::format("{} of {}", runs_done_, runs_); }

}  // namespace slipstick::convergence
