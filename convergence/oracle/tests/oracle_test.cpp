// Exact answers in the scene's units: of ellipses, which are of their normal contact only, and along histories of
// loads; others are in exact_answers_test.py.

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>

#include "analytic/cycle.hpp"
#include "convergence/oracle/tests/histories.hpp"
#include "solver/scene/hertz_pressure.hpp"

namespace slipstick::convergence {
namespace {

using solver::Scene;
using solver::Step;
using testing::HasSubstr;

// ---------------------------------------------------------------- ellipses

/// Both axes and the peak by the solver's own integral and root-finder.
Oracle expect_hertzs(const Scene& scene) {
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
    Scene scene = example("ellipse");
    scene.surfaces.front().radius_1 = 0.01 * ratio;
    scene.surfaces.front().radius_2 = 0.01;
    expect_hertzs(scene);
  }
  for (const char* file : {"ellipse", "turned_ellipse"}) {
    SCOPED_TRACE(file);
    const Scene scene = example(file);
    const Oracle oracle = expect_hertzs(scene);
    EXPECT_EQ(oracle.moment,
              *solver::value_if<solver::MomentRatio>(scene.steps[0].torsion) * oracle.friction.moment_limit);
  }
}

/// Imposed loads and motions are known.
TEST(Oracle, EllipseKnowsItsLoads) {
  Scene scene = example("ellipse");
  Step& step = scene.steps.front();
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

// ---------------------------------------------------------------- histories

// Some roundings on the way from a scene's moduli to a number, and as many branches of a history.
constexpr double kHistoryTolerance = 1e-13;

std::vector<OracleAnswer> answers(const Scene& scene) {
  ExactHistory history = exact_history(scene);
  std::vector<OracleAnswer> list;
  for (const Step& step : scene.steps) list.push_back(history.advance(step));
  return list;
}

std::vector<Oracle> oracles(const Scene& scene) {
  std::vector<Oracle> list;
  for (const OracleAnswer& answer : answers(scene)) {
    if (!answer.oracle) throw std::runtime_error(answer.reason);
    list.push_back(*answer.oracle);
  }
  return list;
}

// Fronts of steps before have vertical tangents in a few of the intervals: their size, 4e-4, to the
// power 1.5.
constexpr double kQuadratureOverFronts = 1e-5;

TEST(OracleHistory, TractionsOfTorsionCarryTheMoments) {
  for (const char* body : {"paper", "cone", "flat_punch", "rounded_punch"}) {
    const std::vector<double> ratios{0.9, 0.2, -0.7, 0.3, 0.0};
    const Scene scene = twisted(example(body), ratios);
    const std::vector<Oracle> exact = oracles(scene);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const CarriedLoads carried = loads_carried_by(exact[i]);
      const double limit = exact[i].friction.moment_limit;
      const double quadrature_error = i == 0 ? 1e-6 : kQuadratureOverFronts;
      EXPECT_NEAR(exact[i].moment / limit, ratios[i], kHistoryTolerance) << body << i;
      EXPECT_NEAR(carried.load / *scene.steps[i].normal, 1.0, quadrature_error) << body << i;
      EXPECT_NEAR(carried.moment / limit, ratios[i], quadrature_error) << body << i;
    }
  }
}

/// Hertz's laws, step by step, whatever the history: lengths go with the cube root of the load.
TEST(OracleHistory, AnEllipseFollowsTheNormalLoadAlone) {
  Scene scene = example("ellipse");
  scene.steps.resize(3, scene.steps.front());
  scene.steps[1].normal = 8.0 * *scene.steps[0].normal;
  scene.steps[1].force = {10.0, 20.0};
  scene.steps[2].torsion = solver::Twist{-1e-4};
  const std::vector<Oracle> exact = oracles(scene);
  EXPECT_NEAR(exact[1].contact_radius / exact[0].contact_radius, 2.0, kHistoryTolerance);
  EXPECT_NEAR(exact[1].normal.peak_pressure / exact[0].normal.peak_pressure, 2.0, kHistoryTolerance);
  EXPECT_NEAR(exact[1].normal.approach / exact[0].normal.approach, 4.0, kHistoryTolerance);
  EXPECT_NEAR(exact[1].friction.moment_limit / exact[0].friction.moment_limit, 16.0, kHistoryTolerance);
  EXPECT_NEAR(exact[1].place.axis_ratio / exact[0].place.axis_ratio, 1.0, kHistoryTolerance);
  EXPECT_EQ(exact[2].contact_radius, exact[0].contact_radius);
  EXPECT_EQ(exact[2].twist_angle, -1e-4);
}

TEST(OracleHistory, TractionsOfAForceCarryIt) {
  for (const char* body : {"paper", "cone", "flat_punch"}) {
    Scene scene = without_contraction(example(body));
    const double normal = *scene.steps.front().normal;
    const double friction = scene.contact.friction.coefficient * normal;
    scene = pushed(scene, {{normal, 0.8 * friction},
                           {1.5 * normal, 0.9 * friction},
                           {1.5 * normal, -1.2 * friction},
                           {0.7 * normal, -0.3 * friction},
                           {0.7 * normal, 0.0}});
    const std::vector<Oracle> exact = oracles(scene);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const CarriedLoads carried = loads_carried_by(exact[i]);
      EXPECT_NEAR(carried.load / *scene.steps[i].normal, 1.0, kQuadratureOverFronts) << body << i;
      for (const int axis : {0, 1}) {
        EXPECT_NEAR(carried.force * exact[i].place.direction[axis] / friction, scene.steps[i].force[axis] / friction,
                    kQuadratureOverFronts)
            << body << i;
        EXPECT_EQ(exact[i].force[axis], scene.steps[i].force[axis]);
      }
    }
  }
}

void expect_the_same_state(const Oracle& a, const Oracle& b, double sign) {
  EXPECT_EQ(a.contact_radius, b.contact_radius);
  EXPECT_NEAR(a.stick_radius / b.stick_radius, 1.0, kHistoryTolerance);
  EXPECT_NEAR(a.dissipated, b.dissipated, kHistoryTolerance * std::abs(b.dissipated));
  EXPECT_NEAR(a.moment, sign * b.moment, kHistoryTolerance * std::abs(b.friction.moment_limit));
  EXPECT_NEAR(a.twist_angle, sign * b.twist_angle, kHistoryTolerance * std::abs(b.twist_angle));
  for (const int axis : {0, 1}) {
    EXPECT_NEAR(a.displacement[axis], sign * b.displacement[axis], kHistoryTolerance * std::abs(b.displacement[axis]));
  }
  for (const double part : {0.1, 0.6, 0.95}) {
    const double r = part * a.contact_radius;
    const double along =
        a.place.direction[0] * b.place.direction[0] + a.place.direction[1] * b.place.direction[1];  // 0: torsion
    EXPECT_NEAR(a.traction(r), sign * (along == 0.0 ? 1.0 : along) * b.traction(r),
                kHistoryTolerance * b.friction.reference_bound);
  }
}

/// Steel bodies on each other: 1/G = 2 * 2 (1 + nu)/E.
TEST(OracleHistory, AClosedCycleOfTorsionLosesItsLoop) {
  constexpr double shear_modulus = 210e9 / (4.0 * 1.3);
  for (const double ratio : {0.1, 0.8}) {
    const std::vector<Oracle> exact = oracles(twisted(example("paper"), {ratio, -ratio, ratio, -ratio, ratio}));
    const double friction = 0.1 * 1000.0;
    const double loop =
        analytic::energy_lost_per_cycle(ratio) * friction * friction / (shear_modulus * exact[0].contact_radius);
    EXPECT_NEAR((exact[1].dissipated + exact[2].dissipated) / loop, 1.0, kHistoryTolerance);
    EXPECT_NEAR((exact[3].dissipated + exact[4].dissipated) / loop, 1.0, kHistoryTolerance);
    EXPECT_NEAR(exact[0].dissipated / loop, 0.25, kHistoryTolerance);
  }
}

/// Mindlin and Deresiewicz (1953): with x = F/(mu W), (9/10) (mu W)^2/(a G) 2 (1 - (1 - x)^(5/3)
/// - (5 x/6) (1 + (1 - x)^(2/3))) for nu = 0; and F to delta = (3/8) mu W/(a G) (1 - (1 - x)^(2/3)).
TEST(OracleHistory, AClosedCycleOfForceLosesItsLoop) {
  constexpr double shear_modulus = 210e9 / 4.0;
  constexpr double x = 0.8;
  constexpr double friction = 0.1 * 1000.0;
  const Scene plain = without_contraction(example("paper"));
  const std::vector<Oracle> exact =
      oracles(pushed(plain, {{1000.0, x * friction}, {1000.0, -x * friction}, {1000.0, x * friction}}));
  const double unit = friction * friction / (shear_modulus * exact[0].contact_radius);
  const double loop =
      1.8 * unit * (1.0 - std::pow(1.0 - x, 5.0 / 3.0) - 5.0 * x / 6.0 * (1.0 + std::pow(1.0 - x, 2.0 / 3.0)));
  EXPECT_NEAR((exact[1].dissipated + exact[2].dissipated) / loop, 1.0, kHistoryTolerance);
  EXPECT_NEAR(exact[0].dissipated / loop, 0.25, kHistoryTolerance);
  const double displacement = 0.375 * unit / friction * (1.0 - std::pow(1.0 - x, 2.0 / 3.0));
  EXPECT_NEAR(std::hypot(exact[0].displacement[0], exact[0].displacement[1]) / displacement, 1.0, kHistoryTolerance);
  EXPECT_NEAR(exact[0].stick_radius / exact[0].contact_radius, std::cbrt(1.0 - x), kHistoryTolerance);
}

/// Against a rigid body only the other body enters G and E*.
TEST(OracleHistory, OneBodyMayBeRigid) {
  Scene scene = without_contraction(example("paper"));
  scene.upper = {.young_modulus = INFINITY, .poisson_ratio = 0.0};
  scene.contact.coupling = solver::Coupling::none;
  const double a = std::cbrt(0.75 * 1000.0 * 0.018 / 210e9);
  const double unit = 100.0 / (105e9 * a);  // mu W/(G a)
  const Oracle force = oracles(pushed(scene, {{1000.0, 50.0}})).front();
  EXPECT_NEAR(force.contact_radius / a, 1.0, kHistoryTolerance);
  EXPECT_NEAR(
      std::hypot(force.displacement[0], force.displacement[1]) / (0.375 * unit * (1.0 - std::pow(0.5, 2.0 / 3.0))), 1.0,
      kHistoryTolerance);
  const Oracle torsion = oracles(twisted(scene, {0.5})).front();
  EXPECT_NEAR(torsion.twist_angle / (analytic::from_moment_ratio(0.5).twist * unit / a), 1.0, kHistoryTolerance);
}

/// The twists that a history of moments goes through bring back its moments.
TEST(OracleHistory, ImposedTwistsAreThoseOfTheMoments) {
  Scene scene = twisted(example("paper"), {0.8, -0.3, 0.1, -0.9, 0.0});
  const std::vector<Oracle> by_moment = oracles(scene);
  for (std::size_t i = 0; i < scene.steps.size(); ++i) {
    scene.steps[i].torsion = solver::Twist{by_moment[i].twist_angle};
  }
  const std::vector<Oracle> by_twist = oracles(scene);
  ASSERT_EQ(by_twist.size(), by_moment.size());
  for (std::size_t i = 0; i < by_twist.size(); ++i) expect_the_same_state(by_twist[i], by_moment[i], 1.0);
}

/// No answer from the first step on that no theory reaches: what comes after depends on it.
TEST(OracleHistory, EndsWithGrossSlip) {
  Scene moment = twisted(example("paper"), {0.5, 0.0, 0.3});
  moment.steps[1].torsion = solver::Moment{-0.02882};
  Scene twist = moment;
  twist.steps[1].torsion = solver::Twist{1e3};
  Scene twist_back = moment;
  twist_back.steps[1].torsion = solver::Twist{-1e3};
  const Scene force = pushed(without_contraction(example("paper")), {{1000.0, 50.0}, {900.0, -90.1}, {1000.0, 0.0}});
  for (const Scene& scene : {moment, twist, twist_back, force}) {
    const std::vector<OracleAnswer> all = answers(scene);
    EXPECT_TRUE(all[0].oracle);
    EXPECT_FALSE(all[1].oracle);
    EXPECT_TRUE(all[1].out_of_range);
    EXPECT_THAT(all[1].reason, HasSubstr("beyond the range of the exact solution"));
    EXPECT_FALSE(all[2].oracle);
    EXPECT_THAT(all[2].reason, HasSubstr("a step before"));
  }
}

/// Spence (1968): against a rigid body with nu = 0 and mu = 0.2986 half of the radius sticks, under any load.
TEST(OracleHistory, PressingDissimilarBodiesSticksWithinTheSameRatio) {
  Scene scene = without_contraction(example("flat_punch"));
  scene.upper = {.young_modulus = INFINITY, .poisson_ratio = 0.0};
  scene.contact.friction.coefficient = 0.2986;
  scene.contact.coupling = solver::Coupling::full;
  scene = pushed(scene, {{1.0, 0.0}, {10.0, 0.0}, {1000.0, 0.0}});
  for (const Oracle& spence : oracles(scene)) {
    EXPECT_NEAR(spence.state.stick_ratio, 0.5, 5e-4);  // his three digits
    EXPECT_TRUE(std::isnan(spence.traction(0.0)));
  }
  std::swap(scene.upper, scene.lower);
  EXPECT_NEAR(oracles(scene).back().state.stick_ratio, 0.5, 5e-4);
  // Goodman's equation, artanh(c)/c = (mu/beta) K(sqrt(1 - c^2)), beta = 1/2.
  scene.contact.coupling = solver::Coupling::pressure;
  const double c = oracles(scene).back().state.stick_ratio;
  EXPECT_NEAR(std::atanh(c) / c, 2.0 * 0.2986 * std::comp_ellint_1(std::sqrt(1.0 - c * c)), 1e-9);
  scene.steps.back().normal = 5.0;  // no longer growing
  EXPECT_FALSE(find_oracle(scene).oracle);
}

}  // namespace
}  // namespace slipstick::convergence
