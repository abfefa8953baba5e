#pragma once

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

/// Curves of the exact solution. For the sphere: `curve` (stick radius and twist against moment),
/// `equation_5_digits`, `approximations` (errors of laws in use), `approximation_table`, `loop` (a history
/// with an inner loop), `cycle_energy`; for sphere, cone and flat punch: `bodies`.
Json exact_curves();

}  // namespace slipstick::convergence
