#pragma once

#include <vector>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

/// The errors in the paper's equations as printed, with numbers as evidence: computed here, or taken from
/// results of the paper's method on a circular contact and on elliptic ones. {equation, printed, holds,
/// shown}.
Json errata(const Json& circle, const std::vector<Json>& ellipses);

}  // namespace slipstick::convergence
