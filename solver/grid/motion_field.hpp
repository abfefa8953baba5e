#pragma once

#include <Eigen/Core>
#include <memory>

#include "solver/grid/packing.hpp"

namespace slipstick::solver {

/// The displacements of a rigid motion over a grid, (along1 - turn x2, along2 + turn x1): two components, or
/// only the first. They are computed on demand, not stored. A range of values must lie in one row, or of a
/// packed field in one component.
class MotionField {
 public:
  MotionField(const Grid& grid, double along1, double along2 = 0.0, double turn = 0.0)
      : grid_(grid),
        cells_(grid.cells()),
        motion_(along1, along2, turn),
        x2_(Eigen::ArrayXd::NullaryExpr(grid.n2, [&](Index j) { return grid.x2(j); })) {}

  /// (along1, along2, turn)
  const Eigen::Vector3d& motion() const { return motion_; }

  /// The same motion over packed cells of its grid.
  MotionField packed(const Packing& packing) const {
    MotionField motion(*this);
    motion.cells_ = packing.cells().size();
    motion.coordinates_ = packing.coordinates();
    return motion;
  }

  /// The k-th value from a first one on is constant + slope * x[k].
  struct Row {
    double constant;
    double slope;
    const double* x;
  };
  Row row(Index first) const { return row(first, motion()); }
  /// The same for another motion (along1, along2, turn) over the same cells.
  Row row(Index first, const Eigen::Vector3d& motion) const {
    const double along1 = motion[0];
    const double along2 = motion[1];
    const double turn = motion[2];
    const bool second = first >= cells_;
    const Index cell = second ? first - cells_ : first;
    if (coordinates_ != nullptr) {
      const double* const x1 = coordinates_->data() + cell;
      return second ? Row{along2, turn, x1} : Row{along1, -turn, x1 + cells_};
    }
    const Index i = cell / grid_.n2;
    const double* const x2 = x2_.data() + (cell - i * grid_.n2);
    return second ? Row{along2 + turn * grid_.x1(i), 0.0, x2} : Row{along1, -turn, x2};
  }

  /// The values [first, first + n), an expression of Eigen's.
  auto segment(Index first, Index n) const {
    const Row at = row(first);
    return at.constant + at.slope * x(at, n);
  }

  /// The dot product of `values` and the motion's values from `first` on.
  template <typename Values>
  double dot(Index first, const Values& values) const {
    const Row at = row(first);
    double sum = at.constant == 0.0 ? 0.0 : at.constant * values.sum();
    if (at.slope != 0.0) sum += at.slope * (x(at, values.size()) * values).sum();
    return sum;
  }

  /// part += factor times the motion's values from `first` on.
  template <typename Part>
  void add_to(Part&& part, Index first, double factor) const {
    const Row at = row(first);
    if (at.slope != 0.0) {
      part += (factor * at.constant + (factor * at.slope) * x(at, part.size()));
    } else if (at.constant != 0.0) {
      part += factor * at.constant;
    }
  }

 private:
  static Eigen::Map<const Eigen::ArrayXd> x(const Row& row, Index n) { return {row.x, n}; }

  Grid grid_;
  Index cells_;  ///< of a component
  Eigen::Vector3d motion_;
  Eigen::ArrayXd x2_;
  std::shared_ptr<const Eigen::ArrayXd> coordinates_ = {};  ///< of packed cells
};

}  // namespace slipstick::solver
