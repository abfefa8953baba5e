#pragma once

#include <array>
#include <string>

#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// The same contact seen otherwise: in a mirror (x2 to -x2), turned by a quarter (x1 to x2), on other cells
/// of a larger grid, in other units (lengths in mm), from the other body's side, on two threads.
enum class Variant { none, mirrored, turned, shifted, in_other_units, exchanged, two_threads };

inline constexpr std::array kVariants{Variant::mirrored,       Variant::turned,    Variant::shifted,
                                      Variant::in_other_units, Variant::exchanged, Variant::two_threads};

std::string to_string(Variant variant);

/// Throws std::invalid_argument for a word that to_string() does not give.
Variant variant_of(const std::string& word);

/// Why a scene cannot be seen so; empty: it can. What comes from files or a random generator is not turned,
/// and a moment about the grid's origin is another one once forces act off it.
std::string why_not(const solver::Scene& scene, Variant variant);

/// The scene as it is seen. Shifted: by two cells along x1 and one against x2, on a grid four cells wider on
/// each side; it needs scene.extent. The twists of mirrored and exchanged ones have the opposite sign.
solver::Scene seen_as(solver::Scene scene, Variant variant);

}  // namespace slipstick::convergence
