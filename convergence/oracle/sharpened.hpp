#pragma once

#include <array>
#include <vector>

#include "solver/solution.hpp"

namespace slipstick::convergence {

/// What a cut cell has at its centre, Pa.
struct SharpenedCell {
  solver::Index cell;
  double pressure;
  std::array<double, 2> traction;
};

/// A solution's fields where their square-root edges are read off, cell by cell in their order. A solve knows
/// means: in the cells that the contact's edge or the stick front cuts they are off by h^(1/2). Towards the
/// edge p^2 falls linearly, and towards the front, from inside, (f - |q|)^2 does, f the friction bound,
/// whatever the contact's shape. So the quadratic that fits this square best in the whole cells beyond says
/// what it is at the centres of the cut ones. Cells keep their numbers where too few whole cells are near,
/// and at edges towards which the pressure rises (a punch's). Tractions keep their directions and stay within
/// the bound of the pressure beside them.
std::vector<SharpenedCell> sharpened(const solver::Solution& solution);

}  // namespace slipstick::convergence
