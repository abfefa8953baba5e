#pragma once

#include <vector>

#include "convergence/check/loops/loop_contact.hpp"
#include "convergence/check/loops/loop_fit.hpp"

namespace slipstick::convergence {

/// The exact law, from the start that brings it closest to the loop.
LoopHypothesis fit_exact_law(const LoopPath& path, const LoopContact& contact,
                             const std::vector<LoopStart>& starts);

/// The laws that simulators have in its place, each as close as its parameters let it come.
std::vector<LoopHypothesis> fit_wrong_laws(const LoopPath& path, const LoopContact& contact);

}  // namespace slipstick::convergence
