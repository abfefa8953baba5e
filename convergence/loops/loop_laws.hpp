#pragma once

#include <string>
#include <vector>

#include "convergence/loops/loop_contact.hpp"
#include "convergence/loops/loop_path.hpp"

namespace slipstick::convergence {

/// A law that simulators have, fitted to a loop.
struct LoopHypothesis {
  std::string name;                ///< one word
  std::vector<double> parameters;  ///< over the exact ones
  double residual;       ///< root of the mean square distance from the loop, over its largest moment
  std::string sentence;  ///< what it is in physical terms
};

/// The distance of a law's moments from the loop's, as residual has it; a few rows that lie farthest off, as
/// just after a jump, do not count.
double residual(const LoopPath& path, const std::vector<double>& moment);

/// The exact law first, then the laws that simulators have in its place, each as close as its parameters let
/// it come.
std::vector<LoopHypothesis> fit_loop_laws(const LoopPath& path, const LoopContact& contact);

/// The one that explains the loop: the closest, where each parameter has to pay for itself.
const LoopHypothesis& most_likely(const std::vector<LoopHypothesis>& fitted);

}  // namespace slipstick::convergence
