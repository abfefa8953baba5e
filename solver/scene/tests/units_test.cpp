#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "solver/model/make_model.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

/// The scene with lengths and forces counted in other units than m and N.
struct Units {
  std::string name;
  double metre;   ///< units of length in a metre
  double newton;  ///< units of force in a newton
};

void PrintTo(const Units& units, std::ostream* stream) { *stream << units.name; }

Scene in_units(Scene scene, const Units& units) {
  const double pascal = units.newton / (units.metre * units.metre);
  for (Surface& surface : scene.surfaces) {
    for (double* const length :
         {&surface.radius, &surface.inner_radius, &surface.radius_1, &surface.radius_2, &surface.flat_radius,
          &surface.corner_radius, &surface.at[0], &surface.at[1], &surface.roughness.longest,
          &surface.roughness.shortest, &surface.roughness.period}) {
      *length *= units.metre;
    }
    surface.coefficient *= std::pow(units.metre, 1.0 - surface.exponent);
  }
  for (Material* const body : {&scene.upper, &scene.lower}) {
    body->young_modulus *= pascal;
    if (!body->coating) continue;
    body->coating->young_modulus *= pascal;
    body->coating->thickness *= units.metre;
  }
  scene.contact.friction.shear_strength *= pascal;
  if (scene.contact.friction.kind == FrictionKind::power)
    scene.contact.friction.coefficient *= std::pow(pascal, 1.0 - scene.contact.friction.exponent);
  scene.steps[0].normal = *scene.steps[0].normal * units.newton;
  if (const auto moment = value_if<Moment>(scene.steps[0].torsion)) {
    scene.steps[0].torsion = Moment{*moment * units.newton * units.metre};
  }
  if (scene.grid.extent)
    scene.grid.extent = {(*scene.grid.extent)[0] * units.metre, (*scene.grid.extent)[1] * units.metre};
  return scene;
}

constexpr Index kCells = 48;

Scene by_ratio() { return paper_scene(kCells, 0.5); }
Scene by_moment() {
  Scene scene = paper_scene(kCells, 0.0);
  scene.steps[0].torsion = Moment{0.9 * paper::kMomentLimit};
  return scene;
}
Scene over_an_extent() {
  Scene scene = ellipsoid_scene(kCells, 0.03, 0.01, 0.5);
  scene.grid.extent = {1.6e-3, 0.9e-3};
  return scene;
}

Scene with_layers() {
  Scene scene = by_ratio();
  scene.lower.coating = {0.2e-3, 3.1 * paper::kYoungModulus, 0.21};
  return scene;
}

Scene under_law(FrictionKind kind) {
  Scene scene = by_ratio();
  scene.contact.friction.kind = kind;
  scene.contact.friction.coefficient = kind == FrictionKind::power ? 500.0 : 0.1;
  scene.contact.friction.exponent = 0.6;
  scene.contact.friction.shear_strength = 0.7e8;
  return scene;
}

/// One of each shape that is no file, off the origin and turned.
Scene of_all_shapes() {
  Scene scene = over_an_extent();
  Surface body{.at = {0.1e-3, -0.2e-3}, .angle = 0.4};
  body.radius = 0.018;
  body.radius_1 = 0.03;
  body.radius_2 = 0.01;
  body.slope = 0.01;
  body.flat_radius = 0.3e-3;
  body.corner_radius = 5e-3;
  body.exponent = 3.5;
  body.coefficient = 1e5;
  body.roughness = {
      .seed = 1, .hurst = 0.8, .longest = 4e-4, .shortest = 1e-4, .rms_slope = 0.01, .period = 1.6e-3};
  scene.surfaces.clear();
  for (const Shape shape :
       {Shape::sphere, Shape::ellipsoid, Shape::cone, Shape::rounded_punch, Shape::power, Shape::roughness}) {
    body.shape = shape;
    scene.surfaces.push_back(body);
  }
  body.shape = Shape::flat_punch;
  body.radius = 0.6e-3;
  body.inner_radius = 0.1e-3;
  scene.surfaces.push_back(body);
  return scene;
}

double difference(double a, double b) { return std::abs(a / b - 1.0); }
double difference(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  return (a - b).abs().maxCoeff() / b.abs().maxCoeff();
}

class OtherUnits : public testing::TestWithParam<Units> {};
INSTANTIATE_TEST_SUITE_P(Systems, OtherUnits,
                         testing::Values(Units{"mm_N_MPa", 1e3, 1.0}, Units{"nm_nN_GPa", 1e9, 1e9},
                                         Units{"um_mN_GPa", 1e6, 1e3}, Units{"km_MN_Pa", 1e-3, 1e-6}),
                         [](const auto& tested) { return tested.param.name; });

/// The model keeps nothing of the units, not even their roundings.
TEST_P(OtherUnits, GiveTheSameModel) {
  for (const Scene& scene : {by_ratio(), by_moment(), over_an_extent()}) {
    const Model si = make_model(scene);
    const Model other = make_model(in_units(scene, GetParam()));
    EXPECT_TRUE((other.gap == si.gap).all());
    EXPECT_EQ(*other.normal_load, *si.normal_load);
    EXPECT_EQ(other.grid.h2, si.grid.h2);
    EXPECT_EQ(other.pair.normal_compliance, si.pair.normal_compliance);
    EXPECT_EQ(other.pair.poisson_compliance, si.pair.poisson_compliance);
    EXPECT_EQ(other.hertz->semi_axis_1, si.hertz->semi_axis_1);
  }
}

TEST_P(OtherUnits, GiveTheSameGap) {
  const Eigen::ArrayXd si = make_model(of_all_shapes()).gap;
  const Eigen::ArrayXd other = make_model(in_units(of_all_shapes(), GetParam())).gap;
  EXPECT_TRUE((other == si).all());
  EXPECT_GT(si.isFinite().count(), 100);
  EXPECT_LT(si.isFinite().count(), si.size());
}

TEST_P(OtherUnits, GiveTheSameDigits) {
  constexpr double kTolerance = 1e-12;
  const Units& units = GetParam();
  const double moment = units.newton * units.metre;
  const double pascal = units.newton / (units.metre * units.metre);
  for (const Scene& scene : {by_ratio(), by_moment(), over_an_extent(), with_layers(),
                             under_law(FrictionKind::capped), under_law(FrictionKind::power)}) {
    const ModelSolution si = solve_in_model_units(scene);
    const ModelSolution other = solve_in_model_units(in_units(scene, units));
    ASSERT_EQ(si.status, Status::converged) << si.message;
    ASSERT_EQ(other.status, Status::converged) << other.message;
    EXPECT_EQ(other.stick_cells, si.stick_cells);
    EXPECT_EQ(other.contact_cells, si.contact_cells);
    EXPECT_EQ(other.tangential.iterations, si.tangential.iterations);
    EXPECT_LE(difference(other.normal.pressure, si.normal.pressure), kTolerance);
    EXPECT_LE(difference(other.tangential.traction, si.tangential.traction), kTolerance);
    EXPECT_LE(difference(other.tangential.slip, si.tangential.slip), kTolerance);
    EXPECT_LE(difference(other.twist_angle, si.twist_angle), kTolerance);
    EXPECT_LE(difference(other.moment, si.moment * moment), kTolerance);
    EXPECT_LE(difference(other.moment_limit, si.moment_limit * moment), kTolerance);
    EXPECT_LE(difference(other.normal_load, si.normal_load * units.newton), kTolerance);
    EXPECT_LE(difference(other.peak_pressure, si.peak_pressure * pascal), kTolerance);
    EXPECT_LE(difference(other.contact_radius, si.contact_radius * units.metre), kTolerance);
    EXPECT_LE(difference(other.stick_radius_counted, si.stick_radius_counted * units.metre), kTolerance);
    EXPECT_LE(difference(other.approach, si.approach * units.metre), kTolerance);
  }
}

/// The cost: a model's numbers equal the scene's to 12 digits only.
TEST(OverUnit, KeepsTwelveDigits) {
  for (const double value : {1.0, 0.1, 1.0 / 3.0, 6.02e23, -1.6e-19}) {
    EXPECT_LE(std::abs(to_dimensionless(value, 1.0) / value - 1.0), 0x1p-40);
    EXPECT_EQ(to_dimensionless(std::nextafter(value, 2.0 * value), 1.0), to_dimensionless(value, 1.0));
  }
  EXPECT_EQ(to_dimensionless(0.0, 3.0), 0.0);
  EXPECT_EQ(to_dimensionless(0x1.8p10, 0x1p3), 0x1.8p7);
}

}  // namespace
}  // namespace slipstick::solver
