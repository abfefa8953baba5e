// The reader agrees with the table of keys: it reads each key, refuses other values with the table's words,
// and accepts the key with the shapes that the table names.

#include "solver/scene/scene_keys.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

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

/// Members that have defaults.
std::string members(const Scene& scene) {
  const Surface& surface = scene.surfaces[0];
  return fmt::format(
      "{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", scene.layer.kind == nullptr,
      static_cast<int>(scene.contact.pressure), static_cast<int>(scene.contact.coupling),
      static_cast<int>(scene.solver.method), static_cast<int>(scene.solver.model),
      static_cast<int>(scene.solver.op), static_cast<int>(scene.solver.cell_traction), scene.solver.tolerance,
      scene.solver.max_iterations, scene.solver.threads, scene.solver.rounding_seed, scene.cycles,
      scene.ends_at_grid_edge, scene.upper.young_modulus, scene.lower.young_modulus, surface.at[0],
      surface.at[1], surface.angle, surface.inner_radius, surface.map.unit);
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

TEST_F(SceneKeys, HaveDefaultsThatChangeNothing) {
  std::size_t tried = 0;
  for (const SettingKey& key : scene_keys()) {
    const bool is_value =
        key.type == KeyType::word || key.type == KeyType::flag ||
        (!key.otherwise.empty() && key.otherwise.find_first_not_of("0123456789.e-[], ") == std::string::npos);
    if (!is_value || key.otherwise == kRequired || key.name.starts_with("upper.shape.") ||
        key.name == "upper.combine" || key.name == "load.force") {
      continue;
    }
    const std::string shape = key.shapes.empty() ? "sphere" : key.shapes.front();
    std::string text = scene_with(shape, false);
    // Where the pressure comes from a file, that is no default.
    const std::string file = "pressure = \"file\"\npressure_file = \"p.csv\"\n";
    text.erase(text.find(file), file.size());
    const Scene without = read_scene(write("scene.toml", text));
    const Scene with = read_scene(write("scene.toml", text), {key.name + "=" + key.otherwise});
    EXPECT_EQ(members(with), members(without)) << key.name;
    ++tried;
  }
  EXPECT_GE(tried, 15u);
}

TEST_F(SceneKeys, StandInTheTableOnceEach) {
  std::set<std::string> names;
  for (const SettingKey& key : scene_keys()) EXPECT_TRUE(names.insert(key.name).second) << key.name;
}

}  // namespace
}  // namespace slipstick::solver
