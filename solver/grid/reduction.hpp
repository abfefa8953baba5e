#pragma once

#include <Eigen/Core>

#include "solver/grid/mirror.hpp"

namespace slipstick::solver {

/// The part of a grid on which a contact has to be solved, and the way there and back: without the empty rows
/// and columns around the contact, and of a contact with two mirror axes one quadrant.
class Reduction {
 public:
  Reduction() = default;

  /// Nothing is left out.
  explicit Reduction(const Grid& grid) : whole_(grid), trimmed_(grid), grid_(grid) {}

  /// The empty rows and columns around the contact are left out; see below.
  Reduction(const Grid& grid, const Eigen::ArrayXd& contact);

  /// What a field that shapes the contact, even in x1 and x2 (the gap, the pressure), shows can be left out.
  /// contact: cells that may carry traction are positive; the rest around them is trimmed, as much on one
  /// side as on the other, so that the origin stays in the middle.
  Reduction(const Grid& grid, const Eigen::ArrayXd& shape, const Eigen::ArrayXd& contact);

  const Grid& grid() const { return grid_; }
  bool trimmed() const { return trimmed_.cells() < whole_.cells(); }
  bool quadrant() const { return grid_.quadrant; }
  /// Whether the contact also has the diagonal for a mirror: then it is a square quadrant of square cells.
  bool diagonal() const { return diagonal_; }

  /// A field of one or more components on the reduced grid.
  Eigen::ArrayXd restricted(Eigen::ArrayXd field) const;

  /// And back: zero outside, mirrored by the parity of each component.
  Eigen::ArrayXd expanded(Eigen::ArrayXd field, const Symmetry& symmetry) const;

 private:
  Grid whole_{};
  Grid trimmed_{};
  Grid grid_{};
  bool diagonal_ = false;
};

/// Whether a field of one value a cell is its own image under half a turn about the grid's middle, up to
/// rounding. What has two mirror axes is so: rounding that each of them may show is no reason to take half a
/// turn, which is both, for another answer. So whatever Reduction takes for a quadrant turns onto itself.
bool is_half_turn_symmetric(const Grid& grid, const Eigen::ArrayXd& field);

/// p made its own image under half a turn, as it is up to the tolerance that it was solved to.
Eigen::ArrayXd half_turn_symmetrised(const Eigen::ArrayXd& pressure);

/// Whether a field of two components turns into itself under half a turn, (q1, q2)(-x) = -(q1, q2)(x), up to
/// the rounding of a transform; and a field made so. An empty one is.
bool turns_into_itself(const Eigen::ArrayXd& field);
void turn_into_itself(Eigen::ArrayXd& field);

/// p made even about the diagonal of its square grid: conjugate gradients leave it so up to their tolerance.
Eigen::ArrayXd symmetrised(const Grid& grid, const Eigen::ArrayXd& pressure);

}  // namespace slipstick::solver
