#pragma once

#include <Eigen/Core>
#include <string>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Where stick ends, finer than by cells.
struct StickFront {
  double radius = 0.0;          ///< of the circle with the stick area's area, in the grid's unit of length
  double counted_radius = 0.0;  ///< the same by counting cells
  double fitted = 0.0;          ///< part of the front, 0 to 1, that was found within the cells
  std::string why_counted;      ///< why not all of it was; empty if it was
};

/// Outside the front the slip grows like d^(3/2) with the distance d, so that |s|^(2/3) is smooth there and
/// falls to zero at the front with a slope. On rays from the stick area's centroid, about as many as the
/// front has cells, a polynomial in the distance (and, to second order, across the ray) is fitted to it by
/// least squares in slipping cells, further from the front than the mesh blurs it, and its root taken. The
/// area is half the integral of r^2 over the angle. Degree and window depend on how wide the slip ring is on
/// that ray; where it is too narrow, or the fit has no root near by, the counted front stands in, as it does
/// everywhere if the stick area is none that rays from its centroid can describe, or if the two differ by
/// more than half a cell: the law holds where slip began at the front and has gone on since.
///
/// friction_bound, stick: grid.cells() values; slip: twice as many. The radius is NaN where they are not
/// finite (slip: in the contact). Throws std::invalid_argument for fields of another size and for a quadrant.
StickFront find_stick_front(const Grid& grid, const Eigen::ArrayXd& friction_bound,
                            const Eigen::ArrayXd& slip, const Eigen::ArrayXd& stick);

}  // namespace slipstick::solver
