#pragma once

#include <array>
#include <memory>
#include <string>

#include "convergence/oracle/oracle.hpp"

/// The exact theories; exact_history() knows for which scenes each holds.
namespace slipstick::convergence {

/// The factor of a body's tangential displacement by pressure, (1 - 2 nu)/(2 G), in 1/Pa.
double mismatch(const solver::Material& material);

/// Torsion under a constant normal load: first loading, then Masing's rule. Under any law of friction that
/// find_friction_bound() knows. Throws std::domain_error where a coated scene has no such contact.
std::unique_ptr<ExactHistory> torsion_history(const solver::Scene& scene);

/// A tangential force along one line (a unit vector), under any normal loads, on a gap like r^n.
std::unique_ptr<ExactHistory> force_history(const solver::Scene& scene, double gap_exponent,
                                            const std::array<double, 2>& direction);

/// Dissimilar bodies pressed together, more and more. Throws what Goodman's and Spence's solutions throw.
std::unique_ptr<ExactHistory> frictional_indentation(const solver::Scene& scene);

/// Normal contact and limit moment of an ellipsoid, under any loads.
std::unique_ptr<ExactHistory> pressed_ellipse(const solver::Scene& scene);

/// No answer, for this reason.
std::unique_ptr<ExactHistory> no_theory(const std::string& reason);

}  // namespace slipstick::convergence
