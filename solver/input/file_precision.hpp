#pragma once

#include <Eigen/Core>

namespace slipstick::solver {

/// How far a number in a file may be from the one that the program computed: by a part of its size where it was written
/// with a fixed count of digits, or by an amount where it was written with a fixed count of decimals.
struct FilePrecision {
  double relative = 0.0;
  double absolute = 0.0;

  /// The rounding of each value.
  Eigen::ArrayXd rounding(const Eigen::ArrayXd& values) const { return (relative * values.abs()).max(absolute); }
};

/// Determined from the values themselves: the fewest digits, and the fewest decimals, that give all of them.
FilePrecision find_precision(const Eigen::ArrayXd& values);

}  // namespace slipstick::solver
