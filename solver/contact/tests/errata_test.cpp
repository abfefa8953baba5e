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
  const Index cells_ = grid_.cells();
  const ArrayXd rotation_ = rotation_field(grid_);
  // Eqs. (8), (9), (13)-(16), (24), (25) as printed: (x2, x1).
  const ArrayXd printed_ = [this] {
    ArrayXd field(2 * cells_);
    field << x2_, x1_;
    return field;
  }();
  // A torsional traction field, any function of the radius times (-x2, x1).
  const ArrayXd torsion_ = [this] {
    const ArrayXd profile = (-(x1_.square() + x2_.square())).exp();
    return (profile.replicate(2, 1) * rotation_).eval();
  }();
};

TEST_F(PrintedRotation, IsAShearThatMovesNoPointAsARotationDoes) {
  // Forward differences of a linear field are its gradient: a rotation is antisymmetric, a shear symmetric.
  const auto gradient = [&](const ArrayXd& field, int component, int along) {
    const Index here = cells_ / 2;
    const Index next = along == 1 ? here + grid_.n2 : here + 1;
    const auto part = field.segment((component - 1) * cells_, cells_);
    return (part[next] - part[here]) / 0.1;
  };
  EXPECT_NEAR(gradient(rotation_, 1, 2), -gradient(rotation_, 2, 1), kRoundingOfErrata);
  EXPECT_NEAR(gradient(printed_, 1, 2), gradient(printed_, 2, 1), kRoundingOfErrata);
  EXPECT_NEAR(gradient(printed_, 1, 2), 1.0, kRoundingOfErrata);
}

TEST_F(PrintedRotation, InEquation9FindsNoMomentInATorsionalTraction) {
  const double moment = (torsion_ * rotation_).sum();
  EXPECT_GT(moment, 1.0);
  EXPECT_NEAR((torsion_ * printed_).sum() / moment, 0.0, kRoundingOfErrata);
}

TEST_F(PrintedRotation, InEquation16FindsNoTwistInARigidRotation) {
  constexpr double phi = 0.7;
  const ArrayXd u = phi * rotation_;
  EXPECT_NEAR((u * rotation_).sum() / rotation_.square().sum(), phi, kRoundingOfErrata);
  EXPECT_NEAR((u * printed_).sum() / printed_.square().sum(), 0.0, kRoundingOfErrata);
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
