#include "solver/elasticity/mirrored_convolution.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "solver/elasticity/direct.hpp"
#include "solver/grid/mirror.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Mirrored = MirroredConvolution;

/// Relative to the largest displacement: the transforms round by some eps times the logarithm of their
/// length.
constexpr double kAgreement = 1e-13;

struct MirroredCase {
  std::string name;
  Grid grid;
  BlockKernel kernel;
  SharedLaw law;
};

void PrintTo(const MirroredCase& tested, std::ostream* stream) { *stream << tested.name; }

Grid quadrant(Index n1, Index n2, double h1 = 1.0, double h2 = 1.0) { return {n1, n2, h1, h2, true}; }

SharedLaw similar_pair(double poisson_ratio) {
  return half_spaces({1.0, poisson_ratio}, {1.0, poisson_ratio});
}

std::vector<MirroredCase> mirrored_cases() {
  struct Pair {
    std::string name;
    SharedLaw law;
  };
  const std::vector<Pair> pairs{{"nu0", similar_pair(0.0)},
                                {"nu03", similar_pair(0.3)},
                                {"nu05", similar_pair(0.5)},
                                {"dissimilar", half_spaces({1.0, 0.3}, {2.5, 0.1})}};
  const std::vector<Grid> grids{quadrant(1, 1),   quadrant(2, 3, 1.0, 0.5),   quadrant(5, 4),
                                quadrant(16, 16), quadrant(33, 17),           quadrant(7, 31, 0.3, 1.0),
                                quadrant(17, 17), quadrant(37, 5, 1e-3, 2e-3)};
  std::vector<MirroredCase> cases;
  for (const Grid& grid : grids) {
    for (const auto& [name, law] : pairs) {
      const std::string suffix = std::to_string(grid.n1) + "x" + std::to_string(grid.n2) + "_" + name;
      cases.push_back({"normal_" + suffix, grid, normal_kernel(), law});
      cases.push_back({"tangential_" + suffix, grid, tangential_kernel(), law});
    }
  }
  return cases;
}

/// As torsion of a body of revolution has it.
ArrayXd random_diagonal_field(const Grid& grid, unsigned seed) {
  return mirrored_about_diagonal(random_field(2 * grid.cells(), seed), grid.n1);
}

Symmetry symmetry_of(const BlockKernel& kernel) {
  return kernel.inputs == 1 ? normal_symmetry() : torsion_symmetry();
}

/// The same on the whole grid.
ArrayXd apply_unfolded(const MirroredCase& tested, const ArrayXd& traction) {
  const Grid whole = whole_grid(tested.grid);
  DirectSum op(whole, tested.kernel, *tested.law, OperatorOptions{});
  return restrict_to_quadrant(whole, applied(op, unfold(tested.grid, traction, symmetry_of(tested.kernel))));
}

class MirroredConvolutionTest : public testing::TestWithParam<MirroredCase> {
 protected:
  const Grid& grid() const { return GetParam().grid; }
  const BlockKernel& kernel() const { return GetParam().kernel; }
  ArrayXd random_traction(unsigned seed) const {
    return random_field(static_cast<Index>(kernel().inputs) * grid().cells(), seed);
  }
  /// As around a contact: nothing in the outer rows.
  ArrayXd random_traction_inside(unsigned seed) const {
    ArrayXd traction = random_traction(seed);
    for (Index row = 0; row < traction.size() / grid().n2; ++row) {
      if (row % grid().n1 > grid().n1 / 2) traction.segment(row * grid().n2, grid().n2).setZero();
    }
    return traction;
  }
};

INSTANTIATE_TEST_SUITE_P(Shapes, MirroredConvolutionTest, testing::ValuesIn(mirrored_cases()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(MirroredConvolutionTest, IsTheDirectSumOfTheUnfoldedField) {
  Mirrored mirrored(grid(), kernel(), *GetParam().law, {});
  for (const ArrayXd& traction : {random_traction(1), random_traction_inside(2)}) {
    EXPECT_LE(relative_difference(applied(mirrored, traction), apply_unfolded(GetParam(), traction)),
              kAgreement);
  }
}

class DiagonalConvolutionTest : public testing::TestWithParam<Index> {
 protected:
  Grid grid() const { return quadrant(GetParam(), GetParam(), 0.3, 0.3); }
  Mirrored make() const { return {grid(), tangential_kernel(), dissimilar_pair(), {.diagonal = true}}; }
};

INSTANTIATE_TEST_SUITE_P(Sizes, DiagonalConvolutionTest, testing::Values(1, 2, 3, 8, 13, 16, 17, 33, 50));

TEST_P(DiagonalConvolutionTest, IsTheMirroredConvolutionOfSymmetricFields) {
  Mirrored plain(grid(), tangential_kernel(), dissimilar_pair(), {});
  Mirrored diagonal = make();
  for (const unsigned seed : {11U, 12U}) {
    const ArrayXd traction = random_diagonal_field(grid(), seed);
    EXPECT_LE(relative_difference(applied(diagonal, traction), applied(plain, traction)), kAgreement);
  }
}

TEST_P(DiagonalConvolutionTest, GivesExactlySymmetricDisplacementsAndReadsQ1Only) {
  Mirrored diagonal = make();
  const Index n = GetParam();
  const ArrayXd symmetric = random_diagonal_field(grid(), 13);
  ArrayXd other = symmetric;
  other.tail(n * n) = random_field(n * n, 14);
  const ArrayXd u = applied(diagonal, symmetric);
  EXPECT_TRUE((applied(diagonal, other) == u).all());
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) ASSERT_EQ(u[n * n + i * n + j], -u[j * n + i]);
  }
}

}  // namespace
}  // namespace slipstick::solver
