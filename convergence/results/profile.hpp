#pragma once

#include "convergence/oracle/oracle.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/solution.hpp"

namespace slipstick::convergence {

/// Traction over mu p0 in the contact's cells beside the positive x1 axis and along the diagonal, as rows of
/// {radius (r/a), value, exact, error}; none where the exact tractions are not known.
Json profile_json(const solver::Solution& solution, const OracleAnswer& exact);

}  // namespace slipstick::convergence
