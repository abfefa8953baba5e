#include "solver/grid/packing.hpp"

#include <limits>
#include <stdexcept>
#include <utility>

namespace slipstick::solver {

using Eigen::ArrayXd;

Packing::Packing(const Grid& grid, const Sweep& cells, Index components)
    : grid_(Sweep::whole(grid)),
      cells_(cells),
      packed_(cells.packed()),
      place_(grid.cells()),
      on_grid_(is_whole() ? 0 : components * grid.cells()) {
  if (cells.count() >= std::numeric_limits<std::uint32_t>::max()) throw std::length_error("cells to pack");
  clear(grid_, place_);
  ArrayXd coordinates(2 * cells.count());
  cells_.each_with_place([&](Index first, Index last, Index place) {
    const Index i = first / grid.n2;
    for (Index k = 0; k < last - first; ++k) {
      place_[first + k] = static_cast<std::uint32_t>(place + k + 1);
      coordinates[place + k] = grid.x1(i);
      coordinates[cells_.count() + place + k] = grid.x2(first + k - i * grid.n2);
    }
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
  if (!is_whole()) clear(grid_, to);
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
