#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/scene/surface.hpp"

namespace slipstick::convergence {

/// An indenter's shape in terms of the exact theories.
struct ExactShape {
  std::string profile;                 ///< as analytic::press() takes it
  std::vector<double> numbers;         ///< of the profile, SI units
  std::optional<double> gap_exponent;  ///< n of a gap like r^n; none where contacts are not similar
};

/// None where the contact is not axisymmetric, or no theory gives it.
std::optional<ExactShape> exact_shape(const solver::Surface& surface);

/// An ellipsoid with two different radii.
bool is_elliptic(const solver::Surface& surface);

}  // namespace slipstick::convergence
