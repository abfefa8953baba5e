#pragma once

#include <functional>

namespace slipstick::solver {

/// Called once per iteration: operator applications (or iterations) so far, and the relative gap (the
/// relative change of the tractions in fixed-point methods). An empty one is never called.
using Progress = std::function<void(long count, double error)>;

}  // namespace slipstick::solver
