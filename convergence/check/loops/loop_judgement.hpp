#pragma once

#include <limits>
#include <string>
#include <vector>

#include "convergence/check/loops/loop_fit.hpp"
#include "convergence/check/loops/loop_path.hpp"

namespace slipstick::convergence {

/// A number of the loop and of the exact law at the same rotations; NaN where the loop does not show it.
struct LoopNumber {
  double value = std::numeric_limits<double>::quiet_NaN();
  double exact = std::numeric_limits<double>::quiet_NaN();
};

/// The judgement of a loop under one normal load, in the contact's units.
struct LoopJudgement {
  bool good = false;
  std::string why;                ///< one sentence
  std::string law;                ///< the name of the law that explains the loop; empty: none that was tried
  double residual = 0.0;          ///< of the exact law
  double noise = 0.0;             ///< of the moments from row to row, over the largest
  double slip_error = 0.0;        ///< relative error of the moment that slip takes off
  double slip_noise = 0.0;        ///< standard deviation of that error, from the noise
  LoopHypothesis exact;           ///< the exact law from the record's start
  LoopNumber stiffness;           ///< dm/dt over the first third of the largest moment
  LoopNumber largest_load;        ///< m
  std::vector<LoopNumber> areas;  ///< of closed loops
  std::vector<LoopHypothesis> fitted;  ///< wrong laws, if the loop is bad

  /// Whether slip shows above the noise, and with it the energy that is lost.
  bool shows_slip() const;
};

/// Largest residual of a good loop, over the largest load, unless the user says otherwise.
inline constexpr double kLoopTolerance = 0.01;

/// Compares a loop with the exact law.
LoopJudgement judge_loop(const LoopPath& path, const LoopContact& contact, double tolerance);

/// Finds the wrong law that a bad loop follows.
void explain(LoopJudgement& judgement, const LoopPath& path, const LoopContact& contact, double tolerance);

}  // namespace slipstick::convergence
