#pragma once

#include <optional>
#include <string>

#include "convergence/check/examination.hpp"

namespace slipstick::convergence {

/// The mistake in bodies and layers that explains a field's pressure: the normal contact of the scene with
/// that mistake, solved on the field's cells, is the field's up to `allowed`. Mistakes that no pressure
/// distinguishes are named together, and a number is fitted (a layer's thickness, the moduli) where no
/// mistake without one explains it. None where nothing that is tried does, and in contacts of too many cells.
std::optional<std::string> mistaken_scene(const Examination& examination, double allowed);

/// "N cells have no row": where the field has the scene's pressure, but for cells without any inside it. None
/// unless that explains its pressure up to `allowed`.
std::optional<std::string> lost_rows(const Examination& examination, double allowed);

}  // namespace slipstick::convergence
