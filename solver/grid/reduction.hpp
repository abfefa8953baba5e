#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/grid/grid.hpp"

/// Fields with two mirror axes on the quadrant x1, x2 > 0, and the part of a grid on which a contact is solved.
namespace slipstick::solver {

/// How a field continues across the mirror axes: the parity of each of its components.
using Symmetry = std::vector<Parity>;

/// Even in both coordinates: normal pressure and displacement.
Symmetry normal_symmetry();
/// (q1, q2) and (u1, u2) under torsion, as (-x2, x1) is: even and odd, odd and even.
Symmetry torsion_symmetry();

/// The grid of 2 n1 x 2 n2 cells. Throws std::invalid_argument for a grid that is no quadrant.
Grid whole_grid(const Grid& quadrant);

/// Throws std::invalid_argument for a quadrant, and for odd counts of cells: an axis would cut cells in two.
Grid quadrant_of(const Grid& whole);

/// A field on the quadrant and its mirror images, on whole_grid(quadrant): each component of n1 n2 values, one for each
/// parity, becomes 4 n1 n2 values. Throws std::invalid_argument for another size, and as whole_grid.
Eigen::ArrayXd unfold(const Grid& quadrant, const Eigen::ArrayXd& field, const Symmetry& symmetry);

/// The part of a field of any number of components that lies on quadrant_of(whole). Throws
/// std::invalid_argument for a field of another size, and as quadrant_of.
Eigen::ArrayXd restrict_to_quadrant(const Grid& whole, const Eigen::ArrayXd& field);

/// The part of a grid on which a contact is solved, and the transfer of fields to it and back: empty rows and
/// columns around the contact are left out, and of a contact with two mirror axes three quadrants.
class Reduction {
 public:
  Reduction() = default;

  /// The whole grid.
  explicit Reduction(const Grid& grid) : Reduction(grid, grid) {}

  /// The cells of another grid of the same cells in the middle of a grid.
  Reduction(const Grid& grid, const Grid& middle) : whole_(grid), trimmed_(middle), grid_(middle) {}

  /// contact: positive in cells that may carry traction. Empty rows and columns around them are trimmed, as
  /// many on one side as on the other, so that the origin stays in the middle.
  Reduction(const Grid& grid, const Eigen::ArrayXd& contact);

  /// The same, and one quadrant if `shape`, the gap or the pressure, is even in x1 and in x2 there.
  Reduction(const Grid& grid, const Eigen::ArrayXd& shape, const Eigen::ArrayXd& contact);

  const Grid& grid() const { return grid_; }
  bool trimmed() const { return trimmed_.cells() < whole_.cells(); }
  bool quadrant() const { return grid_.quadrant; }
  /// True if the diagonal is a mirror as well: then the quadrant and its cells are square.
  bool diagonal() const { return diagonal_; }

  /// A field of one or more components on the reduced grid, and back: zero outside, mirrored by the parity of
  /// each component.
  Eigen::ArrayXd restricted(Eigen::ArrayXd field) const;
  Eigen::ArrayXd expanded(Eigen::ArrayXd field, const Symmetry& symmetry) const;

 private:
  Grid whole_{};
  Grid trimmed_{};
  Grid grid_{};
  bool diagonal_ = false;
};

/// True if a field of one value a cell equals its image under half a turn about the grid's middle, up to
/// rounding. It is true for every field that Reduction reduces to a quadrant, although the rounding of the
/// two mirrors adds up in half a turn.
bool is_half_turn_symmetric(const Grid& grid, const Eigen::ArrayXd& field);

/// (p(x) + p(-x))/2: the exact answer has this symmetry, a solved p up to its tolerance.
Eigen::ArrayXd half_turn_symmetrised(const Eigen::ArrayXd& pressure);

/// True if (q1, q2)(-x) = -(q1, q2)(x) up to the rounding of a transform, or the field is empty; and the
/// projection of a field onto this symmetry.
bool turns_into_itself(const Eigen::ArrayXd& field);
void turn_into_itself(Eigen::ArrayXd& field);

/// p made even about the diagonal of its square grid; a solved p is so up to its tolerance.
Eigen::ArrayXd symmetrised(const Grid& grid, const Eigen::ArrayXd& pressure);

}  // namespace slipstick::solver
