#include "solver/elasticity/convolution.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>

#include "solver/fft/padded_transform.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Complex = std::complex<double>;

/// A few roundings in each of some ten stages, relative to the largest value.
constexpr double kTransformRounding = 1e-14;

/// One cell, one row, one column; lengths whose padded half is odd, even, and longer than the grid.
const std::vector<Grid>& shapes() {
  static const std::vector<Grid> grids{{1, 1, 1.0, 1.0},   {1, 7, 1.0, 1.0},  {7, 1, 0.5, 1.0},
                                       {2, 3, 1e-3, 1e-3}, {3, 5, 1.0, 1.0},  {11, 3, 1.0, 1.0},
                                       {13, 17, 1.0, 2.0}, {25, 20, 1.0, 1.0}};
  return grids;
}

std::string name(const Grid& grid) { return std::to_string(grid.n1) + " x " + std::to_string(grid.n2); }

std::span<double> span_of(Eigen::ArrayXd& field) {
  return {field.data(), static_cast<std::size_t>(field.size())};
}

/// The transform by its definition, at one pair of frequencies.
Complex plain_sum(const Grid& grid, const double* field, Index p1, Index p2, Index f1, Index f2) {
  Complex sum = 0.0;
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) {
      const double turns = static_cast<double>(i * f1 % p1) / static_cast<double>(p1) +
                           static_cast<double>(j * f2 % p2) / static_cast<double>(p2);
      sum += field[i * grid.n2 + j] * std::polar(1.0, -2.0 * std::numbers::pi * turns);
    }
  }
  return sum;
}

TEST(PaddedTransform, IsThePlainSumAtEachFrequency) {
  for (const Grid& grid : shapes()) {
    SCOPED_TRACE(name(grid));
    PaddedTransform transform(grid, 2, 1);
    const Index p1 = transform.padded1();
    const Index p2 = transform.padded2();
    Eigen::ArrayXd fields = random_field(2 * grid.cells(), 1);
    transform.forward_rows(span_of(fields));
    const Index evens = p2 / 4 + 1;
    double worst = 0.0;
    transform.through_columns(2, 0, [&](Index column, const PaddedTransform::Spectrum& spectrum) {
      const Index f2 = column < evens ? 2 * column : 2 * (column - evens) + 1;
      for (Index f1 = 0; f1 < p1; ++f1) {
        for (std::size_t field = 0; field < 2; ++field) {
          const Complex computed = (f1 % 2 == 0 ? spectrum.even : spectrum.odd)[field][f1 / 2];
          const double* const values = fields.data() + static_cast<Index>(field) * grid.cells();
          worst = std::max(worst, std::abs(computed - plain_sum(grid, values, p1, p2, f1, f2)));
        }
      }
    });
    EXPECT_EQ(transform.columns(), p2 / 2 + 1);
    EXPECT_LE(worst, kTransformRounding * static_cast<double>(grid.cells()));
  }
}

TEST(PaddedTransform, ThereAndBackMultipliesByThePaddedSize) {
  for (const Grid& grid : shapes()) {
    for (const int threads : {1, 3}) {
      SCOPED_TRACE(name(grid));
      PaddedTransform transform(grid, 2, threads);
      const auto padded = static_cast<double>(transform.padded1() * transform.padded2());
      const Eigen::ArrayXd fields = random_field(2 * grid.cells(), 2);
      for (int time = 0; time < 2; ++time) {  // the first must leave nothing behind
        Eigen::ArrayXd back = fields;
        transform.forward_rows(span_of(back));
        transform.through_columns(2, 2, [](Index, const auto&) {});
        transform.backward_rows(span_of(back));
        EXPECT_LE((back / padded - fields).abs().maxCoeff(), kTransformRounding);
      }
    }
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
