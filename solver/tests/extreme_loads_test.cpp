// Loads next to gross slip, and loads next to none: both are as easy as any other.

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <string>

#include "solver/contact/coulomb_method.hpp"
#include "solver/elasticity/direct.hpp"
#include "solver/tests/model_units.hpp"
#include "solver/tests/torsion_bench.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// No load's solve may take more than this many applications on the finest grid.
constexpr double kMaxApplications = 60.0;

/// A friction bound on a grid of square cells, with cross contraction.
struct LoadedBody {
  std::string name;
  Grid grid;
  ArrayXd bound;
};

LoadedBody body(const std::string& name) {
  const Grid grid{32, 32, 1.0, 1.0};
  const ArrayXd x = cell_x1(grid);
  const ArrayXd y = cell_x2(grid);
  const auto cap = [&](double x0, double y0, double a, double b, double angle) {
    const ArrayXd along = std::cos(angle) * (x - x0) + std::sin(angle) * (y - y0);
    const ArrayXd across = -std::sin(angle) * (x - x0) + std::cos(angle) * (y - y0);
    return ArrayXd((1.0 - (along / a).square() - (across / b).square()).max(0.0).sqrt());
  };
  const ArrayXd r = (x.square() + y.square()).sqrt();
  if (name == "circle") return {name, grid, cap(0, 0, 14, 14, 0)};
  if (name == "turned ellipse") return {name, grid, cap(0, 0, 14.5, 6, 0.6)};
  if (name == "annulus") return {name, grid, (r > 6.0 && r < 14.0).cast<double>()};
  if (name == "two patches") return {name, grid, cap(-8, 0, 6, 6, 0) + cap(8, 0, 6, 6, 0)};
  if (name == "unequal patches") return {name, grid, cap(-8, -3, 6.5, 6.5, 0) + 0.6 * cap(9, 5, 5, 4, 0)};
  return {name, grid, (r < 14.0).select((14.0 / r).log(), 0.0)};  // a cone's peak
}

struct Load {
  std::string name;
  std::array<double, 3> direction;  ///< F1, F2, M over the radius
};
void PrintTo(const Load& load, std::ostream* stream) { *stream << load.name; }

class ExtremeLoads : public testing::TestWithParam<std::tuple<std::string, Load>> {
 protected:
  TangentialProblem problem(double part) const {
    const auto& direction = std::get<1>(GetParam()).direction;
    TangentialProblem problem;
    problem.friction_bound = body_.bound;
    problem.force = {direction[0], direction[1]};
    problem.moment = 10.0 * direction[2];
    const double scale = part * limit_of(problem, body_.grid).factor;
    problem.force = {scale * direction[0], scale * direction[1]};
    problem.moment = scale * 10.0 * direction[2];
    return problem;
  }
  TangentialSolution solve(const TangentialProblem& problem) const {
    return solve_by_coulomb_method(elasticity_, body_.grid, problem);
  }
  /// By direct summation.
  Certificate certificate(const TangentialProblem& problem, const TangentialSolution& solution) const {
    const auto op = make_operator(OperatorKind::direct, body_.grid, tangential_kernel(), *elasticity_.law);
    ArrayXd u(solution.traction.size());
    op->apply(solution.traction, u);
    const Index n = body_.grid.cells();
    const ArrayXd rotation = rotation_field(body_.grid);
    ArrayXd motion = solution.twist * rotation;
    motion.head(n) += solution.displacement[0];
    motion.tail(n) += solution.displacement[1];
    const ArrayXd contact = (body_.bound > 0.0).cast<double>().replicate(2, 1);
    return certify({solution.traction, u, contact * (u - motion)}, body_.bound, rotation, *problem.moment,
                   *problem.force, elasticity_.law->least_eigenvalue(body_.grid.h1, body_.grid.h2));
  }

  LoadedBody body_ = body(std::get<0>(GetParam()));
  Elasticity elasticity_{half_spaces({2.0, 0.3}, {2.0, 0.3})};
};

INSTANTIATE_TEST_SUITE_P(Bodies, ExtremeLoads,
                         testing::Combine(testing::Values("circle", "turned ellipse", "annulus",
                                                          "two patches", "unequal patches", "cone"),
                                          testing::Values(Load{"force", {1.0, 0.3, 0.0}},
                                                          Load{"moment", {0.0, 0.0, 1.0}},
                                                          Load{"both", {1.0, 0.3, 1.0}})));

TEST_P(ExtremeLoads, NextToGrossSlipTakeAFewApplications) {
  for (const double missing : {2e-4, 1e-4, 1e-5, 1e-6}) {
    SCOPED_TRACE(missing);
    const TangentialProblem loads = problem(1.0 - missing);
    const TangentialSolution solution = solve(loads);
    ASSERT_EQ(solution.status, Status::converged) << solution.message;
    EXPECT_LE(finest_grid_applications(solution.grids), kMaxApplications);
    const Certificate c = certificate(loads, solution);
    EXPECT_LE(c.gap, 1.1e-8);
    EXPECT_LE(c.moment, kRounding);
    EXPECT_LE(c.force, kRounding);
    EXPECT_LE(c.friction_bound, kRounding);
  }
}

// Nearly everything sticks, and a bonded contact is linear: half the load, half of everything. Only cells
// with a tiny bound slip, and carry little.
TEST_P(ExtremeLoads, NextToNoneAreLinear) {
  const TangentialSolution larger = solve(problem(1e-8));
  for (const double part : {1e-10, 1e-12}) {
    SCOPED_TRACE(part);
    const TangentialProblem loads = problem(part);
    const TangentialSolution solution = solve(loads);
    ASSERT_EQ(solution.status, Status::converged) << solution.message;
    EXPECT_LE(finest_grid_applications(solution.grids), kMaxApplications);
    const double scale = 1e-8 / part;
    EXPECT_LE((scale * solution.traction - larger.traction).matrix().norm(),
              1e-8 * larger.traction.matrix().norm());
    const Certificate c = certificate(loads, solution);
    EXPECT_LE(c.energy_error, 1e-16);  // tractions are right to eight digits
    EXPECT_LE(c.moment, kRounding * part);
    EXPECT_LE(c.force, kRounding * part);
  }
}

// Dissimilar bodies with little friction slip nearly everywhere under their pressure: double precision cannot
// represent tractions to a smaller gap. A converged result is within its tolerance,
// by the gap or by its bound of second order.
TEST(SmallFriction, BetweenDissimilarBodiesEndsAsItSays) {
  Scene scene = paper_scene(32, 0.5);
  scene.lower = {70e9, 0.33};
  for (const double friction : {1e-12, 1e-9, 1e-6}) {
    SCOPED_TRACE(friction);
    scene.contact.friction.coefficient = friction;
    const ModelSolution solution = solve_in_model_units(scene);
    const Certificate& certificate = solution.certificate;
    const bool within = std::min(certificate.gap, certificate.energy_error) <= scene.solver.tolerance;
    EXPECT_EQ(within, friction > 1e-10);
    EXPECT_EQ(solution.status == Status::converged, within) << solution.message;
    EXPECT_TRUE(within || solution.message.find("rounding") != std::string::npos) << solution.message;
    EXPECT_LE(certificate.moment, kRounding);
    EXPECT_LE(certificate.gap, std::max(1e-8, certificate.rounding));
  }
}

}  // namespace
}  // namespace slipstick::solver
