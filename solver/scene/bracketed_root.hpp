#pragma once

#include <functional>

namespace slipstick::solver {

/// The root of f in [low, high], to the last digits, by Brent's method (GSL). f must change sign there, or be
/// zero at an end; throws std::domain_error otherwise.
double bracketed_root(const std::function<double(double)>& f, double low, double high);

}  // namespace slipstick::solver
