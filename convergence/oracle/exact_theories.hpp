#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analytic/axisymmetric.hpp"
#include "analytic/layered/layered_contact.hpp"
#include "convergence/oracle/oracle.hpp"
#include "solver/scene/friction_law.hpp"
#include "solver/scene/scene.hpp"
#include "solver/scene/surface.hpp"

/// The exact theories; exact_history() knows for which scenes each holds.
namespace slipstick::convergence {

/// The factor of a body's tangential displacement by pressure, (1 - 2 nu)/(2 G), in 1/Pa.
double mismatch(const solver::Material& material);

/// Torsion under a constant normal load: first loading, then Masing's rule. Under any law of friction that
/// find_friction_bound() knows. Throws std::domain_error where a coated scene has no such contact.
ExactTheory torsion_history(const solver::Scene& scene);

/// A tangential force along one line (a unit vector), under any normal loads, on a gap like r^n.
ExactTheory force_history(const solver::Scene& scene, double gap_exponent, const std::array<double, 2>& direction);

/// Dissimilar bodies pressed together, more and more. Throws what Goodman's and Spence's solutions throw.
ExactTheory frictional_indentation(const solver::Scene& scene);

/// Normal contact and limit moment of an ellipsoid, under any loads.
ExactTheory pressed_ellipse(const solver::Scene& scene);

/// No answer, for this reason.
ExactTheory no_theory(const std::string& reason);

// ---------------------------------------------------------------- what scenes have in terms of the theories
// (exact_contacts.cpp)

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

/// The friction bound of an axisymmetric contact: reference * profile.pressure(r/a).
struct FrictionBound {
  std::shared_ptr<const analytic::Profile> profile;
  double reference;  ///< Pa
};

/// The friction bound of a law under a pressure, reference_pressure (Pa) times pressure.pressure(r/a). Coulomb's law
/// and Tresca's under every pressure, the others under Hertz's. None where it has no exact form here.
std::optional<FrictionBound> find_friction_bound(const solver::FrictionLaw& law,
                                                 std::shared_ptr<const analytic::Profile> pressure,
                                                 double reference_pressure);

/// The material at the surface: the layer's, where the body has one.
solver::Material surface_material(const solver::Material& body);

/// Why a coated scene has no exact contact, or one that needs more than torsion; empty if it may have one.
std::string coated_obstacle(const solver::Scene& scene);

/// The contact of a sphere or flat punch where a body is coated, under a load in N. Throws what
/// analytic::layered::press() throws.
analytic::layered::LayeredContact press_coated(const solver::Scene& scene, double load);

}  // namespace slipstick::convergence
