#include "solver/elasticity/inverse_symbol.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "solver/allocations/allocations.hpp"
#include "solver/elasticity/tests/kernel_case.hpp"
#include "solver/fft/fftw.hpp"
#include "solver/grid/reduction.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr double kPi = std::numbers::pi;
/// Relative to the largest value: transforms of up to 2^14 values round by a few eps.
constexpr double kSymbolRounding = 1e-13;

/// Shear modulus 2 for both, so that S = 1, N = nu and C33 = 1 - nu.
HalfSpaces pair_of(double nu) { return HalfSpaces(elastic_pair({2.0, nu}, {2.0, nu})); }

void apply(InverseSymbol& symbol, Eigen::ArrayXd& field) {
  symbol.apply({field.data(), static_cast<std::size_t>(field.size())});
}

ArrayXd applied(InverseSymbol& symbol, ArrayXd field) {
  apply(symbol, field);
  return field;
}

/// Poisson's ratios, from auxetic to incompressible.
constexpr double kRatios[] = {-0.9, 0.0, 0.3, 0.5};

bool has_no_symbol(const KernelCase& tested) { return tested.kernel == coupling_kernel(); }

std::vector<KernelCase> symbol_cases() {
  std::vector<Grid> grids{{1, 1, 1.0, 1.0},   {1, 8, 1.0, 0.5},   {7, 1, 0.5, 1.0},   {2, 3, 1e-3, 1e-3},
                          {16, 16, 1.0, 1.0}, {9, 15, 1.0, 1.0},  {13, 17, 1.0, 2.0}, {37, 31, 1.0, 0.3},
                          {64, 48, 1.0, 1.5}, {5, 128, 1.0, 1.0}, {9, 9, 2.0, 2.0},   {13, 13, 0.1, 0.1}};
  std::vector<Grid> quadrants = grids;
  for (Grid& grid : quadrants) grid.quadrant = true;
  grids.insert(grids.end(), quadrants.begin(), quadrants.end());
  return cases_without(kernel_cases(grids), has_no_symbol);
}

class InverseSymbolOf : public testing::TestWithParam<KernelCase> {
 protected:
  std::unique_ptr<InverseSymbol> make(double nu = 0.3, std::span<double> memory = {}) const {
    return make_inverse_symbol(GetParam().grid, GetParam().kernel, pair_of(nu),
                               {.diagonal = GetParam().diagonal, .memory = memory});
  }
  /// One of the fields that the operator is for.
  ArrayXd random(unsigned seed) const {
    const ArrayXd field = random_field(GetParam().size(), seed);
    return GetParam().diagonal ? mirrored_about_diagonal(field, GetParam().grid.n1) : field;
  }
};

INSTANTIATE_TEST_SUITE_P(Shapes, InverseSymbolOf, testing::ValuesIn(symbol_cases()), testing::PrintToStringParamName());

/// On quadrants, without and with a mirror at the diagonal.
class QuadrantSymbol : public InverseSymbolOf {};
class DiagonalSymbol : public InverseSymbolOf {};

INSTANTIATE_TEST_SUITE_P(
    Shapes, QuadrantSymbol,
    testing::ValuesIn(cases_without(symbol_cases(), [](const KernelCase& tested) { return !tested.grid.quadrant; })),
    testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Shapes, DiagonalSymbol,
                         testing::ValuesIn(cases_without(symbol_cases(),
                                                         [](const KernelCase& tested) { return !tested.diagonal; })),
                         testing::PrintToStringParamName());

/// Also at the ends of the spectrum: signs that alternate, and no change at all.
TEST_P(InverseSymbolOf, IsSymmetricAndPositiveDefinite) {
  const auto& [name, grid, kernel, diagonal] = GetParam();
  ArrayXd rough(GetParam().size());
  for (Index i = 0; i < rough.size(); ++i) rough[i] = (i / grid.n2 + i % grid.n2) % 2 == 0 ? 1.0 : -1.0;
  for (const double nu : kRatios) {
    SCOPED_TRACE(nu);
    const auto symbol = make(nu);
    const ArrayXd x = random(1);
    const ArrayXd y = random(2);
    const ArrayXd Px = applied(*symbol, x);
    const ArrayXd Py = applied(*symbol, y);
    EXPECT_NEAR((x * Py).sum(), (y * Px).sum(), kSymbolRounding * std::sqrt((x * Px).sum() * (y * Py).sum()));
    for (ArrayXd field : {x, y, rough, ArrayXd(ArrayXd::Ones(GetParam().size()))}) {
      if (diagonal) field = mirrored_about_diagonal(field, grid.n1);
      EXPECT_GT((field * applied(*symbol, field)).sum(), 0.0);
    }
  }
}

TEST_P(InverseSymbolOf, IsLinearRemembersNothingAndAllocatesNothing) {
  const long before_setup = allocations();
  const auto symbol = make();
  EXPECT_GT(allocations(), before_setup) << "the count itself must work";
  const ArrayXd x = random(3);
  const ArrayXd y = random(4);
  const ArrayXd Px = applied(*symbol, x);
  const ArrayXd separately = 2.5 * Px - 0.75 * applied(*symbol, y);
  EXPECT_LE(relative_difference(applied(*symbol, 2.5 * x - 0.75 * y), separately), kSymbolRounding);
  ArrayXd again = x;
  const long before = allocations();
  apply(*symbol, again);
  EXPECT_EQ(allocations(), before);
  EXPECT_TRUE((again == Px).all());
}

/// The memory's previous content does not matter, and the part that is left keeps it.
TEST_P(InverseSymbolOf, HasTheSameBitsInMemoryThatItIsGiven) {
  FftwBuffer memory(1 << 16);
  const std::span<double> all(memory.data(), 1 << 16);
  const auto symbol = make(0.3, all);
  for (const ArrayXd& x : {random(5), random(6)}) {
    std::ranges::fill(all, std::numeric_limits<double>::quiet_NaN());
    EXPECT_TRUE((applied(*symbol, x) == applied(*make(), x)).all());
    EXPECT_TRUE(std::ranges::all_of(symbol->idle_memory(), [](double value) { return std::isnan(value); }));
  }
  const std::size_t size = scratch_size(GetParam().grid, GetParam().kernel, {.diagonal = GetParam().diagonal});
  EXPECT_EQ(make(0.3, all.first(size))->idle_memory().size(), size > 0 ? GetParam().size() : 0);
}

TEST_P(InverseSymbolOf, RefusesFieldsOfAnotherSize) {
  const auto symbol = make();
  std::vector<double> values(static_cast<std::size_t>(GetParam().size()) + 1);
  const std::span<double> field(values);
  EXPECT_THROW(symbol->apply(field), std::invalid_argument);
  EXPECT_THROW(symbol->apply(field.first(values.size() - 2)), std::invalid_argument);
  EXPECT_THROW(symbol->apply({}), std::invalid_argument);
}

/// Plane waves along and across their direction are eigenfunctions, with |xi|/(S - N) and |xi|/S; plane waves
/// of pressure with |xi|/C33.
TEST(PlaneWave, IsMultipliedByTheInverseSymbol) {
  const Grid grid{24, 40, 0.5, 0.8};
  const double nu = 0.3;
  const auto tangential = make_inverse_symbol(grid, tangential_kernel(), pair_of(nu));
  const auto normal = make_inverse_symbol(grid, normal_kernel(), pair_of(nu));
  for (const auto& [f1, f2] : {std::pair<Index, Index>{1, 0}, {0, 1}, {3, 5}, {-4, 7}, {11, -19}, {-2, -2}}) {
    const double xi1 = 2.0 * kPi * static_cast<double>(f1) / (24.0 * grid.h1);
    const double xi2 = 2.0 * kPi * static_cast<double>(f2) / (40.0 * grid.h2);
    const double xi = std::hypot(xi1, xi2);
    ArrayXd wave(grid.cells());
    for (Index i = 0; i < grid.n1; ++i) {
      for (Index j = 0; j < grid.n2; ++j) {
        wave[i * grid.n2 + j] =
            std::cos(2.0 * kPi * (static_cast<double>(f1 * i) / 24.0 + static_cast<double>(f2 * j) / 40.0 + 0.2));
      }
    }
    ArrayXd longitudinal(2 * grid.cells());
    longitudinal << xi1 * wave, xi2 * wave;
    ArrayXd transverse(2 * grid.cells());
    transverse << -xi2 * wave, xi1 * wave;
    EXPECT_LE(relative_difference(applied(*tangential, longitudinal), xi / (1.0 - nu) * longitudinal), kSymbolRounding);
    EXPECT_LE(relative_difference(applied(*tangential, transverse), xi * transverse), kSymbolRounding);
    EXPECT_LE(relative_difference(applied(*normal, wave), xi / (1.0 - nu) * wave), kSymbolRounding);
  }
}

/// A constant field is multiplied as half of the lowest frequency would be across its direction.
TEST(ConstantField, IsMultipliedByHalfOfTheSmallestFrequency) {
  const Grid grid{24, 40, 0.5, 0.8};
  const double xi = 0.5 * 2.0 * kPi / (40.0 * 0.8);
  const ArrayXd ones = ArrayXd::Ones(2 * grid.cells());
  const auto tangential = make_inverse_symbol(grid, tangential_kernel(), pair_of(0.3));
  EXPECT_LE(relative_difference(applied(*tangential, ones), xi * ones), kSymbolRounding);
  const auto normal = make_inverse_symbol(grid, normal_kernel(), pair_of(0.3));
  EXPECT_LE(relative_difference(applied(*normal, ones.head(grid.cells())), xi / 0.7 * ones.head(grid.cells())),
            kSymbolRounding);
}

/// The response of one loaded cell at that cell.
TEST(InverseSymbolDiagonal, IsThatOfTheOperator) {
  for (const Grid& grid : {Grid{24, 40, 0.5, 0.8}, Grid{28, 10, 1.0, 0.2}}) {
    Grid quadrant{grid.n1 / 2, grid.n2 / 2, grid.h1, grid.h2, true};
    for (const BlockKernel& kernel : {normal_kernel(), tangential_kernel()}) {
      const auto symbol = make_inverse_symbol(grid, kernel, pair_of(0.3));
      const auto mirrored = make_inverse_symbol(quadrant, kernel, pair_of(0.3));
      for (std::size_t field = 0; field < kernel.inputs; ++field) {
        const Index cell = static_cast<Index>(field) * grid.cells() + 3 * grid.n2 + 5;
        ArrayXd one = ArrayXd::Zero(static_cast<Index>(kernel.inputs) * grid.cells());
        one[cell] = 1.0;
        const double expected = applied(*symbol, one)[cell];
        EXPECT_NEAR(symbol->diagonal()[field] / expected, 1.0, kSymbolRounding);
        EXPECT_NEAR(mirrored->diagonal()[field] / expected, 1.0, kSymbolRounding);
      }
    }
  }
}

TEST_P(QuadrantSymbol, IsThatOfTheWholeGrid) {
  const Grid& grid = GetParam().grid;
  const ArrayXd field = random(7);
  for (const double nu : kRatios) {
    const auto whole =
        make_inverse_symbol({2 * grid.n1, 2 * grid.n2, grid.h1, grid.h2}, GetParam().kernel, pair_of(nu));
    const Symmetry symmetry = GetParam().tangential() ? torsion_symmetry() : normal_symmetry();
    EXPECT_LE(relative_difference(unfold(grid, applied(*make(nu), field), symmetry),
                                  applied(*whole, unfold(grid, field, symmetry))),
              kSymbolRounding)
        << nu;
  }
}

TEST_P(DiagonalSymbol, KeepsTheSymmetryExactly) {
  const Grid& grid = GetParam().grid;
  for (const double nu : kRatios) {
    const ArrayXd result = applied(*make(nu), random(8));
    EXPECT_TRUE((result == mirrored_about_diagonal(result, grid.n1)).all()) << nu;
    const auto quadrant = make_inverse_symbol(grid, GetParam().kernel, pair_of(nu));
    EXPECT_LE(relative_difference(result, applied(*quadrant, random(8))), kSymbolRounding) << nu;
  }
}

TEST(InverseSymbol, RefusesOtherKernelsAndSymmetries) {
  const Grid square{8, 8, 1.0, 1.0, true};
  for (const BlockKernel& kernel : {coupling_kernel(), BlockKernel{1, 1, {Component::k11}}}) {
    EXPECT_THROW(make_inverse_symbol({8, 8, 1.0, 1.0}, kernel, pair_of(0.3)), std::invalid_argument);
    EXPECT_THROW(make_inverse_symbol(square, kernel, pair_of(0.3)), std::invalid_argument);
  }
  EXPECT_THROW(make_inverse_symbol(square, normal_kernel(), pair_of(0.3), {.diagonal = true}), std::invalid_argument);
}

}  // namespace
}  // namespace slipstick::solver
