#pragma once

#include <Eigen/Core>
#include <string>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// The edge of the stick area, resolved within cells.
struct StickFront {
  double radius = 0.0;          ///< of the circle with the stick area's area, in the grid's unit of length
  double counted_radius = 0.0;  ///< the same by counting cells
  double fitted = 0.0;          ///< fraction of the front, 0 to 1, that was resolved within cells
  std::string why_counted;      ///< the reason if the fraction is below 1
};

/// If slip began at the front and has continued, it grows like d^(3/2) with the distance d from the front, so
/// that |s|^(2/3) falls to zero there with a finite slope.
///
/// 1. Rays from the centroid of the stick area, about one per cell of the front.
/// 2. On each ray, a polynomial in the distance (and, to second order, across the ray) is fitted to
///    |s|^(2/3) by least squares in slipping cells, except next to the front, where the mesh blurs slip.
///    Degree and window depend on the width of the slip ring.
/// 3. r is the polynomial's root; if the ring is too narrow or no root is nearby, r of the counted front.
/// 4. The area is half the integral of r^2 over the angle. The counted area stands if rays from the centroid
///    do not describe the stick area, or the two radii differ by more than half a cell.
///
/// friction_bound, stick: grid.cells() values; slip: twice as many. The radius is NaN where they are not
/// finite (slip: in the contact). Throws std::invalid_argument for fields of another size and for a quadrant.
StickFront find_stick_front(const Grid& grid, const Eigen::ArrayXd& friction_bound, const Eigen::ArrayXd& slip,
                            const Eigen::ArrayXd& stick);

}  // namespace slipstick::solver
