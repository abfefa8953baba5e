#include "solver/contact/coulomb_method.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "docs/extend/examples/method.hpp"
#include "solver/tests/torsion_bench.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// An ellipse's friction bounds and whatever its torsion is compared with.
struct CoulombBench {
  CoulombBench(Index n1, Index n2, double h2 = 1.0)
      : grid{n1, n2, 1.0, h2},
        bound((1.0 - (cell_x1(grid) / (0.5 * static_cast<double>(n1) - 1.3)).square() -
               (cell_x2(grid) / (h2 * (0.5 * static_cast<double>(n2) - 1.3))).square())
                  .max(0.0)
                  .sqrt()),
        limit(moment_limit(grid, bound)) {}

  TangentialSolution solve(double moment_ratio, double tolerance = 1e-8) const {
    return solve_by_coulomb_method(elasticity, grid, under_moment(bound, moment_ratio * limit),
                                   {.tolerance = tolerance});
  }
  TangentialSolution solve_twist(double twist, double tolerance = 1e-8) const {
    return solve_by_coulomb_method(elasticity, grid, under_twist(bound, twist), {.tolerance = tolerance});
  }
  double moment_of(const TangentialSolution& solution) const {
    return (solution.traction * rotation_field(grid)).sum();
  }

  Grid grid;
  ArrayXd bound;
  double limit;
  Elasticity elasticity{half_spaces({2.0, 0.3}, {2.0, 0.3})};
};

/// K q and the slip afresh, by direct summation.
Certificate independent_certificate(const CoulombBench& bench, const TangentialSolution& solution, double moment) {
  const auto op = make_operator(OperatorKind::direct, bench.grid, tangential_kernel(), *bench.elasticity.law);
  const ArrayXd u = op->applied(solution.traction);
  const ArrayXd contact = (bench.bound > 0.0).cast<double>().replicate(2, 1);
  const ArrayXd slip = contact * (u - solution.twist * rotation_field(bench.grid));
  return certify({solution.traction, u, slip}, bench.bound, rotation_field(bench.grid), moment);
}

/// No load, no motion: nothing is solved, and all of the contact sticks.
TEST(CoulombMethod, DoesNothingWhereNothingIsAsked) {
  const CoulombBench bench(16, 12);
  for (const TangentialSolution& solution : {bench.solve(0.0), bench.solve_twist(0.0)}) {
    EXPECT_EQ(solution.status, Status::converged);
    EXPECT_TRUE(solution.grids.empty());
    EXPECT_TRUE((solution.traction == 0.0).all());
    EXPECT_EQ(solution.twist, 0.0);
    EXPECT_TRUE((solution.stick == (bench.bound > 0.0).cast<double>()).all());
  }
}

// --- the certificate ---

struct GridShape {
  Index n1;
  Index n2;
  double h2;
};
void PrintTo(const GridShape& shape, std::ostream* stream) {
  *stream << shape.n1 << " x " << shape.n2 << ", h2 " << shape.h2;
}
class Certified : public testing::TestWithParam<std::tuple<GridShape, double>> {};
INSTANTIATE_TEST_SUITE_P(Contacts, Certified,
                         testing::Combine(testing::Values(GridShape{40, 40, 1.0}, GridShape{41, 37, 1.0},
                                                          GridShape{48, 24, 1.0}, GridShape{160, 8, 1.0},
                                                          GridShape{32, 32, 0.05}, GridShape{5, 5, 1.0}),
                                          testing::Values(0.01, 0.1, 0.5, 0.9, 0.99, 0.999)));

TEST_P(Certified, ToTheToleranceAskedForByDirectSummation) {
  const auto [shape, moment_ratio] = GetParam();
  const CoulombBench bench(shape.n1, shape.n2, shape.h2);
  for (const double tolerance : {1e-8, 1e-12}) {
    const TangentialSolution solution = bench.solve(moment_ratio, tolerance);
    ASSERT_EQ(solution.status, Status::converged) << solution.message;
    const Certificate certificate = independent_certificate(bench, solution, moment_ratio * bench.limit);
    EXPECT_LE(certificate.gap, tolerance + 1e-13);
    EXPECT_LE(certificate.moment, kRounding);
    EXPECT_LE(certificate.friction_bound, kRounding);
    EXPECT_LE(certificate.force, kRounding);
  }
}

/// Coulomb's law cell by cell, without certify().
TEST(Coulomb, HoldsInEachCell) {
  const CoulombBench bench(48, 24);
  const TangentialSolution solution = bench.solve(0.7, 1e-13);
  const ArrayXd slip = norms(solution.slip);
  const double largest_slip = slip.maxCoeff();
  for (Index i = 0; i < bench.grid.cells(); ++i) {
    const double q = std::hypot(solution.traction[i], solution.traction[i + bench.grid.cells()]);
    if (solution.stick[i] > 0.0) {
      EXPECT_LE(slip[i], 1e-9 * largest_slip);
      EXPECT_LT(q, bench.bound[i]);
    } else if (bench.bound[i] > 0.0) {
      EXPECT_NEAR(q / bench.bound[i], 1.0, kRounding);
    } else {
      EXPECT_EQ(q, 0.0);
    }
  }
  EXPECT_LE(slip_direction(solution.traction, solution.slip).max, 1e-4);
  EXPECT_GT((solution.stick > 0.0).count(), 50);
}

// --- an independent method ---

/// Under the ellipse's torsion, also where the pressure has moved the surfaces towards the centre.
class AgainstPlainGradient : public testing::TestWithParam<std::tuple<double, double>> {};
INSTANTIATE_TEST_SUITE_P(MomentRatios, AgainstPlainGradient,
                         testing::Combine(testing::Values(0.1, 0.5, -0.5, 0.9, 0.99), testing::Values(0.0, 0.01)));

TEST_P(AgainstPlainGradient, TheMinimumIsTheSame) {
  const auto [moment_ratio, inward] = GetParam();
  const CoulombBench bench(28, 16);
  const auto op = bench.elasticity.make(bench.grid, tangential_kernel());
  TangentialProblem problem = under_moment(bench.bound, moment_ratio * bench.limit);
  problem.initial_displacement.resize(2 * bench.grid.cells());
  problem.initial_displacement << -inward * cell_x1(bench.grid), -inward * cell_x2(bench.grid);
  const TangentialSolution slow = example::solve_by_plain_gradient(*op, problem, 1e-10, 20000);
  ASSERT_EQ(slow.status, Status::converged) << slow.message;
  const TangentialSolution fast = solve_by_coulomb_method(bench.elasticity, bench.grid, problem, {.tolerance = 1e-12});
  // |q - q*|_K^2 <= 2 gap: in the energy's norm 1e-5, in the largest traction somewhat more.
  EXPECT_LE(relative_difference(slow.traction, fast.traction), 1e-4);
  EXPECT_NEAR(slow.twist / fast.twist, 1.0, 1e-6);
}

// --- loads ---

TEST(CoulombLoads, AMomentAndItsTwistAreOneState) {
  const CoulombBench bench(32, 20);
  for (const double moment_ratio : {0.05, 0.5, 0.95}) {
    const TangentialSolution by_moment = bench.solve(moment_ratio, 1e-12);
    const TangentialSolution by_twist = bench.solve_twist(by_moment.twist, 1e-12);
    ASSERT_EQ(by_twist.status, Status::converged) << by_twist.message;
    EXPECT_EQ(by_twist.twist, by_moment.twist);
    EXPECT_NEAR(bench.moment_of(by_twist) / bench.limit, moment_ratio, 1e-9);
    EXPECT_LE(relative_difference(by_twist.traction, by_moment.traction), 1e-5);
  }
}

TEST(CoulombWork, ThatDoesNotSufficeIsSaidWithTheGapThatIsLeft) {
  const CoulombBench bench(24, 24);
  const TangentialProblem problem = under_moment(bench.bound, 0.5 * bench.limit);
  const TangentialSolution cut =
      solve_by_coulomb_method(bench.elasticity, bench.grid, problem, {.tolerance = 1e-12, .max_applications = 2});
  EXPECT_EQ(cut.status, Status::not_converged);
  EXPECT_NE(cut.message.find(fmt::format("gap / energy {:.3g}, tolerance 1e-12", cut.change)), std::string::npos)
      << cut.message;
  EXPECT_EQ(bench.solve(0.5).message, "");
}

/// A twist has no limit: all but the middle slips.
TEST(CoulombLoads, AHugeTwistNearlyReachesTheLimit) {
  const CoulombBench bench(31, 31);
  const TangentialSolution solution = bench.solve_twist(100.0);
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_NEAR(bench.moment_of(solution) / bench.limit, 1.0, 1e-6);
  EXPECT_LE((solution.stick > 0.0).count(), 1);
}

/// The pressure's displacement (dissimilar bodies) enters as in Eq. (12): a rigid rotation in it is a twist.
TEST(CoulombLoads, AnInitialRotationShiftsTheTwist) {
  const CoulombBench bench(30, 22);
  TangentialProblem problem = under_moment(bench.bound, 0.6 * bench.limit);
  const TangentialSolution plain = bench.solve(0.6, 1e-12);
  problem.initial_displacement = 0.25 * rotation_field(bench.grid);
  const TangentialSolution shifted =
      solve_by_coulomb_method(bench.elasticity, bench.grid, problem, {.tolerance = 1e-12});
  ASSERT_EQ(shifted.status, Status::converged) << shifted.message;
  EXPECT_NEAR(shifted.twist - plain.twist, 0.25, 1e-10);
  EXPECT_LE(relative_difference(shifted.traction, plain.traction), 1e-6);
}

// --- what the certificate and the second order are worth ---

/// The gap bounds the square of the traction's error in the energy's norm, and the twist's error is of that
/// order: a part of the gap, where a twist of first order would be of the order of its root. Near gross slip
/// small loads turn the contact far, and the twist is refined until it is as good as the tolerance.
TEST(Twist, IsOfSecondOrder) {
  const CoulombBench bench(48, 30);
  for (const double moment_ratio : {0.3, 0.8, 0.99, 0.999}) {
    const TangentialSolution exact = bench.solve(moment_ratio, 1e-13);
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
      const TangentialSolution rough = bench.solve(moment_ratio, tolerance);
      const double twist_error = std::abs(rough.twist / exact.twist - 1.0);
      EXPECT_LE(twist_error, tolerance) << moment_ratio;
      if (moment_ratio > 0.9) continue;
      EXPECT_LE(twist_error, 0.1 * rough.change) << tolerance;
    }
  }
}

}  // namespace
}  // namespace slipstick::solver
