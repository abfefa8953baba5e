#pragma once

#include <array>
#include <string>

#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Equivalent scenes of the same contact: mirrored (x2 to -x2); turned by a quarter (x1 to x2); shifted to
/// other cells of a larger grid; in other units (lengths in mm); with the bodies exchanged; on two threads.
enum class Variant { none, mirrored, turned, shifted, in_other_units, exchanged, two_threads };

inline constexpr std::array kVariants{Variant::mirrored,       Variant::turned,    Variant::shifted,
                                      Variant::in_other_units, Variant::exchanged, Variant::two_threads};

std::string to_string(Variant variant);

/// Throws std::invalid_argument for a word that to_string() does not give.
Variant variant_of(const std::string& word);

/// Why a scene has no such equivalent; empty: it has. Files and random surfaces cannot be turned, and a
/// moment about the grid's origin is another one where a force acts off the origin.
std::string why_not(const solver::Scene& scene, Variant variant);

/// The equivalent scene. Shifted: by two cells along x1 and minus one along x2, on a grid four cells wider on
/// each side; it needs scene.grid.extent. Twists of mirrored and exchanged scenes have the opposite sign.
solver::Scene transformed(solver::Scene scene, Variant variant);

}  // namespace slipstick::convergence
