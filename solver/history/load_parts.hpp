#pragma once

#include <vector>

#include "solver/history/history_state.hpp"
#include "solver/scene/scene.hpp"

/// How the loads of a step are brought: in parts, each an implicit step of its own. Each part opposes
/// traction to its slip as a whole. So the answer depends on the number of parts wherever slip turns within a
/// step, or the contact grows or shrinks while it slips, and tends to that of Coulomb's law like one over
/// that number.
namespace slipstick::solver {

/// The loads at the ends of the parts of a step, `scene.solver.substeps` of them; the last one is the step
/// itself. Tangential loads and imposed motions are interpolated linearly, from their values at the end of
/// the step before. Where the normal load changes too, the first half of the parts brings it, and the second
/// half the tangential loads; a single part brings both at once. The first step begins with its normal load.
std::vector<Step> parts_of(const Scene& scene, const Step& step, const Step* previous, const StepEnd& before);

}  // namespace slipstick::solver
