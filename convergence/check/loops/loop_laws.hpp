#pragma once

#include <vector>

#include "convergence/check/loops/loop_contact.hpp"
#include "convergence/check/loops/loop_fit.hpp"

namespace slipstick::convergence {

/// The exact law, from the one of these starts that brings it closest to the loop.
LoopHypothesis fit_exact_law(const LoopPath& path, const LoopContact& contact,
                             const std::vector<LoopStart>& starts);

/// The laws that simulators use instead of the exact one, each with its best parameters.
std::vector<LoopHypothesis> fit_wrong_laws(const LoopPath& path, const LoopContact& contact);

}  // namespace slipstick::convergence
