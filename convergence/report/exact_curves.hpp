#pragma once

#include <vector>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

/// Curves of the exact solution. For the sphere: `curve` (stick radius and twist against moment), `equation_5_digits`,
/// `approximations` (errors of laws in use), `approximation_table`, `loop` (a history with an inner loop),
/// `cycle_energy`, `first_yield` (where it yields); for sphere, cone and flat punch: `bodies`.
Json exact_curves();

/// The errors in the paper's equations as printed, with numbers as evidence: computed here, or taken from results of
/// the paper's method on a circular contact and on elliptic ones. {equation, printed, holds, shown}.
Json errata(const Json& circle, const std::vector<Json>& ellipses);

}  // namespace slipstick::convergence
