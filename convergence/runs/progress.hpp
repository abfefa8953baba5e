#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace slipstick::convergence {

/// A part of a command, and its share of the time of the whole command, in any unit.
struct Stage {
  std::string name;
  double share = 1.0;
  std::string scene = {};  ///< of several; empty: there is one
};

/// Progress on standard error, with an estimate for all stages: "2 of 4: equivalent scenes, [3/120] ellipse,
/// about 40 s left". On a terminal one line, rewritten; elsewhere a line for each stage and one every ten
/// seconds. Without stages there is no "2 of 4", and each group of runs has an estimate of its own.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;

  Progress() = default;
  explicit Progress(std::vector<Stage> stages) : stages_(std::move(stages)) {}

  /// The next stage of this name begins; a name that no later stage has changes nothing, so that a part of a
  /// command may be a stage of one command and belong to a larger stage of another.
  void begin(const std::string& stage, Clock::time_point now = Clock::now());
  /// A group of runs begins. weight: their work, in any unit; asked: their number together
  /// with the runs whose results were kept.
  void begin_runs(std::size_t runs, double weight, std::size_t asked, Clock::time_point now = Clock::now());
  /// A run is done; weight: its work, in the same unit.
  void finished(const std::string& label, double weight, Clock::time_point now = Clock::now());
  /// No more is printed on this line.
  void end();

  /// "3 of 12", of the group of runs.
  std::string text() const;
  /// Seconds that all stages still need; NaN where nothing is known yet.
  double seconds_left(Clock::time_point now = Clock::now()) const;

 private:
  void print(std::string text, bool last, Clock::time_point now);

  std::vector<Stage> stages_;
  std::size_t next_ = 0;  ///< stage after the current one; 0: none has begun
  double done_share_ = 0.0;
  double done_seconds_ = 0.0;  ///< of the stages in done_share_
  Clock::time_point stage_start_ = Clock::now();
  std::size_t stage_asked_ = 0;
  std::size_t stage_runs_ = 0;

  std::size_t runs_ = 0;
  std::size_t runs_done_ = 0;
  double left_ = 0.0;
  double spent_ = 0.0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point said_ = start_;
  bool line_is_open_ = false;
};

/// "40 s", "3 min"; "" for less than half a second and for NaN.
std::string duration_text(double seconds);

}  // namespace slipstick::convergence
