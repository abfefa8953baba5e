#pragma once

#include <Eigen/Core>

namespace slipstick::solver {

/// How far a number in a file may be from the one that the program computed: by a part of its size, as where
/// it was written with so many digits, or by so much, as where it was written with so many decimals.
struct FilePrecision {
  double relative = 0.0;
  double absolute = 0.0;

  /// Of each of some values.
  Eigen::ArrayXd rounding(const Eigen::ArrayXd& values) const {
    return (relative * values.abs()).max(absolute);
  }
};

/// Determined from the values themselves: the fewest digits, and the fewest decimals, that give all of them.
FilePrecision find_precision(const Eigen::ArrayXd& values);

}  // namespace slipstick::solver
