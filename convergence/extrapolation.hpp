#pragma once

#include <array>
#include <optional>

namespace slipstick::convergence {

/// Where a sequence of meshes leads.
struct Extrapolation {
  double limit;
  double uncertainty;           ///< how far the finest mesh may be from the limit
  std::optional<double> order;  ///< of the error in the cell size; none: nothing was fitted
};

/// Richardson's extrapolation of the values on three meshes, finest last: limit and order p of
/// value = limit + c size^p, the uncertainty being the finest mesh's distance from the limit. Where they give
/// no order between 0.5 and 3, as where they do not fall in line, the finest value stands, with the last
/// change as its uncertainty. Sizes fall; only their ratios matter.
Extrapolation extrapolate(const std::array<double, 3>& values, const std::array<double, 3>& sizes);

}  // namespace slipstick::convergence
