#pragma once

#include <Eigen/Core>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Hertz's contact of a paraboloid: pressure p0 sqrt(1 - (x1/a1)^2 - (x2/a2)^2).
struct HertzContact {
  double semi_axis_1;
  double semi_axis_2;
  double peak_pressure;
};

/// Gap x1^2/(2 R1) + x2^2/(2 R2) pressed by W on an elastic pair of modulus E*. Consistent units, all positive. The
/// potential of the pressure along each chord is elementary (Johnson 1985, section 3.7), and what is left, an integral
/// over the direction, is periodic and positive: the trapezoidal rule has it to rounding.
HertzContact hertz_contact(double load, double radius_1, double radius_2, double effective_modulus);

/// That pressure at cell centres.
Eigen::ArrayXd hertz_at_centres(const HertzContact& contact, const Grid& grid);

/// Its mean over each cell, in closed form (volume under an ellipsoid's cap).
Eigen::ArrayXd hertz_cell_averages(const HertzContact& contact, const Grid& grid);

}  // namespace slipstick::solver
