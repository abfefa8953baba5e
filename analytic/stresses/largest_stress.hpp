#pragma once

#include "analytic/stresses/stress_field.hpp"

namespace slipstick::analytic {

/// A largest stress in the body, over p0, and where it is.
struct LargestStress {
  double value;
  BodyPoint at;
};

/// Searches the largest von Mises, Tresca or tensile stress at r < 1.25 a, z < a. The value is good to 1e-12,
/// the place to 1e-6. stick_ratio: a radius at which the tractions have a kink, where the search starts too.
/// Throws std::domain_error where a stress is infinite: the pressure must be finite and end at zero.
LargestStress largest_stress(const StressField& field, double Severity::*measure, double friction, double poisson,
                             double stick_ratio);

}  // namespace slipstick::analytic
