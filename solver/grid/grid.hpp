#pragma once

#include <Eigen/Core>

#include "solver/grid/ranks.hpp"

namespace slipstick::solver {

/// A rectangle of n1 x n2 equal cells, centred at the origin or, as the quadrant x1, x2 > 0 of one twice as
/// long and wide, with a corner there. A field over it is n1*n2 values, cell (i, j) at i*n2 + j: x2 runs
/// fastest. A vector field is its first component's values, then its second's.
struct Grid {
  Index n1;
  Index n2;
  double h1;  ///< cell size along x1
  double h2;  ///< cell size along x2
  bool quadrant = false;
  Ranks ranks = {};  ///< that share its rows

  bool operator==(const Grid&) const = default;
  Index cells() const { return n1 * n2; }
  double cell_area() const { return h1 * h2; }
  /// Cell centres. Mirror images about the origin are exact negatives of each other.
  double x1(Index i) const { return 0.5 * static_cast<double>(2 * i + 1 - (quadrant ? 0 : n1)) * h1; }
  double x2(Index j) const { return 0.5 * static_cast<double>(2 * j + 1 - (quadrant ? 0 : n2)) * h2; }
};

/// +1 if a field is even in x1 (or x2), -1 if it is odd.
struct Parity {
  int x1;
  int x2;
};

/// A length >= max(minimum, 4) with fast transforms: a power of two up to 17/16 of the minimum, whose estimated plans
/// take half to three quarters of the time of other lengths, else the smallest even 2^a 3^b 5^c 7^d.
Index fast_length(Index minimum);

/// The work of a nested solve on one of its grids.
struct GridWork {
  Index n1 = 0;
  Index n2 = 0;
  long applications = 0;
  int iterations = 0;
  double gap = 0.0;
};

/// An area of solved contact or stick, in the unit of the grid's cells. Counting cells overestimates it on
/// every mesh, since a cell that the edge cuts may count in full: in the mean by the same part of a cell per
/// side along the edge (Yastrebov, Anciaux and Molinari 2017, "On the accurate computation of the true
/// contact-area in mechanical contact of random rough surfaces").
struct CountedArea {
  double counted = 0.0;
  double corrected = 0.0;
  double uncertainty = 0.0;  ///< of `corrected`, with a probability of 99 %
};

/// Cells that counting adds per cell side along a smooth edge of solved contact or stick.
inline constexpr double kCountedBySide = 0.09;
/// The same where every cell that the edge cuts is counted: half a cell per side.
inline constexpr double kCutBySide = 0.5;

/// inside: grid.cells() values, above zero in the cells of the area. by_side: cells that counting adds per
/// side of the edge; 0 for a punch's face, which has the cells whose centres lie on it.
CountedArea counted_area(const Grid& grid, const Eigen::ArrayXd& inside, double by_side = kCountedBySide);

/// Zeros. On Linux their pages are given back, and take memory again only where they are written.
Eigen::ArrayXd zeros(Index values);

/// x1 and x2 of all cell centres: n1*n2 values each.
Eigen::ArrayXd cell_x1(const Grid& grid);
Eigen::ArrayXd cell_x2(const Grid& grid);

/// The displacement field t = (-x2, x1) of a unit rotation about the origin: 2*n1*n2 values.
Eigen::ArrayXd rotation_field(const Grid& grid);

}  // namespace slipstick::solver
