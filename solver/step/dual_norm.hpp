#pragma once

#include <Eigen/Core>
#include <span>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// A sum over points for an integral, and its estimated error.
struct Estimate {
  double value;
  double error;
};

/// A bound of |v|^2 in the norm that is dual to the energy's: the energy norm of the tractions whose displacements are
/// v. It holds if waves of tractions with wave vector xi displace a surface by `compliance` over |xi| times them, or
/// more: |v|^2 is then at most the integral of |xi| |v(xi)|^2/compliance, and by the inequality of Cauchy and Schwarz
/// at most the root of (integral of v^2) (integral of |grad v|^2), over the compliance.
///
/// v: one value a cell of the grid for each component, zero outside, mirrored across a quadrant's axes by
/// parities; of a quadrant its quarter of the norm. Its gradient is that of differences between neighbours;
/// the error compares differences of twice that distance.
Estimate dual_norm_squared(const Grid& grid, const Eigen::ArrayXd& v, std::span<const Parity> parities,
                           double compliance);

}  // namespace slipstick::solver
