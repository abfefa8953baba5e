#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "solver/contact/certificate.hpp"
#include "solver/contact/coulomb_method.hpp"
#include "solver/contact/normal_contact.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/scene/roughness.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr double kModulus = 1.0;  // E*
constexpr double kSlope = 0.1;

/// A square body with a self-affine face down to waves of four cells, whose contact may reach its edges.
struct RoughFace {
  explicit RoughFace(Index cells)
      : grid{cells, cells, 1.0, 1.0},
        gap(roughness_heights({.seed = 1,
                               .hurst = 0.8,
                               .longest = 0.25 * static_cast<double>(cells),
                               .shortest = 4.0,
                               .rms_slope = kSlope,
                               .period = static_cast<double>(cells)},
                              grid)) {
    gap -= gap.minCoeff();
  }

  /// Under a mean pressure, in units of E* times the slope.
  NormalSolution pressed(double pressure) const {
    return solve_normal_contact(elasticity, grid, {gap, load(pressure)});
  }
  double load(double pressure) const { return pressure * kModulus * kSlope * static_cast<double>(grid.cells()); }

  Elasticity elasticity{.law = half_spaces({0.7 * kModulus, 0.3}, {0.7 * kModulus, 0.3}), .at_edge = true};
  Grid grid;
  ArrayXd gap;
};

/// At most, on any mesh.
constexpr double kMostApplications = 60.0;
constexpr double kTractionApplications = 45.0;
constexpr double kTolerance = 1e-10;
constexpr double kRounding = 1e-12;

TEST(RoughContact, TakesFewApplicationsAtAnyContactFraction) {
  const RoughFace face(128);
  const auto op = face.elasticity.make(face.grid, normal_kernel());
  double last = 0.0;
  for (const double pressure : {0.0005, 0.005, 0.03, 0.1, 0.25, 0.45, 0.8, 1.5, 3.0, 8.0}) {
    SCOPED_TRACE(pressure);
    const NormalSolution found = face.pressed(pressure);
    EXPECT_EQ(found.status, Status::converged) << found.message;
    EXPECT_LE(finest_grid_applications(found.grids), kMostApplications);
    const ArrayXd& p = found.pressure;
    const ArrayXd u = op->applied(p);
    const ArrayXd opening = u + face.gap;
    EXPECT_GE(p.minCoeff(), 0.0);
    EXPECT_NEAR(p.sum() / face.load(pressure), 1.0, kRounding);
    EXPECT_LE((p * (opening - opening.minCoeff())).sum(), (kTolerance + kRounding) * 0.5 * (p * u).sum());
    const auto fraction = static_cast<double>((p > 0.0).count()) / static_cast<double>(face.grid.cells());
    EXPECT_GT(fraction, last);
    if (last == 0.0) {
      EXPECT_LT(fraction, 0.003);
    }
    last = fraction;
  }
  EXPECT_EQ(last, 1.0);
}

/// Tractions on a body of many spots, at parts of the force that they carry: to next to none, where nothing slips and
/// the problem is linear, and to nearly all. Where residuals end at the edges of spots the first takes 50.
TEST(RoughContact, TakesFewApplicationsUnderATangentialForce) {
  const RoughFace face(128);
  const ArrayXd bound = 0.3 * face.pressed(0.1).pressure;
  const auto op = face.elasticity.make(face.grid, tangential_kernel());
  const ArrayXd rotation = rotation_field(face.grid);
  for (const double part : {1e-6, 0.1, 0.5, 0.9}) {
    SCOPED_TRACE(part);
    const TangentialSolution found = solve_by_coulomb_method(
        face.elasticity, face.grid, {.friction_bound = bound, .moment = 0.0, .force = {{part * bound.sum(), 0.0}}});
    EXPECT_EQ(found.status, Status::converged) << found.message;
    EXPECT_LE(finest_grid_applications(found.grids), kTractionApplications);
    EXPECT_NEAR(found.traction.head(bound.size()).sum() / (part * bound.sum()), 1.0, 1e-9);
    const ArrayXd u = op->applied(found.traction);
    ArrayXd motion = found.twist * rotation;
    motion.head(bound.size()) += found.displacement[0];
    motion.tail(bound.size()) += found.displacement[1];
    const ArrayXd slip = (bound > 0.0).cast<double>().replicate(2, 1) * (u - motion);
    EXPECT_LE(certify({found.traction, u, slip}, bound, rotation, 0.0).gap, 1e-8);
  }
}

/// Then there is no inequality left: K p + h is the approach everywhere.
TEST(RoughContact, FullContactIsALinearSystem) {
  const RoughFace face(16);
  const auto op = face.elasticity.make(face.grid, normal_kernel());
  const Index n = face.grid.cells();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + 1, n + 1);
  for (Index j = 0; j < n; ++j) {
    matrix.col(j).head(n) = op->applied(Eigen::VectorXd::Unit(n, j).array());
    matrix(n, j) = 1.0;
    matrix(j, n) = -1.0;
  }
  const double pressure = 8.0;
  Eigen::VectorXd right(n + 1);
  right << -face.gap.matrix(), face.load(pressure);
  const Eigen::VectorXd exact = matrix.partialPivLu().solve(right);
  const NormalSolution found = face.pressed(pressure);
  ASSERT_TRUE((exact.head(n).array() > 0.0).all());
  // The gap is of first order in the residual, so that the pressure's error is of its size.
  constexpr double kError = 1e-8;
  EXPECT_LT((found.pressure - exact.head(n).array()).abs().maxCoeff(), kError * exact.head(n).maxCoeff());
  EXPECT_NEAR(found.approach / exact[n], 1.0, kError);
}

}  // namespace
}  // namespace slipstick::solver
