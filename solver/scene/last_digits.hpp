#pragma once

#include "solver/scene/scene.hpp"

/// What of a scene is no more than the last digits of its numbers. It would cost a model its symmetries, and
/// a scene its exact answer, and change neither: here alone is decided what is left out for that.
namespace slipstick::solver {

/// Numbers enter a model rounded to so much of themselves (to_dimensionless): less is none.
inline constexpr double kLastDigits = 1e-12;

/// Whether a pressure moves both surfaces alike along themselves: Dundurs' beta is 0.
bool are_alike(const Material& upper, const Material& lower);

/// Without positions that are nothing over the contact, a difference of radii over themselves, and forces
/// over the torsion; notes them in Scene::left_out. model = "full" keeps all. Of a valid scene; read_scene()
/// calls it.
Scene without_last_digits(Scene scene);

}  // namespace slipstick::solver
