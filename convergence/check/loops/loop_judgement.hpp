#pragma once

#include <limits>
#include <string>
#include <vector>

#include "convergence/check/loops/loop_laws.hpp"
#include "convergence/check/loops/loop_path.hpp"

namespace slipstick::convergence {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A number of the loop beside the exact law's at the same rotations; NaN where the loop does not say.
struct LoopNumber {
  double value;
  double exact;
};

/// What a loop under one normal load shows, in the contact's units.
struct LoopJudgement {
  bool good = false;
  std::string why;          ///< one sentence
  std::string law;          ///< the name of the one that explains it; empty: none that was tried
  double residual = 0.0;    ///< of the exact law
  double noise = 0.0;       ///< of the moments from row to row, over the largest
  double slip_error = 0.0;  ///< how far what slip takes off the moment is from the exact law's, over that
  double slip_noise = 0.0;  ///< standard deviation of that, from the noise
  LoopHypothesis exact;     ///< the exact law as the record starts
  LoopNumber stiffness{kUnknown, kUnknown};     ///< dm/dt over the first third of the largest moment
  LoopNumber largest_load{kUnknown, kUnknown};  ///< m
  std::vector<LoopNumber> areas;                ///< of closed loops
  std::vector<LoopHypothesis> fitted;           ///< of a bad one

  /// Whether slip shows above the noise: then stiffness and limit, or shape, are seen.
  bool shows_slip() const;
};

/// The residual that a good loop may have, unless the user says otherwise.
inline constexpr double kLoopTolerance = 0.01;

/// Holds a loop to the exact law.
LoopJudgement judge_loop(const LoopPath& path, const LoopContact& contact, double tolerance);

/// Says which law a bad loop follows.
void explain(LoopJudgement& judgement, const LoopPath& path, const LoopContact& contact, double tolerance);

}  // namespace slipstick::convergence
