#pragma once

#include <cstddef>
#include <vector>

#include "solver/model/model.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::solver {

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
