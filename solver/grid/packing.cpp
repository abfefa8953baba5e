#include "solver/grid/packing.hpp"

#include <limits>
#include <stdexcept>

namespace slipstick::solver {

using Eigen::ArrayXd;

Packing::Packing(const Grid& grid, const Sweep& cells, Index components)
    : cells_(cells),
      packed_(cells.packed()),
      place_(is_whole() ? 0 : grid.cells()),
      on_grid_(components * place_.size()) {
  if (place_.size() > 0 && cells.count() >= std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("cells to pack");
  if (!is_whole()) {
    clear(cells_, place_);
    cells_.each_with_place([&](Index first, Index last, Index place) {
      for (Index cell = first; cell < last; ++cell) place_[cell] = static_cast<std::uint32_t>(++place);
    });
  }
  const ArrayXd x2 = ArrayXd::NullaryExpr(grid.n2, [&](Index j) { return grid.x2(j); });
  ArrayXd coordinates(2 * cells.count());
  cells_.each_with_place([&](Index first, Index last, Index place) {
    const Index n = last - first;
    coordinates.segment(place, n).setConstant(grid.x1(first / grid.n2));
    coordinates.segment(cells_.count() + place, n) = x2.segment(first % grid.n2, n);
  });
  coordinates_ = std::make_shared<const ArrayXd>(std::move(coordinates));
}

void Packing::pack(const ArrayXd& from, ArrayXd& to) const {
  cells_.each_with_place([&](Index first, Index last, Index place) {
    for (Index start = 0; start < from.size(); start += cells_.size(), place += packed_.size())
      to.segment(place, last - first) = from.segment(start + first, last - first);
  });
}

void Packing::unpack(const ArrayXd& from, ArrayXd& to) const {
  if (!is_whole()) clear(cells_, to);
  cells_.each_with_place([&](Index first, Index last, Index place) {
    for (Index start = 0; start < to.size(); start += cells_.size(), place += packed_.size())
      to.segment(start + first, last - first) = from.segment(place, last - first);
  });
}

ArrayXd Packing::packed(const ArrayXd& field) const {
  ArrayXd result(field.size() / cells_.size() * packed_.size());
  pack(field, result);
  return result;
}

ArrayXd Packing::unpacked(const ArrayXd& field) const {
  ArrayXd result(field.size() / packed_.size() * cells_.size());
  unpack(field, result);
  return result;
}

}  // namespace slipstick::solver
