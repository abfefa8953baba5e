#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <utility>

#include "solver/grid/grid.hpp"
#include "solver/grid/sweep.hpp"

namespace slipstick::solver {

/// How fields are stored on a set of a grid's cells: the values of these cells only, one after the other, component by
/// component. So a contact's fields take the memory of its cells, not of its grid. Operators work on one field of the
/// whole grid, which all packed fields share. Fields of the grid need be known only in this rank's rows.
class Packing {
 public:
  Packing() = default;
  /// components: of the fields that on_grid() takes. Throws std::length_error for 2^32 cells or more.
  Packing(const Grid& grid, const Sweep& cells, Index components);

  /// All cells of packed fields.
  const Sweep& cells() const { return packed_; }
  /// x1, then x2 of each cell.
  const std::shared_ptr<const Eigen::ArrayXd>& coordinates() const { return coordinates_; }
  /// The place of a cell of the grid; negative: it is not stored.
  Index place(Index cell) const { return is_whole() ? cell : static_cast<Index>(place_[cell]) - 1; }
  /// True if a packed field is not zero in a cell of the grid.
  bool holds(Index cell, const Eigen::ArrayXd& field) const {
    const Index i = place(cell);
    return i >= 0 && field[i] != 0.0;
  }

  /// A field of any number of components (also none): from the grid to the set, and back, zero elsewhere.
  Eigen::ArrayXd packed(const Eigen::ArrayXd& field) const;
  Eigen::ArrayXd unpacked(const Eigen::ArrayXd& field) const;

  /// Unpacks x, calls work(x, y) on fields of the grid, which may be one, and packs y. x and y may be one
  /// field. Allocates nothing.
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
  // Both empty if the set is the whole grid:
  Eigen::Array<std::uint32_t, Eigen::Dynamic, 1> place_;  ///< 1 + place of each cell; 0: not stored
  Eigen::ArrayXd on_grid_;
};

}  // namespace slipstick::solver
