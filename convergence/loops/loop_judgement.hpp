#pragma once

#include <string>
#include <vector>

#include "convergence/loops/loop_laws.hpp"
#include "convergence/loops/loop_path.hpp"

namespace slipstick::convergence {

/// A number of the loop beside the exact law's at the same rotations; NaN where the loop does not say.
struct LoopNumber {
  double value;
  double exact;
};

/// What a loop under one normal load shows, in the contact's units.
struct LoopJudgement {
  bool good;
  std::string why;                ///< one sentence
  std::string law;                ///< the name of the one that explains it; empty: none that was tried
  double residual;                ///< of the exact law
  LoopNumber stiffness;           ///< dm/dt over the first third of the largest moment
  LoopNumber largest_load;        ///< m
  LoopNumber presliding;          ///< t at half of the limit, on first loading
  LoopNumber recovered;           ///< part of the rotation that the first unloading to no moment gives back
  std::vector<LoopNumber> areas;  ///< of closed loops
  double masing_error;            ///< of the first branch back from the loop's own first loading, enlarged
  std::vector<LoopHypothesis> fitted;  ///< of a bad one
};

/// The residual that a good loop may have, unless the user says otherwise.
inline constexpr double kLoopTolerance = 0.01;

LoopJudgement judge_loop(const LoopPath& path, const LoopContact& contact, double tolerance);

}  // namespace slipstick::convergence
