#pragma once

#include <Eigen/Core>

#include "solver/solution.hpp"

namespace slipstick::convergence {

/// Fields at cells' centres, in Pa. traction: 2*cells.
struct SharpenedFields {
  Eigen::ArrayXd pressure;
  Eigen::ArrayXd traction;
};

/// A solution's fields with their square-root edges read off. A solve knows means: in the cells that the
/// contact's edge or the stick front cuts they are off by h^(1/2). Towards the edge p^2 falls linearly, and
/// towards the front, from inside, (f - |q|)^2 does, f the friction bound, whatever the contact's shape. So
/// the quadratic that fits this square best in the whole cells beyond says what it is at the centres of the
/// cut ones. Cells keep their numbers where too few whole cells are near, and at edges towards which the
/// pressure rises (a punch's). Tractions keep their directions and stay within the bound of the pressure
/// beside them.
SharpenedFields sharpened(const solver::Solution& solution);

}  // namespace slipstick::convergence
