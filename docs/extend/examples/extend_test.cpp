// The examples of docs/extend, held to theory.

#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <slipstick/torsion.hpp>
#include <vector>

#include "docs/extend/examples/method.hpp"
#include "docs/extend/examples/profile.hpp"
#include "solver/contact/coulomb_method.hpp"
#include "solver/contact/normal_contact.hpp"
#include "solver/contact/paper_method.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/elasticity/law/winkler_layer.hpp"

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
  EXPECT_NEAR(analytic::traction(state, state.stick_ratio - 1e-9, profile), profile.pressure(state.stick_ratio), 1e-3);
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
  /// G = 1, without cross contraction, under a layer of this compliance.
  static solver::SharedLaw law(double compliance) {
    const solver::ElasticPair pair{
        .shear_compliance = 1.0, .poisson_compliance = 0.0, .normal_compliance = 1.0, .mismatch = 0.0};
    return std::make_shared<solver::WinklerLayer>(std::make_shared<solver::HalfSpaces>(pair), compliance, compliance);
  }
  std::unique_ptr<solver::LinearOperator> op(double compliance) const {
    return solver::make_operator(solver::OperatorKind::dcfft, grid, solver::tangential_kernel(), *law(compliance));
  }
};

TEST(ExampleMethod, FindsTheExactMoment) {
  const Sphere sphere(1.0);
  const auto op = sphere.op(0.0);
  const solver::TangentialSolution solution = solve_by_plain_gradient(*op, sphere.problem, 1e-5, 5000);
  ASSERT_EQ(solution.status, solver::Status::converged) << solution.message;
  const double load = 2.0 / 3.0 * std::numbers::pi;  // mu W of mu p0 = a = 1
  const double moment =
      (solver::rotation_field(sphere.grid) * solution.traction).sum() * sphere.grid.cell_area() / load;
  EXPECT_NEAR(moment / analytic::from_twist(1.0 / load).moment, 1.0, 0.01);
}

/// The example, and the solver's own.
std::vector<solver::TangentialSolution> by_every_method(const Sphere& sphere, double compliance) {
  const auto op = sphere.op(compliance);
  return {solve_by_plain_gradient(*op, sphere.problem, 1e-8, 5000), solver::solve_by_paper_method(*op, sphere.problem),
          solver::solve_by_coulomb_method({.law = Sphere::law(compliance)}, sphere.grid, sphere.problem)};
}

TEST(ExampleLaw, IsTakenByEveryMethod) {
  const Sphere sphere(2.0);
  const auto solutions = by_every_method(sphere, 0.5);
  for (const solver::TangentialSolution& solution : solutions) {
    ASSERT_EQ(solution.status, solver::Status::converged) << solution.message;
    EXPECT_LT((solution.traction - solutions.front().traction).abs().maxCoeff(), 1e-2);
  }
}

/// If the layer takes nearly all of the displacement, the cells are independent: q = phi r/compliance, up to
/// mu p.
TEST(ExampleLaw, SticksWhereAVerySoftLayerAloneWould) {
  constexpr double kCompliance = 1e4;
  const Sphere sphere(kCompliance);
  const ArrayXd radius = solver::norms(solver::rotation_field(sphere.grid));
  const ArrayXd expected = radius.min(sphere.problem.friction_bound);
  for (const solver::TangentialSolution& solution : by_every_method(sphere, kCompliance)) {
    ASSERT_EQ(solution.status, solver::Status::converged) << solution.message;
    EXPECT_LT((solver::norms(solution.traction) - expected).abs().maxCoeff(), 1e-2);
  }
}

/// And presses as Winkler's foundation: p = (approach - gap)/compliance.
TEST(ExampleLaw, PressesAsAVerySoftLayerAloneWould) {
  constexpr double kCompliance = 1e4;
  const Sphere sphere(0.0);
  const ArrayXd gap = solver::norms(solver::rotation_field(sphere.grid)).square();
  const solver::NormalSolution solution = solver::solve_normal_contact({.law = Sphere::law(kCompliance)}, sphere.grid,
                                                                       {.gap = gap, .total_pressure = 1e-2});
  ASSERT_EQ(solution.status, solver::Status::converged) << solution.message;
  const ArrayXd expected = (solution.approach - gap).max(0.0) / kCompliance;
  EXPECT_LT((solution.pressure - expected).abs().maxCoeff(), 1e-3 * expected.maxCoeff());
}

}  // namespace
}  // namespace example
