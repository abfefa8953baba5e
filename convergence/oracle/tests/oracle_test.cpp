
#include <gmock/gmock.h>

#include <algorithm>

#include "convergence/oracle/tests/histories.hpp"
#include "solver/scene/hertz_pressure.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {
namespace {

// The paper's case with mu = 0.1, computed to 30 digits from Hertz's formulas and the elliptic integrals.
constexpr double kContactRadius = 0.48909732465087485e-3;
constexpr double kPeakPressure = 1995.9553043899548e6;
constexpr double kMomentLimit = 28.810210537755196e-3;
struct Case {
  const char* load;
  double stick_ratio;
  double twist;
};
constexpr Case kCases[] = {{"load.moment_ratio=0.1", 0.9693964204953627, 1.197249389022587e-4},
                           {"load.moment_ratio=0.5", 0.8135681261276496, 7.629453516649457e-4},
                           {"load.moment_ratio=0.9", 0.4958950522157781, 2.361048651456917e-3},
                           {"load.moment_ratio=0.99", 0.2369661925296642, 4.413921104595224e-3}};
// The published digits, and a few roundings on the way from a scene's moduli to the number.
constexpr double kOracleTolerance = 1e-14;

solver::Scene paper(const std::vector<std::string>& overrides) { return example("paper", overrides); }

TEST(Oracle, PaperCase) {
  for (const Case& c : kCases) {
    const OracleAnswer answer = find_oracle(paper({c.load}));
    ASSERT_TRUE(answer.oracle) << answer.reason;
    EXPECT_NEAR(answer.oracle->contact_radius / kContactRadius, 1.0, kOracleTolerance);
    EXPECT_NEAR(answer.oracle->normal.peak_pressure / kPeakPressure, 1.0, kOracleTolerance);
    EXPECT_NEAR(answer.oracle->friction.moment_limit / kMomentLimit, 1.0, kOracleTolerance);
    EXPECT_NEAR(answer.oracle->state.stick_ratio / c.stick_ratio, 1.0, kOracleTolerance) << c.load;
    EXPECT_NEAR(answer.oracle->twist_angle / c.twist, 1.0, kOracleTolerance) << c.load;
  }
}

TEST(Oracle, LastDigitsCostNoAnswer) {
  const Oracle plain = *find_oracle(example("paper")).oracle;
  for (const char* change :
       {"lower.poisson_ratio=0.30000000000000004", "upper.at=[1e-18, 0]", "load.force=[1e-300, 0]"}) {
    const OracleAnswer answer = find_oracle(example("paper", {change}));
    ASSERT_TRUE(answer.oracle) << change << ": " << answer.reason;
    EXPECT_NEAR(answer.oracle->twist_angle / plain.twist_angle, 1.0, kOracleTolerance) << change;
  }
}

// A cone's pressure has no bound at its apex, a punch's none towards its edge.
TEST(Oracle, ConeAndFlatPunchHaveNoPeak) {
  const Oracle cone = *find_oracle(example("cone")).oracle;
  EXPECT_EQ(cone.normal.peak_pressure, HUGE_VAL);
  EXPECT_EQ(cone.pressure(0.0), HUGE_VAL);
  const Oracle punch = *find_oracle(example("flat_punch")).oracle;
  EXPECT_EQ(punch.normal.peak_pressure, HUGE_VAL);
  EXPECT_EQ(punch.pressure(punch.contact_radius), 0.0);
}

// Reissner and Sagoci's bonded punch until it begins to slip, phi = 3 M/(16 G a^3).
TEST(Oracle, FlatPunchSticksEverywhereAtFirst) {
  const double shear_modulus = 210e9 / (2.0 * 1.3) / 2.0;
  for (const char* load : {"load.moment_ratio=0.5", "load.moment_ratio=0", "load.moment=0.033"}) {
    const Oracle punch = *find_oracle(example("flat_punch", {load})).oracle;
    EXPECT_EQ(punch.stick_radius, punch.contact_radius) << load;
    EXPECT_NEAR(punch.twist_angle, 3.0 * punch.moment / (16.0 * shear_modulus * std::pow(5e-4, 3)),
                kOracleTolerance * punch.twist_angle)
        << load;
  }
}

TEST(Oracle, EllipsoidOfEqualRadiiIsASphere) {
  const Oracle sphere = *find_oracle(paper({"load.moment_ratio=0.7"})).oracle;
  const OracleAnswer round = find_oracle(
      example("ellipse", {"upper.radius_1=0.018", "upper.radius_2=0.018", "load.moment_ratio=0.7"}));
  ASSERT_TRUE(round.oracle) << round.reason;
  EXPECT_EQ(round.oracle->normal.profile.get(), &analytic::hertz_profile());
  EXPECT_EQ(round.oracle->contact_radius, sphere.contact_radius);
  EXPECT_EQ(round.oracle->twist_angle, sphere.twist_angle);
}

/// Both axes and the peak by the solver's own integral and root-finder.
Oracle expect_hertzs(const solver::Scene& scene) {
  const OracleAnswer answer = find_oracle(scene);
  EXPECT_TRUE(answer.oracle) << answer.reason;
  const Oracle& oracle = answer.oracle.value();
  const solver::Surface& body = scene.surfaces.front();
  const double effective_modulus = 210e9 / (1.0 - 0.3 * 0.3) / 2.0;
  const solver::HertzContact hertz =
      solver::hertz_contact(1000.0, body.radius_1, body.radius_2, effective_modulus);
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

/// Flat bodies press hardest off the axis: under r^4 by sqrt(1 - r^2) (1 + 2 r^2), most at r^2 = 1/2 (its
/// slope is r (3 - 6 r^2)/sqrt(1 - r^2)).
TEST(Oracle, FindsThePeakOffTheAxis) {
  solver::Scene scene = paper({});
  scene.surfaces = {{.shape = solver::Shape::power, .exponent = 4.0, .coefficient = 1e8}};
  const Oracle power = *find_oracle(scene).oracle;
  EXPECT_NEAR(power.normal.peak_pressure / power.pressure(0.0), std::sqrt(2.0), kOracleTolerance);
  const Oracle rounded = *find_oracle(example("rounded_punch")).oracle;
  double highest = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    highest = std::max(highest, rounded.pressure(rounded.contact_radius * i / 1000.0));
  }
  EXPECT_LE(highest, rounded.normal.peak_pressure);
  EXPECT_GE(highest,
            rounded.normal.peak_pressure * (1.0 - 1e-4));  // a thousandth of the radius from a smooth peak
  EXPECT_GT(highest, 1.01 * rounded.pressure(0.0));
}

TEST(Oracle, SaysWhyThereIsNone) {
  struct Case {
    const char* scene;
    std::vector<std::string> overrides;
    const char* says;
  };
  const auto tresca = [](std::vector<std::string> more) {
    more.insert(more.end(), {"contact.friction_law=tresca", "contact.shear_strength=1e8"});
    return more;
  };
  for (const auto& [scene, overrides, says] : {
           Case{"ellipse", {"contact.friction=0"}, "friction"},
           Case{"ellipse", {"lower.poisson_ratio=0.2"}, "coupling"},
           Case{"ellipse", {"lower.poisson_ratio=0.2", "load.moment_ratio=0"}, "coupling"},
           Case{"ellipse", tresca({}), "friction_law = \"tresca\""},
           Case{"dissimilar", {}, "coupling"},
           Case{"annulus", {}, "inner radius"},
           Case{"patches", {}, "several shapes"},
           Case{"rough_sphere", {}, "several shapes"},
           Case{"paper", {"load.moment=0.02882"}, "gross slip"},
           Case{"cone", {"load.moment=0.0035"}, "gross slip"},
           Case{"cone", {"contact.friction_law=capped", "contact.shear_strength=1e8"}, "\"capped\""},
           Case{"paper", {"load.twist=1e3"}, "range"},
           Case{"paper", {"contact.friction=0"}, "friction"},
           Case{"paper", {"load.moment_ratio=0", "load.force=[30,40]"}, "Poisson's ratios are 0"},
           Case{"mindlin", {"load.moment_ratio=0.1"}, "torsion together with a force"},
           Case{"mindlin", {"load.displacement=[1e-7,0]"}, "displacement is imposed"},
           Case{"mindlin", tresca({}), "Coulomb's law"},
           Case{"rounded_punch",
                {"upper.poisson_ratio=0", "lower.poisson_ratio=0", "load.moment_ratio=0", "load.force=[1,0]"},
                "similar to itself"},
           Case{"paper",
                {"grid.extent=[2e-3,2e-3]", "layer.kind=winkler", "layer.normal_compliance=0",
                 "layer.tangential_compliance=1e-15"},
                "layer.kind"},
           Case{"coated_sphere", {"contact.coupling=auto"}, "contact.coupling"},
           Case{"coated_sphere", {"load.force=[1,0]"}, "force"},
           Case{"cone",
                {"lower.layer.thickness=1e-4", "lower.layer.young_modulus=420e9",
                 "lower.layer.poisson_ratio=0.25", "contact.coupling=none"},
                "\"cone\" on a layer"},
           Case{"coated_sphere", {"lower.layer.thickness=1e-6"}, "thickness"},
       }) {
    const OracleAnswer answer = find_oracle(example(scene, overrides));
    EXPECT_FALSE(answer.oracle) << scene;
    EXPECT_THAT(answer.reason, testing::HasSubstr(says)) << scene;
  }
  for (const char* scene : {"ellipse", "dissimilar"}) {
    EXPECT_TRUE(find_oracle(example(scene, {"lower.poisson_ratio=0.2", "contact.coupling=none"})).oracle);
  }
}

}  // namespace
}  // namespace slipstick::convergence
