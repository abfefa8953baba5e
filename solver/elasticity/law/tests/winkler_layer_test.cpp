#include "solver/elasticity/law/winkler_layer.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "solver/elasticity/direct.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr double kNormal = 0.7;
constexpr double kTangential = 0.4;
/// Between an operator and another plus c q, relative to the largest displacement: roundings of transforms.
constexpr double kTransforms = 1e-13;

SharedLaw bodies() { return half_spaces({1.0, 0.3}, {2.5, 0.1}); }
WinklerLayer layered() { return {bodies(), kNormal, kTangential}; }

/// The layer's own part of the displacement of the loaded cell.
double added(const BlockKernel& kernel) {
  return kernel == normal_kernel() ? kNormal : kernel == tangential_kernel() ? kTangential : 0.0;
}

TEST(WinklerLayer, AddsItsComplianceToTheDiagonalOfTheMatrix) {
  const Grid grid{5, 4, 1.0, 0.6};
  for (const BlockKernel& kernel : {normal_kernel(), tangential_kernel(), coupling_kernel(), shear_kernel()}) {
    const DenseMatrix with(grid, kernel, layered());
    Eigen::MatrixXd expected = DenseMatrix(grid, kernel, *bodies()).matrix();
    expected.diagonal().array() += added(kernel);
    EXPECT_TRUE((with.matrix().array() == expected.array()).all());
    if (kernel.inputs != kernel.outputs) continue;
    EXPECT_EQ(with.matrix(), with.matrix().transpose());
  }
}

TEST(WinklerLayer, HasTheSameComplianceForSmoothCellTractions) {
  const auto smooth = std::make_shared<HalfSpaces>(elastic_pair({1.0, 0.3}, {2.5, 0.1}), CellTraction::smooth);
  const Grid offsets{4, 4, 1.0, 1.0};
  auto expected = smooth->influence_coefficients(Component::k33, offsets);
  expected.front() += kNormal;
  EXPECT_EQ(WinklerLayer(smooth, kNormal, kTangential).influence_coefficients(Component::k33, offsets), expected);
}

const std::vector<PlaneWave> kWaves{
    {0.0, 0.0, 0.1}, {0.3, 0.0, 0.3}, {0.0, 2.0, 2.0}, {0.5, -1.2, 1.3}, {3.0, 4.0, 5.0}};

TEST(WinklerLayer, AddsItsComplianceToTheSymbol) {
  for (const double softer : {1.0, 1e6}) {
    const WinklerLayer layer(bodies(), softer * kNormal, softer * kTangential);
    std::vector<Symbol> with(kWaves.size()), without(kWaves.size());
    const auto matrix = [](const Symbol& s) { return Eigen::Matrix2d{{s[0], s[1]}, {s[1], s[2]}}; };
    layer.inverse_symbols(true, 1.0, 1.0, kWaves, with);
    bodies()->inverse_symbols(true, 1.0, 1.0, kWaves, without);
    for (std::size_t i = 0; i < kWaves.size(); ++i) {
      const Eigen::Matrix2d sum = matrix(without[i]).inverse() + softer * kTangential * Eigen::Matrix2d::Identity();
      EXPECT_TRUE((matrix(with[i]) * sum).isApprox(Eigen::Matrix2d::Identity(), 1e-12)) << i;
    }
    layer.inverse_symbols(false, 1.0, 1.0, kWaves, with);
    bodies()->inverse_symbols(false, 1.0, 1.0, kWaves, without);
    for (std::size_t i = 0; i < kWaves.size(); ++i) {
      EXPECT_NEAR(with[i][0] * (1.0 / without[i][0] + softer * kNormal), 1.0, 1e-14);
      EXPECT_EQ(with[i][1], 0.0);
      EXPECT_EQ(with[i][2], 0.0);
    }
  }
}

/// Each way to sum, on each part of a grid.
TEST(WinklerLayer, AddsItsDisplacementHoweverTractionsAreSummed) {
  struct Case {
    OperatorKind kind;
    Grid grid;
    bool diagonal;
  };
  for (const auto& [kind, grid, diagonal] :
       {Case{OperatorKind::dcfft, {13, 9, 1.0, 0.7}, false}, Case{OperatorKind::direct, {13, 9, 1.0, 0.7}, false},
        Case{OperatorKind::dense, {6, 5, 1.0, 0.7}, false}, Case{OperatorKind::dcfft, {13, 9, 1.0, 0.7, true}, false},
        Case{OperatorKind::dcfft, {11, 11, 0.5, 0.5, true}, true}}) {
    for (const BlockKernel& kernel : {normal_kernel(), tangential_kernel()}) {
      const OperatorOptions options{.threads = 1, .diagonal = diagonal && kernel.inputs == 2};
      ArrayXd q = random_field(static_cast<Index>(kernel.inputs) * grid.cells(), 1);
      if (options.diagonal) q = mirrored_about_diagonal(q, grid.n1);
      const ArrayXd u = applied(*make_operator(kind, grid, kernel, layered(), options), q);
      const ArrayXd without = applied(*make_operator(kind, grid, kernel, *bodies(), options), q);
      EXPECT_LE(relative_difference(u, without + added(kernel) * q), kTransforms);
    }
  }
}

TEST(WinklerLayer, RaisesTheLeastEigenvalueByItsCompliance) {
  const Grid grid{8, 8, 1.0, 0.5};
  const DenseMatrix op(grid, tangential_kernel(), layered());
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(op.matrix()).eigenvalues().minCoeff();
  EXPECT_LT(layered().least_eigenvalue(grid.h1, grid.h2), least);
  EXPECT_GT(layered().least_eigenvalue(grid.h1, grid.h2), kTangential);
}

TEST(WinklerLayer, CouplesAsItsBodiesDo) {
  EXPECT_TRUE(layered().couples());
  EXPECT_FALSE(WinklerLayer(half_spaces({1.0, 0.3}, {1.0, 0.3}), kNormal, kTangential).couples());
}

TEST(WinklerLayer, HasAKeyOfItsOwnForEachCompliance) {
  const auto key = [](double normal, double tangential) {
    CacheKey made("law");
    WinklerLayer(bodies(), normal, tangential).add_to(made);
    return made;
  };
  EXPECT_EQ(key(1.0, 2.0), key(1.0, 2.0));
  EXPECT_NE(key(1.0, 2.0), key(2.0, 1.0));
  CacheKey without("law");
  bodies()->add_to(without);
  EXPECT_NE(key(0.0, 0.0), without);
}

}  // namespace
}  // namespace slipstick::solver
