#pragma once

#include <Eigen/Core>

#include "solver/grid/own_rows.hpp"
#include "solver/grid/sweep.hpp"

namespace slipstick::solver {

/// Continues a field smoothly from the cells that are free into those beside them, and its adjoint.
///
/// With S the operator's inverse on the whole plane, the inverse on the free cells alone is the least of E^T
/// S E over all E that leave a field as it is there. E = 0 elsewhere, as a projector has it, cuts residuals
/// off at the edges of the free cells and answers them several times too strongly; a decaying mean of what is
/// near by comes close.
class Extension {
 public:
  using Field = Eigen::ArrayXd;

  /// For fields of any number of components on a grid; each is continued by itself.
  explicit Extension(const Grid& grid);

  /// free: 1 in the cells that are, 0 elsewhere. A field that is given here need be known in the grid's own
  /// rows alone; the rows beside them are filled in.
  void prepare(Field& free);
  /// y, zero where no cell is free: its continuation is added there. Allocates nothing.
  void extend(Field& y);
  /// The adjoint: to y in the free cells it adds what it has where extend() writes. Allocates nothing.
  void collect(Field& y);

  /// Pressures below zero, and those of cells that are not free, go to the free cells beside them, by the
  /// adjoint: it is close to what these answer once the others carry nothing. Clipping negative pressures
  /// without handing them on would open the neighbourhood too far, and the next state would hold too few
  /// cells. cells: those of p that may differ from zero. Overwrites the last two fields, and what prepare()
  /// left.
  void hand_on(const Sweep& cells, const Field& free, Eigen::ArrayXd& p, Field& stays, Field& leaves);

 private:
  void find_mixed(const Field& free);
  template <typename Take>
  void spread(const Field& in, Index component, const Take& take) const;

  Grid grid_;
  Index reach_;   ///< cells, along each axis
  Field weight_;  ///< of the sum near by; 0 in the free cells
  Field work_;    ///< 0 but in mixed_
  Sweep mixed_;   ///< over blocks of cells that have both kinds near them: elsewhere nothing is continued
  Field zeros_;   ///< a row beyond the grid
};

}  // namespace slipstick::solver
