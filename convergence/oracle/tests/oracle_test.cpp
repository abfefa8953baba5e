// Ellipses, whose exact answers are of their normal contact only; others are in exact_answers_test.py.

#include <gmock/gmock.h>

#include <algorithm>

#include "convergence/oracle/tests/histories.hpp"
#include "solver/scene/hertz_pressure.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {
namespace {

/// Both axes and the peak by the solver's own integral and root-finder.
Oracle expect_hertzs(const solver::Scene& scene) {
  const OracleAnswer answer = find_oracle(scene);
  EXPECT_TRUE(answer.oracle) << answer.reason;
  const Oracle& oracle = answer.oracle.value();
  const solver::Surface& body = scene.surfaces.front();
  const double effective_modulus = 210e9 / (1.0 - 0.3 * 0.3) / 2.0;
  const solver::HertzContact hertz = solver::hertz_contact(1000.0, body.radius_1, body.radius_2, effective_modulus);
  EXPECT_NEAR(oracle.longer_semi_axis() / std::max(hertz.semi_axis_1, hertz.semi_axis_2), 1.0, 1e-13);
  EXPECT_NEAR(oracle.shorter_semi_axis() / std::min(hertz.semi_axis_1, hertz.semi_axis_2), 1.0, 1e-13);
  EXPECT_NEAR(oracle.normal.peak_pressure / hertz.peak_pressure, 1.0, 1e-13);
  const auto edge_at = [&](double direction) {
    return oracle.contact_radius / oracle.radius(std::cos(direction), std::sin(direction));
  };
  EXPECT_NEAR(edge_at(body.angle) / hertz.semi_axis_1, 1.0, 1e-13);
  EXPECT_NEAR(edge_at(body.angle + std::numbers::pi / 2) / hertz.semi_axis_2, 1.0, 1e-13);
  return oracle;
}

TEST(Oracle, EllipseIsHertzs) {
  for (const double ratio : {1e-3, 0.1, 0.7, 1.0 + 1e-9, 1.0 + 1e-3, 1.5, 10.0, 100.0, 1000.0}) {
    SCOPED_TRACE(ratio);
    solver::Scene scene = example("ellipse");
    scene.surfaces.front().radius_1 = 0.01 * ratio;
    scene.surfaces.front().radius_2 = 0.01;
    expect_hertzs(scene);
  }
  for (const char* file : {"ellipse", "turned_ellipse"}) {
    SCOPED_TRACE(file);
    const solver::Scene scene = example(file);
    const Oracle oracle = expect_hertzs(scene);
    EXPECT_EQ(oracle.moment,
              *solver::value_if<solver::MomentRatio>(scene.steps[0].torsion) * oracle.friction.moment_limit);
  }
}

/// Imposed loads and motions are known.
TEST(Oracle, EllipseKnowsItsLoads) {
  solver::Scene scene = example("ellipse");
  solver::Step& step = scene.steps.front();
  step.torsion = solver::Moment{0.01};
  EXPECT_EQ(find_oracle(scene).oracle->moment, 0.01);
  step.torsion = solver::Twist{1e-3};
  EXPECT_EQ(find_oracle(scene).oracle->twist_angle, 1e-3);
  EXPECT_TRUE(std::isnan(find_oracle(scene).oracle->moment));
  step.torsion = solver::MomentRatio{0.0};
  step.force = {3.0, 4.0};
  EXPECT_EQ(find_oracle(scene).oracle->force, step.force);
  EXPECT_EQ(find_oracle(scene).oracle->moment, 0.0);
  step.displacement = {1e-7, 0.0};
  EXPECT_EQ(find_oracle(scene).oracle->displacement, *step.displacement);
  EXPECT_TRUE(std::isnan(find_oracle(scene).oracle->force[0]));
}

}  // namespace
}  // namespace slipstick::convergence
