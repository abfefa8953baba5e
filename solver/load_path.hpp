#pragma once

#include <cstddef>
#include <vector>

#include "solver/model.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"
#include "solver/tractions.hpp"

/// How the loads of a step are brought: in parts, each an implicit step of its own. Each part opposes
/// traction to its slip as a whole. So the answer depends on the number of parts wherever slip turns within a
/// step, or the contact grows or shrinks while it slips, and tends to that of Coulomb's law like one over
/// that number.
namespace slipstick::solver {

/// The loads at the ends of the parts of a step, `scene.substeps` of them; the last one is the step itself.
/// Tangential loads go straight from what the contact carries, or where it stands, to those of the step.
/// Where the normal load changes too, the first half of the parts brings it, and the second half the
/// tangential loads; a single part brings both at once. The first step begins with its normal load.
std::vector<Step> parts_of(const Scene& scene, const Step& step, const Step* previous, const StepEnd& before);

/// Whether the number of parts can change the answer. It cannot where a surface of revolution between similar
/// bodies is only twisted, under one normal load: slip goes on along circles.
bool depends_on_path(const Scene& scene, const Model& model);

/// The error that the number of parts leaves at the end of each step of a scene. It is estimated on few
/// cells, on which parts leave nearly the same errors as on many: from the same history in four times as many
/// parts.
class PathUncertainty {
 public:
  /// Solves the two histories, unless the number of parts cannot matter.
  PathUncertainty(const Scene& scene, const Model& model);

  /// At the end of a step, counted from 0 over all cycles. Infinite where a coarse history broke off, or a
  /// file of pressures fixes the grid.
  Quantities at(std::size_t step) const;

 private:
  bool matters_ = false;
  std::vector<Quantities> at_ends_;  ///< of the first steps; of later ones it grows in proportion
  bool broke_off_ = false;
};

}  // namespace slipstick::solver
