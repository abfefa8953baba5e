// The examples of docs/extend, held to theory.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <slipstick/torsion.hpp>

#include "docs/extend/examples/method.hpp"
#include "docs/extend/examples/operator.hpp"
#include "docs/extend/examples/profile.hpp"
#include "solver/contact/projected_gradient.hpp"

namespace example {
namespace {

TEST(ExampleProfile, CarriesTheMomentOfItsTractions) {
  const ParabolicPressure profile;
  const analytic::TorsionState state = analytic::from_stick_ratio(0.5, profile);
  const auto moment_density = [&](double r) { return r * r * analytic::traction(state, r, profile); };
  const double moment =
      2.0 * std::numbers::pi * (integral(moment_density, 0.0, 0.5) + integral(moment_density, 0.5, 1.0));
  EXPECT_NEAR(moment / profile.load(), state.moment, 1e-3 * state.moment);
}

TEST(ExampleProfile, TakesLoadStickRadiusAndTwistAsOne) {
  const ParabolicPressure profile;
  const analytic::TorsionState state = analytic::from_moment_ratio(0.6, profile);
  EXPECT_NEAR(analytic::from_stick_ratio(state.stick_ratio, profile).moment_ratio, 0.6, 1e-9);
  EXPECT_NEAR(analytic::from_twist(state.twist, profile).moment_ratio, 0.6, 1e-9);
  EXPECT_NEAR(analytic::traction(state, state.stick_ratio - 1e-9, profile),
              profile.pressure(state.stick_ratio), 1e-3);
}

/// A sphere's pressure on 32 x 32 cells, mu p0 = G = a = 1, turned by this twist.
struct Sphere {
  solver::Grid grid{.n1 = 32, .n2 = 32, .h1 = 2.2 / 32, .h2 = 2.2 / 32};
  solver::TangentialProblem problem;

  explicit Sphere(double twist) {
    const ArrayXd square = solver::cell_x1(grid).square() + solver::cell_x2(grid).square();
    problem.friction_bound = (1.0 - square).max(0.0).sqrt();
    problem.twist = twist;
  }
  std::unique_ptr<solver::LinearOperator> half_spaces() const {
    const solver::ElasticPair pair{
        .shear_compliance = 1.0, .poisson_compliance = 0.0, .normal_compliance = 1.0, .mismatch = 0.0};
    return solver::make_operator(solver::OperatorKind::dcfft, grid, solver::tangential_kernel(), pair);
  }
};

TEST(ExampleMethod, FindsTheExactMoment) {
  const Sphere sphere(1.0);
  const auto op = sphere.half_spaces();
  const solver::TangentialSolution solution = solve_by_plain_gradient(*op, sphere.problem, 1e-5, 5000);
  ASSERT_EQ(solution.status, solver::Status::converged) << solution.message;
  const double load = 2.0 / 3.0 * std::numbers::pi;  // mu W of mu p0 = a = 1
  const double moment =
      (solver::rotation_field(sphere.grid) * solution.traction).sum() * sphere.grid.cell_area() / load;
  EXPECT_NEAR(moment / analytic::from_twist(1.0 / load).moment, 1.0, 0.01);
}

TEST(ExampleMethod, AgreesWithAnotherOnAnyOperator) {
  const Sphere sphere(2.0);
  CoatedHalfSpaces op(sphere.half_spaces(), 0.5);
  const solver::TangentialSolution plain = solve_by_plain_gradient(op, sphere.problem, 1e-7, 5000);
  const solver::TangentialSolution other = solver::solve_by_projected_gradient(
      op, sphere.problem, {.tolerance = 1e-7, .start = {}, .progress = {}});
  ASSERT_EQ(plain.status, solver::Status::converged) << plain.message;
  ASSERT_EQ(other.status, solver::Status::converged) << other.message;
  EXPECT_LT((plain.traction - other.traction).abs().maxCoeff(), 1e-2);
}

/// Under a layer that takes nearly all of the displacement each cell stands alone: q = phi r/compliance, up
/// to mu p.
TEST(ExampleOperator, OfASoftLayerSticksWhereTheLayerAloneWould) {
  constexpr double kCompliance = 1e4;
  const Sphere sphere(kCompliance);
  CoatedHalfSpaces op(sphere.half_spaces(), kCompliance);
  const solver::TangentialSolution solution = solve_by_plain_gradient(op, sphere.problem, 1e-8, 5000);
  ASSERT_EQ(solution.status, solver::Status::converged) << solution.message;
  const ArrayXd radius = solver::norms(solver::rotation_field(sphere.grid));
  const ArrayXd expected = radius.min(sphere.problem.friction_bound);
  EXPECT_LT((solver::norms(solution.traction) - expected).abs().maxCoeff(), 1e-2);
}

}  // namespace
}  // namespace example
