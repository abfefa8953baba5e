#pragma once

#include "solver/scene/scene.hpp"

/// Decides which differences in a scene are rounding of its numbers. They would cost a model its symmetries
/// and a scene its exact answer, and change no digit that counts.
namespace slipstick::solver {

/// Relative size of a difference that is rounding: numbers enter a model rounded to 40 bits (to_dimensionless).
inline constexpr double kLastDigits = 1e-12;

/// Whether a pressure moves both surfaces alike along themselves: Dundurs' beta is 0.
bool are_alike(const Material& upper, const Material& lower);

/// Without positions that are nothing over the contact, a difference of radii over themselves, and forces over the
/// torsion; notes them in Scene::left_out. model = "full" keeps all. The scene must be valid; read_scene() calls this.
Scene without_last_digits(Scene scene);

}  // namespace slipstick::solver
