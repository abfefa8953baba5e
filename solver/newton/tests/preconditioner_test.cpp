// How good the preconditioner of slipping cells is.

#include <gtest/gtest.h>

#include <cmath>

#include "solver/elasticity/inverse_symbol.hpp"
#include "solver/newton/tests/tangent_cg.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

/// A circle of radius a that sticks within a/2; beyond, traction turns, so that cells move along radii,
/// against a stiffness that grows like slip, (r - c)^1.5, over a pressure that ends like a root.
template <typename Function>
void for_each_slipping(const Grid& grid, TangentSpace& space, const Function& function) {
  const double a = 0.5 * static_cast<double>(grid.n1) - 1.0;
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) {
      const double x1 = grid.x1(i) / a;
      const double x2 = grid.x2(j) / a;
      const double r = std::hypot(x1, x2);
      const Index cell = i * grid.n2 + j;
      if (r >= 1.0 || r <= 0.5) {
        space.set(cell, r < 1.0);
      } else {
        function(cell, x1 / r, x2 / r, a * 4.0 * std::pow(r - 0.5, 1.5) / std::sqrt(1.0 - r * r));
      }
    }
  }
}

const HalfSpaces kSteel(elastic_pair({2.0, 0.3}, {2.0, 0.3}));

int iterations_needed(Index cells, bool two_terms) {
  const Grid grid{cells, cells, 1.0, 1.0};
  const auto op = make_operator(OperatorKind::dcfft, grid, tangential_kernel(), kSteel);
  const auto symbol = make_inverse_symbol(grid, tangential_kernel(), kSteel);
  const std::array<double, 2> means = symbol->diagonal();
  TangentSpace space(2, grid.cells());
  for_each_slipping(grid, space, [&](Index cell, double f1, double f2, double stiffness) {
    const double mean = f1 * f1 * means[0] + f2 * f2 * means[1];
    space.set_line(cell, f1, f2, stiffness, mean);
    if (two_terms) return;
    space.scale[cell] = static_cast<float>(1.0 / std::sqrt(1.0 + stiffness * mean));
    space.shift[cell] = 0.0F;
  });
  space.find_free();
  TangentCg cg(*op, *symbol, 2 * grid.cells(), 0);
  cg.residual() = random_field(2 * grid.cells(), 91);
  const CgSummary summary = cg.solve(space, 1e-6, 1000);
  EXPECT_EQ(summary.message(), "");
  return summary.iterations;
}

/// With only one term the error where cells slip far is the ratio of the largest to the smallest wave number:
/// it grows with the number of cells.
TEST(TwoTermPreconditioner, NeedsHardlyMoreIterationsOnFinerGrids) {
  const int coarse = iterations_needed(32, true);
  const int fine = iterations_needed(128, true);
  const int one_term = iterations_needed(128, false);
  EXPECT_LE(fine, coarse + 3);
  EXPECT_LT(2 * fine, one_term);
}

}  // namespace
}  // namespace slipstick::solver
