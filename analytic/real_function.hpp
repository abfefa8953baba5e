#pragma once

#include <functional>

namespace slipstick::analytic {

/// A real function of one real variable.
using RealFunction = std::function<double(double)>;

}  // namespace slipstick::analytic
