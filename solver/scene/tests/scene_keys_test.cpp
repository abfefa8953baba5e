// The reader agrees with the table of keys: it reads each key, refuses other values with the table's words,
// and accepts the key with the shapes that the table names.

#include "solver/scene/scene_keys.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "solver/model/make_model.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

using testing::HasSubstr;

/// Required keys of each shape.
const std::map<std::string, std::string> kShapeKeys{
    {"sphere", "radius = 1\n"},
    {"ellipsoid", "radius_1 = 1\nradius_2 = 2\n"},
    {"cone", "slope = 0.1\n"},
    {"power", "exponent = 4\ncoefficient = 1\n"},
    {"flat_punch", "radius = 1\n"},
    {"rounded_punch", "flat_radius = 1\ncorner_radius = 1\n"},
    {"height_map", "file = \"heights.csv\"\nspacing = [1, 1]\n"},
    {"roughness", "seed = 1\nhurst = 0.8\nrms_slope = 0.1\nlongest = 1\nshortest = 0.1\n"}};

/// The one shape of [upper], or the second of two.
std::string scene_with(const std::string& shape, bool several) {
  const std::string keys = fmt::format("shape = \"{}\"\n{}", shape, kShapeKeys.at(shape));
  const std::string body = "young_modulus = 1\npoisson_ratio = 0.3\n";
  return "[upper]\n" + body +
         (several ? "[[upper.shape]]\nshape = \"sphere\"\nradius = 1\n[[upper.shape]]\n" : "") + keys +
         "[lower]\n" + body +
         "[contact]\nfriction = 0.1\npressure = \"file\"\npressure_file = \"p.csv\"\n"
         "[load]\nnormal = 1\n[[step]]\n[grid]\ncells = [8, 8]\n" +
         (shape == "height_map" ? "" : "extent = [1, 1]\n");
}

/// The law that knows a key of the friction.
std::vector<std::string> friction_of(const std::string& key) {
  if (key == "contact.shear_strength") return {"contact.friction_law=capped"};
  if (key == "contact.friction_exponent") return {"contact.friction_law=power"};
  return {};
}

const std::string kCoating = "thickness = 1\nyoung_modulus = 1\npoisson_ratio = 0.3\n";
const std::string kLayer = "[layer]\nkind = \"winkler\"\nnormal_compliance = 1\ntangential_compliance = 1\n";

/// A value that the type has not, and the end of the message about it.
struct Wrong {
  std::string value;
  std::string allowed;
};

Wrong wrong_for(const SettingKey& key) {
  switch (key.type) {
    case KeyType::number:
      // A range that depends on another key says its number: "at least longest = 1, finite".
      return {"\"no\"", "a number, " + key.allowed.words.substr(0, key.allowed.words.find(','))};
    case KeyType::pair:
      return {"1", "[a, b], two numbers, each " + key.allowed.words};
    case KeyType::word:
      return {"\"no such word\"", "allowed: " + key.allowed.words};
    case KeyType::text:
    case KeyType::file:
      return {"1", "a string"};
    case KeyType::flag:
      return {"1", "true, false"};
    case KeyType::tables:
      return {"1", "tables, each headed [[" + key.name + "]]"};
    default:
      return {"", "no type of a scene's key"};
  }
}

class SceneKeys : public SceneFile {
 protected:
  /// The complaint about a wrong value for a key.
  std::string complaint_of(const SettingKey& key, const std::string& shape) const {
    const bool several = key.name.starts_with("upper.shape.") || key.name == "upper.combine";
    std::string name = key.name;
    if (several && key.name != "upper.combine") name.replace(0, 12, "upper.shape[1].");
    if (name.starts_with("step.")) name.replace(0, 5, "step[0].");
    std::string text = scene_with(shape, several) + (key.name.starts_with("layer.") ? kLayer : "");
    for (const std::string table : {"upper.layer", "lower.layer"}) {
      if (key.name.starts_with(table + ".")) text += "[" + table + "]\n" + kCoating;
    }
    std::vector<std::string> overrides = friction_of(key.name);
    overrides.push_back(name + "=" + wrong_for(key).value);
    return complaint([&] { read_scene(write("scene.toml", text), overrides); });
  }
};

TEST_F(SceneKeys, AreReadAndRefuseWhatTheTableDoesNotAllow) {
  for (const SettingKey& key : scene_keys()) {
    const std::string shape = key.shapes.empty() ? "sphere" : key.shapes.front();
    EXPECT_THAT(complaint_of(key, shape), HasSubstr(wrong_for(key).allowed)) << key.name;
  }
}

TEST_F(SceneKeys, BelongToTheShapesThatTheTableNames) {
  for (const SettingKey& key : scene_keys()) {
    if (key.shapes.empty() || key.name.starts_with("upper.shape.")) continue;
    for (const auto& [shape, needs] : kShapeKeys) {
      const bool has = std::ranges::find(key.shapes, shape) != key.shapes.end();
      const std::string said = complaint_of(key, shape);
      EXPECT_EQ(said.find("unknown key") == std::string::npos, has)
          << key.name << " of " << shape << ": " << said;
    }
  }
}

TEST_F(SceneKeys, StandInTheTableOnceEach) {
  std::set<std::string> names;
  for (const SettingKey& key : scene_keys()) EXPECT_TRUE(names.insert(key.name).second) << key.name;
}

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
