// Scenes as their reader makes them of a file.

#include "solver/scene/scene_keys.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "solver/model/make_model.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

TEST_F(SceneFile, NeedsNoMoreThanTheProblem) {
  const Scene scene = read(kShortScene);
  EXPECT_EQ(scene.name, "scene");  // the file's
  EXPECT_FALSE(scene.grid.extent);
  EXPECT_EQ(scene.steps[0].normal, 1000.0);  // written as a whole number
  EXPECT_EQ(read(std::string(kShortScene) + "[solver]\n").solver.tolerance, scene.solver.tolerance);
}

TEST_F(SceneFile, MayHaveALayerOnABody) {
  const std::string layer = "[lower.layer]\nthickness = 1e-4\nyoung_modulus = 1e9\npoisson_ratio = 0.5\n";
  Scene scene = read(std::string(kShortScene) + layer);
  EXPECT_TRUE(!scene.upper.coating && scene.lower.coating && is_coated(scene) && !is_bare(scene));
  EXPECT_EQ(scene.lower.coating->thickness, 1e-4);
  EXPECT_EQ(scene.lower.coating->young_modulus, 1e9);
  EXPECT_EQ(scene.lower.coating->poisson_ratio, 0.5);
  scene.upper.young_modulus = scene.lower.young_modulus = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(validate(scene));
}

TEST_F(SceneFile, HasEachShapeWithItsKeys) {
  const auto shape = [&](const std::string& keys) { return read(with_surface(keys)).surfaces.front(); };
  const Surface sphere = read(kShortScene).surfaces.front();
  EXPECT_EQ(sphere.at, (std::array{0.0, 0.0}));
  EXPECT_EQ(sphere.angle, 0.0);
  const Surface tube =
      shape("shape = \"flat_punch\"\nradius = 2e-3\ninner_radius = 1e-3\nat = [1e-3, -2e-3]\nangle = 0.5\n");
  EXPECT_EQ(tube.shape, Shape::flat_punch);
  EXPECT_EQ(tube.inner_radius, 1e-3);
  EXPECT_EQ(tube.at, (std::array{1e-3, -2e-3}));
  EXPECT_EQ(tube.angle, 0.5);
  const Surface ellipsoid = shape("shape = \"ellipsoid\"\nradius_1 = 0.02\nradius_2 = 0.01\n");
  EXPECT_EQ(ellipsoid.radius_1, 0.02);
  EXPECT_EQ(ellipsoid.radius_2, 0.01);
  EXPECT_EQ(shape("shape = \"cone\"\nslope = 0.1\n").slope, 0.1);
  const Surface rounded = shape("shape = \"rounded_punch\"\nflat_radius = 1e-3\ncorner_radius = 2e-3\n");
  EXPECT_EQ(rounded.flat_radius, 1e-3);
  EXPECT_EQ(rounded.corner_radius, 2e-3);
  const Surface power = shape("shape = \"power\"\nexponent = 4\ncoefficient = 3e7\n");
  EXPECT_EQ(power.exponent, 4.0);
  EXPECT_EQ(power.coefficient, 3e7);
  const Surface map =
      shape("shape = \"height_map\"\nfile = \"sub/heights.csv\"\nspacing = [1e-5, 2e-5]\nunit = \"um\"\n");
  EXPECT_EQ(map.map.file, folder_ / "sub/heights.csv");  // relative to the scene
  EXPECT_EQ(map.map.spacing, (std::array<double, 2>{1e-5, 2e-5}));
  EXPECT_EQ(map.map.unit, 1e-6);
}

TEST_F(SceneFile, MayHaveSeveralShapes) {
  const char* const tables = R"([[upper.shape]]
shape = "sphere"
radius = 0.01
[[upper.shape]]
shape = "roughness"
seed = 12
hurst = 0.7
longest = 2e-4
shortest = 1e-5
rms_slope = 0.1
)";
  const Scene scene = read(with_surface("", tables));
  ASSERT_EQ(scene.surfaces.size(), 2);
  EXPECT_EQ(scene.combine, Combine::sum);
  EXPECT_EQ(scene.surfaces[0].radius, 0.01);
  const Roughness& roughness = scene.surfaces[1].roughness;
  EXPECT_EQ(roughness.seed, 12);
  EXPECT_EQ(roughness.hurst, 0.7);
  EXPECT_EQ(roughness.longest, 2e-4);
  EXPECT_EQ(roughness.shortest, 1e-5);
  EXPECT_EQ(roughness.rms_slope, 0.1);
  EXPECT_EQ(roughness.period, 8e-4);
  EXPECT_EQ(scene.upper.young_modulus, 210e9);
  const Scene other = read(with_surface("combine = \"nearest\"\n", tables),
                           {"upper.shape[0].radius=0.02", "upper.shape[1].period=1e-3"});
  EXPECT_EQ(other.combine, Combine::nearest);
  EXPECT_EQ(other.surfaces[0].radius, 0.02);
  EXPECT_EQ(other.surfaces[1].roughness.period, 1e-3);
}

TEST_F(SceneFile, OverridesAreAppliedFirst) {
  const Scene scene = read(kShortScene, {"load.normal=5", "grid.cells=[8, 9]", "contact.pressure=hertz",
                                         "name=other", "solver.operator=\"dense\"", "load.normal=6"});
  EXPECT_EQ(scene.steps[0].normal, 6.0);  // the last one holds
  EXPECT_EQ(scene.grid.cells, (std::array<Index, 2>{8, 9}));
  EXPECT_EQ(scene.contact.pressure, PressureModel::hertz);
  EXPECT_EQ(scene.name, "other");
  EXPECT_EQ(scene.solver.op, OperatorKind::dense);
  // A wrong value in the file does not matter where it is overridden.
  std::string text = kShortScene;
  text.replace(text.find("friction = 0.1"), 14, "friction = \"x\"");
  EXPECT_EQ(read(text, {"contact.friction=0.2"}).contact.friction.coefficient, 0.2);
}

TEST_F(SceneFile, OneTorsionLoadOverridesAnother) {
  const Scene scene = read(kShortScene, {"load.twist=1e-3"});
  EXPECT_EQ(value_if<Twist>(scene.steps[0].torsion), 1e-3);
  EXPECT_FALSE(value_if<MomentRatio>(scene.steps[0].torsion) || value_if<Moment>(scene.steps[0].torsion));
}

TEST_F(SceneFile, ARigidBodyHasNoModulus) {
  std::string text = kShortScene;
  const std::string modulus =
      "[upper]\nshape = \"sphere\"\nradius = 0.018\nyoung_modulus = 210e9\npoisson_ratio = 0.3\n";
  text.replace(0, modulus.size(), "[upper]\nshape = \"sphere\"\nradius = 0.018\nrigid = true\n");
  const Scene scene = read(text);
  EXPECT_TRUE(std::isinf(scene.upper.young_modulus));
  const Model model = make_model(scene);
  EXPECT_DOUBLE_EQ(model.stress_unit, 210e9 / 2.6);  // of the elastic body
}

}  // namespace
}  // namespace slipstick::solver
