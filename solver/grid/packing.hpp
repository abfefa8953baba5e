#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <utility>

#include "solver/grid/grid.hpp"
#include "solver/grid/sweep.hpp"

namespace slipstick::solver {

/// Fields of some cells of a grid alone, one behind the other, component by component: what is kept of a
/// contact takes as much memory as its cells, not as its grid. Operators, and what reaches beyond the cells,
/// have such fields on their grid in one field that all of them share. The grid's fields need be known in its
/// own rows alone.
class Packing {
 public:
  /// No cell of a grid yet.
  Packing() = default;
  /// For fields of so many components. Throws std::length_error for more cells than 32 bits count.
  Packing(const Grid& grid, const Sweep& cells, Index components);

  /// Over all cells of packed fields.
  const Sweep& cells() const { return packed_; }
  /// x1, then x2 of each cell.
  const std::shared_ptr<const Eigen::ArrayXd>& coordinates() const { return coordinates_; }
  /// Where a cell of the grid stands; negative: nowhere.
  Index place(Index cell) const { return is_whole() ? cell : static_cast<Index>(place_[cell]) - 1; }
  /// Whether a packed field has anything but zero in a cell of the grid.
  bool holds(Index cell, const Eigen::ArrayXd& field) const {
    const Index i = place(cell);
    return i >= 0 && field[i] != 0.0;
  }

  /// A field of any number of components, or of none: of the grid, packed; and back, with zeros elsewhere.
  Eigen::ArrayXd packed(const Eigen::ArrayXd& field) const;
  Eigen::ArrayXd unpacked(const Eigen::ArrayXd& field) const;

  /// work(x, y) on fields of the grid, which may be the same, with packed ones, which may be. Allocates
  /// nothing.
  template <typename Work>
  void on_grid(const Eigen::ArrayXd& x, Eigen::ArrayXd& y, const Work& work) {
    if (is_whole()) {
      work(x, y);
      return;
    }
    unpack(x, on_grid_);
    work(std::as_const(on_grid_), on_grid_);
    pack(on_grid_, y);
  }

 private:
  bool is_whole() const { return packed_.size() == cells_.size(); }
  void pack(const Eigen::ArrayXd& from, Eigen::ArrayXd& to) const;
  void unpack(const Eigen::ArrayXd& from, Eigen::ArrayXd& to) const;

  Sweep cells_, packed_;  ///< the set on the grid, and as it is stored
  std::shared_ptr<const Eigen::ArrayXd> coordinates_;
  // Where not all cells are kept:
  Eigen::Array<std::uint32_t, Eigen::Dynamic, 1> place_;  ///< and 1; 0: nowhere
  Eigen::ArrayXd on_grid_;
};

}  // namespace slipstick::solver
