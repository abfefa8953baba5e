#pragma once

#include <string>

#include "analytic/layered/layered_contact.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// The material that is touched: that of the body's layer where it has one.
solver::Material surface_material(const solver::Material& body);

/// Why a coated scene has no exact contact, or one that torsion alone does not describe; empty if it may
/// have.
std::string coated_obstacle(const solver::Scene& scene);

/// The contact of a sphere or flat punch where a body is coated, under a load in N. Throws what
/// analytic::layered::press() throws.
analytic::layered::LayeredContact press_coated(const solver::Scene& scene, double load);

}  // namespace slipstick::convergence
