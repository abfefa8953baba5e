#pragma once

#include <string>
#include <vector>

#include "convergence/loops/loop_contact.hpp"
#include "convergence/loops/loop_path.hpp"

namespace slipstick::convergence {

/// A law fitted to a loop, and where it lets the record start.
struct LoopHypothesis {
  std::string name;                ///< one word
  std::vector<double> parameters;  ///< over the exact ones
  double residual = 0.0;  ///< root of the mean square distance from the loop, over its largest moment
  std::string sentence;   ///< what it is in physical terms
  double cost = 0.0;      ///< what the likeliest one has least of
  LoopStart start;
  double offset = 0.0;         ///< of the record's moments
  std::vector<double> moment;  ///< in each row, with the offset
};

/// The exact law, from the start that brings it closest to the loop: from rest, where a record that begins at
/// zero has no reversal.
LoopHypothesis fit_exact_law(const LoopPath& path, const LoopContact& contact);

/// The laws that simulators have in its place, each as close as its parameters let it come.
std::vector<LoopHypothesis> fit_wrong_laws(const LoopPath& path, const LoopContact& contact);

}  // namespace slipstick::convergence
