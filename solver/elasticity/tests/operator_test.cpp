#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/allocations/allocations.hpp"
#include "solver/elasticity/direct.hpp"
#include "solver/elasticity/tests/kernel_case.hpp"
#include "solver/grid/reduction.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr std::array kKinds{OperatorKind::dcfft, OperatorKind::direct, OperatorKind::dense};
/// Between the three ways to evaluate one operator, relative to the largest displacement: the sum over a row
/// of up to 6,144 terms and the transforms round by a few hundred eps at most.
constexpr double kOfThreeWays = 1e-12;
/// Between a quadrant and its whole grid: transforms and sums there are shorter.
constexpr double kOfParts = 1e-13;

/// As around a contact: nothing in the outer rows, and cells without traction between others.
ArrayXd random_field_with_zero_rows(const Grid& grid, std::size_t fields, unsigned seed) {
  ArrayXd field = random_field(static_cast<Index>(fields) * grid.cells(), seed);
  for (Index row = 0; row < static_cast<Index>(fields) * grid.n1; ++row) {
    const Index i = row % grid.n1;
    if (i < grid.n1 / 4 || i % 5 == 2) field.segment(row * grid.n2, grid.n2).setZero();
  }
  for (Index i = 0; i < field.size(); i += 3) field[i] = 0.0;
  return field;
}

/// Displacement of one cell by traction on another, by the offset between them and the component's parity.
double coefficient(Component component, const Grid& grid, Index point, Index source) {
  const Index k1 = point / grid.n2 - source / grid.n2;
  const Index k2 = point % grid.n2 - source % grid.n2;
  const int sign = (k1 < 0 ? parity(component).x1 : 1) * (k2 < 0 ? parity(component).x2 : 1);
  const auto quadrant =
      dissimilar_pair().influence_coefficients(component, {std::abs(k1) + 1, std::abs(k2) + 1, grid.h1, grid.h2});
  return sign * quadrant.back();
}

bool is_whole(const KernelCase& tested) { return !tested.grid.quadrant; }

/// The ways to sum on a grid.
std::vector<OperatorKind> kinds_of(const KernelCase& tested) {
  if (is_whole(tested)) return {kKinds.begin(), kKinds.end()};
  return {OperatorKind::dcfft};
}

std::vector<KernelCase> operator_cases() {
  // One cell, one row, one column; lengths whose padded half is odd, even, and longer than the grid.
  std::vector<Grid> grids{
      {1, 1, 1.0, 1.0},         {1, 7, 1.0, 1.0},        {7, 1, 0.5, 1.0},         {16, 16, 1.0, 1.0},
      {31, 33, 1.0, 0.3},       {64, 48, 1.0, 1.0},      {13, 17, 1.0, 2.0},       {40, 9, 0.2, 1.0},
      {2, 3, 1e-3, 1e-3},       {3, 5, 1.0, 1.0},        {11, 3, 1.0, 1.0},        {25, 20, 1.0, 1.0},
      {1, 1, 1.0, 1.0, true},   {2, 3, 1.0, 0.5, true},  {5, 4, 1.0, 1.0, true},   {16, 16, 1.0, 1.0, true},
      {33, 17, 1.0, 1.0, true}, {7, 31, 0.3, 1.0, true}, {37, 5, 1e-3, 2e-3, true}};
  for (const Index n : {2, 3, 8, 13, 17, 33, 50}) grids.push_back({n, n, 0.3, 0.3, true});
  return kernel_cases(grids);
}

class Operator : public testing::TestWithParam<KernelCase> {
 protected:
  std::unique_ptr<LinearOperator> make(OperatorKind kind, int threads = 1) const {
    const auto& [name, grid, kernel, diagonal] = GetParam();
    return make_operator(kind, grid, kernel, dissimilar_pair(), {.threads = threads, .diagonal = diagonal});
  }
  ArrayXd random_traction(unsigned seed) const { return random_field(GetParam().size(), seed); }
};

INSTANTIATE_TEST_SUITE_P(Shapes, Operator, testing::ValuesIn(operator_cases()), testing::PrintToStringParamName());

/// Traction and displacement in the same direction, both components read: all but the coupling and the diagonal.
class SquareOperator : public Operator {};
class WholeOperator : public Operator {};
class QuadrantOperator : public Operator {};

INSTANTIATE_TEST_SUITE_P(Shapes, SquareOperator,
                         testing::ValuesIn(cases_without(operator_cases(),
                                                         [](const KernelCase& c) {
                                                           return c.kernel.inputs != c.kernel.outputs || c.diagonal;
                                                         })),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Shapes, WholeOperator,
                         testing::ValuesIn(cases_without(operator_cases(),
                                                         [](const KernelCase& c) { return !is_whole(c); })),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Shapes, QuadrantOperator, testing::ValuesIn(cases_without(operator_cases(), is_whole)),
                         testing::PrintToStringParamName());

TEST_P(WholeOperator, IsTheSameByFftDirectSumAndMatrix) {
  const auto& [name, grid, kernel, diagonal] = GetParam();
  const auto fft = make(OperatorKind::dcfft);
  const auto direct = make(OperatorKind::direct);
  const auto dense = make(OperatorKind::dense);
  for (const ArrayXd& traction : {random_traction(1), random_field_with_zero_rows(grid, kernel.inputs, 2),
                                  ArrayXd(ArrayXd::Ones(static_cast<Index>(kernel.inputs) * grid.cells()))}) {
    const ArrayXd expected = applied(*dense, traction);
    for (LinearOperator* const op : {fft.get(), direct.get()})
      EXPECT_LE(largest(applied(*op, traction) - expected), kOfThreeWays * largest(expected));
  }
}

/// With a mirror at the diagonal, q1 determines all of it, to the last bit.
TEST_P(QuadrantOperator, IsTheDirectSumOfTheUnfoldedField) {
  const auto& [name, grid, kernel, diagonal] = GetParam();
  const Symmetry symmetry = kernel.inputs == 1 ? normal_symmetry() : torsion_symmetry();
  const Grid whole = whole_grid(grid);
  DirectSum direct(whole, kernel, dissimilar_pair(), OperatorOptions{});
  const auto op = make(OperatorKind::dcfft);
  for (ArrayXd traction : {random_traction(1), random_field_with_zero_rows(grid, kernel.inputs, 2)}) {
    if (diagonal) traction = mirrored_about_diagonal(traction, grid.n1);
    const ArrayXd expected = restrict_to_quadrant(whole, applied(direct, unfold(grid, traction, symmetry)));
    const ArrayXd u = applied(*op, traction);
    EXPECT_LE(largest(u - expected), kOfParts * largest(expected));
    if (!diagonal) continue;
    EXPECT_TRUE((mirrored_about_diagonal(u, grid.n1) == u).all());
    traction.tail(grid.cells()) = random_field(grid.cells(), 14);
    EXPECT_TRUE((applied(*op, traction) == u).all());
  }
}

/// Each entry by its definition: displacement of the point's cell by traction on the source's.
TEST(DenseMatrix, HoldsTheCoefficientOfEachOffset) {
  const Grid grid{9, 7, 1.0, 0.6};
  for (const BlockKernel& kernel : {normal_kernel(), tangential_kernel(), coupling_kernel()}) {
    const DenseMatrix dense(grid, kernel, dissimilar_pair());
    for (std::size_t a = 0; a < kernel.outputs; ++a) {
      for (std::size_t b = 0; b < kernel.inputs; ++b) {
        const Component component = kernel.components[a * kernel.inputs + b];
        for (Index point = 0; point < grid.cells(); ++point) {
          for (Index source = 0; source < grid.cells(); ++source) {
            ASSERT_EQ(dense.matrix()(static_cast<Index>(a) * grid.cells() + point,
                                     static_cast<Index>(b) * grid.cells() + source),
                      coefficient(component, grid, point, source));
          }
        }
      }
    }
  }
}

TEST_P(SquareOperator, IsSymmetricAndPositiveDefinite) {
  for (const OperatorKind kind : kinds_of(GetParam())) {
    const auto op = make(kind);
    const ArrayXd x = random_traction(5);
    const ArrayXd y = random_traction(6);
    const ArrayXd Kx = applied(*op, x);
    const ArrayXd Ky = applied(*op, y);
    EXPECT_NEAR((x * Ky).sum(), (y * Kx).sum(), kOfThreeWays * std::sqrt((x * Kx).sum() * (y * Ky).sum()));
    EXPECT_GT((x * Kx).sum(), 0.0);
    EXPECT_GT((y * Ky).sum(), 0.0);
    // Where an operator's spectrum is least: signs that alternate from cell to cell.
    ArrayXd rough(x.size());
    const Index n2 = op->grid().n2;
    for (Index i = 0; i < rough.size(); ++i) rough[i] = (i / n2 + i % n2) % 2 == 0 ? 1.0 : -1.0;
    EXPECT_GT((rough * applied(*op, rough)).sum(), 0.0);
  }
}

TEST_P(Operator, GivesTheSameBitsAgainWithMoreThreadsAndWithoutAllocating) {
  const ArrayXd traction = random_field_with_zero_rows(GetParam().grid, GetParam().kernel.inputs, 7);
  const ArrayXd other = random_traction(8);
  for (const OperatorKind kind : kinds_of(GetParam())) {
    const long before_setup = allocations();
    const auto one = make(kind);
    EXPECT_GT(allocations(), before_setup) << "the count itself must work";
    const ArrayXd first = applied(*one, traction);
    ArrayXd again = applied(*one, other);  // must leave nothing behind
    const long before = allocations();
    one->apply(traction, again);
    EXPECT_EQ(allocations(), before);
    EXPECT_TRUE((again == first).all());
    EXPECT_EQ(applied(*one, ArrayXd(0.0 * traction)).abs().maxCoeff(), 0.0);
    EXPECT_EQ(one->applications(), 4);
    std::ranges::fill(one->idle_memory(), std::numeric_limits<double>::quiet_NaN());
    EXPECT_TRUE((applied(*one, traction) == first).all());
    if (one->inputs() == one->outputs()) {
      ArrayXd in_place = traction;
      one->apply(in_place, in_place);
      EXPECT_TRUE((in_place == first).all());
    }
    for (const int threads : {2, 3}) {
      const auto several = make(kind, threads);
      EXPECT_TRUE((applied(*several, traction) == first).all());
      EXPECT_TRUE((applied(*several, traction) == first).all());
    }
  }
}

TEST_P(Operator, RefusesFieldsOfAnotherSize) {
  for (const OperatorKind kind : kinds_of(GetParam())) {
    const auto op = make(kind);
    const auto cells = static_cast<std::size_t>(op->grid().cells());
    std::vector<double> traction(op->inputs() * cells + 1);
    std::vector<double> displacement(op->outputs() * cells + 1);
    const std::span<double> in(traction);
    const std::span<double> out(displacement);
    EXPECT_THROW(op->apply(in, out.first(op->outputs() * cells)), std::invalid_argument);
    EXPECT_THROW(op->apply(in.first(op->inputs() * cells), out), std::invalid_argument);
    EXPECT_THROW(op->apply(in.first(op->inputs() * cells - 1), out.first(op->outputs() * cells)),
                 std::invalid_argument);
    EXPECT_THROW(op->apply({}, {}), std::invalid_argument);
    EXPECT_EQ(op->applications(), 0);
  }
}

TEST(PartOf, RefusesFieldsThatHaveNotItsMirrors) {
  const Grid square{4, 4, 1.0, 1.0, true};
  EXPECT_EQ(part_of({4, 5, 1.0, 1.0}, coupling_kernel(), false), Part::whole);
  EXPECT_EQ(part_of(square, normal_kernel(), false), Part::quadrant);
  EXPECT_EQ(part_of(square, tangential_kernel(), true), Part::diagonal);
  EXPECT_THROW(part_of(square, coupling_kernel(), false), std::invalid_argument);
  EXPECT_THROW(part_of(square, {1, 1, {Component::k11}}, false), std::invalid_argument);
  EXPECT_THROW(part_of(square, normal_kernel(), true), std::invalid_argument);
  EXPECT_THROW(part_of({4, 4, 1.0, 1.0}, tangential_kernel(), true), std::invalid_argument);
  EXPECT_THROW(part_of({4, 5, 1.0, 1.0, true}, tangential_kernel(), true), std::invalid_argument);
  EXPECT_THROW(part_of({4, 4, 1.0, 0.5, true}, tangential_kernel(), true), std::invalid_argument);
  for (const OperatorKind kind : {OperatorKind::direct, OperatorKind::dense}) {
    EXPECT_THROW(make_operator(kind, square, tangential_kernel(), dissimilar_pair()), std::invalid_argument);
  }
}

TEST(Convolution, RefusesAKernelOfAnotherShape) {
  const BlockKernel mixed{2, 1, {Component::k13, Component::k33}};
  const BlockKernel wide{1, 2, {Component::k11, Component::k12}};
  for (const BlockKernel& kernel : {mixed, wide}) {
    EXPECT_THROW(make_operator(OperatorKind::dcfft, {4, 4, 1.0, 1.0}, kernel, dissimilar_pair()),
                 std::invalid_argument);
  }
}

}  // namespace
}  // namespace slipstick::solver
