// Errors in the paper's discrete equations as printed, each compared with the correct equation.

#include <gtest/gtest.h>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr double kRoundingOfErrata = 1e-13;

class PrintedRotation : public testing::Test {
 protected:
  const Grid grid_{24, 24, 0.1, 0.1};
  const ArrayXd x1_ = cell_x1(grid_);
  const ArrayXd x2_ = cell_x2(grid_);
  const ArrayXd rotation_ = rotation_field(grid_);
  // Eqs. (8), (9), (13)-(16), (24), (25) as printed: (x2, x1).
  const ArrayXd printed_ = (ArrayXd(2 * grid_.cells()) << x2_, x1_).finished();
};

/// The gradient of a linear field: a rotation's is antisymmetric, a shear's symmetric.
TEST_F(PrintedRotation, IsAShearThatMovesNoPointAsARotationDoes) {
  const Index here = grid_.cells() / 2;
  const auto gradient_12 = [&](const ArrayXd& u) { return (u[here + 1] - u[here]) / 0.1; };
  const auto gradient_21 = [&](const ArrayXd& u) {
    return (u[grid_.cells() + here + grid_.n2] - u[grid_.cells() + here]) / 0.1;
  };
  EXPECT_NEAR(gradient_12(rotation_), -gradient_21(rotation_), kRoundingOfErrata);
  EXPECT_NEAR(gradient_12(printed_), gradient_21(printed_), kRoundingOfErrata);
  EXPECT_NEAR(gradient_12(printed_), 1.0, kRoundingOfErrata);
}

/// Eq. (9) of a torsional traction, any function of the radius times (-x2, x1); Eq. (16) of a rigid rotation.
TEST_F(PrintedRotation, FindsNoMomentInATorsionalTractionAndNoTwistInARotation) {
  const ArrayXd torsion = (-(x1_.square() + x2_.square())).exp().replicate(2, 1) * rotation_;
  const double moment = (torsion * rotation_).sum();
  EXPECT_GT(moment, 1.0);
  EXPECT_NEAR((torsion * printed_).sum() / moment, 0.0, kRoundingOfErrata);
  EXPECT_NEAR((rotation_ * printed_).sum() / printed_.square().sum(), 0.0, kRoundingOfErrata);
}

// Eqs. (16) and (25) as printed lack the sum in the denominator: what they give depends on the cell, and
// grows with the number of cells.
TEST_F(PrintedRotation, InEquation16NeedsTheSumInTheDenominator) {
  constexpr double phi = 0.7;
  const double numerator = (phi * rotation_ * rotation_).sum();
  const ArrayXd by_cell = numerator / (x1_.square() + x2_.square());
  EXPECT_GT(by_cell.maxCoeff(), 100.0 * by_cell.minCoeff());
  EXPECT_GT(by_cell.minCoeff(), 100.0 * phi);
  EXPECT_NEAR(numerator / (x1_.square() + x2_.square()).sum(), phi, kRoundingOfErrata);
}

}  // namespace
}  // namespace slipstick::solver
