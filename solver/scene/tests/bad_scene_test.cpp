// Scenes that are refused, each with a message that says where, what and what is allowed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <vector>

#include "solver/model.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

using testing::HasSubstr;

struct BadScene {
  std::string name;
  std::string replace;  ///< text of the scene; empty: nothing
  std::string by;
  std::vector<std::string> overrides;
  std::vector<std::string> says;  ///< parts of the message: where, key, value, what is allowed
};

void PrintTo(const BadScene& scene, std::ostream* stream) { *stream << scene.name; }

/// One that has these keys in place of its sphere.
BadScene bad_surface(const std::string& name, const std::string& keys, const std::vector<std::string>& says) {
  return {name, "shape = \"sphere\"\nradius = 0.018", keys, {}, says};
}

const std::string kRough = "shape = \"roughness\"\nlongest = 1e-4\n";

std::vector<BadScene> bad_surfaces() {
  const std::string roughness = kRough + "seed = 1\nhurst = 0.8\nrms_slope = 0.1\n";
  return {
      bad_surface("inner_radius_too_large", "shape = \"flat_punch\"\nradius = 1e-3\ninner_radius = 1e-3",
                  {"scene.toml:5", "upper.inner_radius = 0.001", "below the radius"}),
      bad_surface("power_below_1", "shape = \"power\"\nexponent = 0.5\ncoefficient = 1",
                  {"upper.exponent = 0.5", "from 1 to 20"}),
      bad_surface("place_of_length_3", "shape = \"sphere\"\nradius = 1\nat = [0, 0, 0]",
                  {"upper.at = [0, 0, 0]", "[a, b], two numbers"}),
      bad_surface("place_nowhere", "shape = \"sphere\"\nradius = 1\nat = [0, inf]", {"upper.at", "finite"}),
      bad_surface("angle_nan", "shape = \"sphere\"\nradius = 1\nangle = nan",
                  {"upper.angle = nan", "finite"}),
      bad_surface("place_of_a_map", "shape = \"height_map\"\nfile = \"h.csv\"\nspacing = [1, 1]\nat = [0, 0]",
                  {"upper.at = [0, 0]", "unknown key"}),
      bad_surface("unit_of_heights",
                  "shape = \"height_map\"\nfile = \"h.csv\"\nspacing = [1, 1]\nunit = \"cm\"",
                  {"upper.unit = \"cm\"", "m, mm, um, nm"}),
      bad_surface("combining_one_shape", "shape = \"sphere\"\nradius = 1\ncombine = \"sum\"",
                  {"upper.combine = ", "unknown key"}),
      bad_surface("hurst_0", kRough + "hurst = 0\nseed = 1", {"upper.hurst = 0", "above 0, at most 1"}),
      bad_surface("hurst_above_1", kRough + "hurst = 1.1\nseed = 1",
                  {"upper.hurst = 1.1", "above 0, at most 1"}),
      bad_surface("seed_not_whole", kRough + "seed = 1.5", {"upper.seed = 1.5", "a whole number from 0"}),
      bad_surface("period_too_short", roughness + "shortest = 1e-5\nperiod = 9e-5",
                  {"upper.period = 9e-05", "at least longest = 0.0001"}),
      bad_surface("less_than_an_octave", roughness + "shortest = 6e-5",
                  {"upper.shortest = 6e-05", "to half of longest, 5e-05"}),
      bad_surface("too_many_waves", roughness + "shortest = 3e-7",
                  {"upper.shortest = 3e-07", "from a 1024th of the period, 3.90625e-07"}),
      bad_surface("no_shapes", "shape = []", {"scene.toml:3", "upper.shape = []", "[[upper.shape]]"}),
      bad_surface("shapes_that_are_numbers", "shape = [1, 2]", {"upper.shape = [1, 2]", "[[upper.shape]]"}),
      bad_surface("second_shape_without_radius",
                  "shape = [{shape = \"sphere\", radius = 1}, {shape = \"sphere\"}]",
                  {"upper.shape[1].radius", "(missing)"}),
      bad_surface("misspelt_key_of_a_shape", "shape = [{shape = \"sphere\", radius = 1, angel = 2}]",
                  {"upper.shape[0].angel = 2", "nearest known one is upper.shape[0].angle"}),
      bad_surface("radius_beside_shapes", "radius = 1\nshape = [{shape = \"sphere\", radius = 1}]",
                  {"upper.radius = 1", "unknown key"}),
      bad_surface("unknown_combination",
                  "combine = \"product\"\nshape = [{shape = \"sphere\", radius = 1}, "
                  "{shape = \"sphere\", radius = 1}]",
                  {"upper.combine = \"product\"", "sum, nearest"}),
      {"hertz_of_a_body_that_stands_elsewhere",
       "radius = 0.018",
       "radius = 0.018\nat = [1e-4, 0]",
       {"contact.pressure=hertz"},
       {"contact.pressure = \"hertz\"", "solved, file", "at the origin"}},
  };
}

std::vector<BadScene> bad_scenes() {
  const std::string file = "scene.toml";
  return {
      {"unknown_key",
       "friction = 0.1",
       "friction = 0.1\nfricton = 0.2",
       {},
       {file + ":12", "contact.fricton = 0.2", "unknown key", "nearest known one is contact.friction"}},
      {"unknown_table",
       "[grid]",
       "[gird]\ncells = [1, 2]\n[grid]",
       {},
       {file, "gird.cells", "nearest known one is grid.cells"}},
      {"misspelt_required_key",
       "friction = 0.1",
       "frictoin = 0.1",
       {},
       {file + ":11", "contact.frictoin = 0.1", "nearest known one is contact.friction"}},
      {"quoted_key_with_a_dot",
       "[contact]",
       "\"contact.friction \" = 1\n[contact]",
       {},
       {file, "unknown key"}},
      {"quoted_key_with_a_bracket",
       "[contact]",
       "\"frict[ion\" = 1\n[contact]",
       {},
       {file, "frict[ion", "unknown key"}},
      {"missing_key", "friction = 0.1", "", {}, {file, "contact.friction", "(missing)", "a number"}},
      {"missing_shape", "shape = \"sphere\"", "", {}, {file, "upper.shape", "(missing)"}},
      {"text_for_a_number",
       "normal = 1000.0",
       "normal = \"1 kN\"",
       {},
       {file + ":15", "load.normal", "1 kN", "a number"}},
      {"number_for_text",
       "shape = \"sphere\"",
       "shape = 3",
       {},
       {file + ":3", "upper.shape = 3", "a string"}},
      {"truth_for_a_number",
       "radius = 0.018",
       "radius = true",
       {},
       {file + ":4", "upper.radius = true", "a number"}},
      {"negative_load",
       "normal = 1000.0",
       "normal = -1000.0",
       {},
       {file + ":15", "load.normal = -1000:", "positive and finite"}},
      {"zero_radius",
       "radius = 0.018",
       "radius = 0",
       {},
       {file + ":4", "upper.radius = 0", "positive and finite"}},
      {"infinite_modulus",
       "young_modulus = 210e9",
       "young_modulus = inf",
       {},
       {file + ":5", "upper.young_modulus = inf", "positive and finite"}},
      {"poisson_0.6",
       "poisson_ratio = 0.3",
       "poisson_ratio = 0.6",
       {},
       {file + ":6", "upper.poisson_ratio = 0.6", "above -1, at most 0.5"}},
      {"poisson_below_all",
       "poisson_ratio = 0.3",
       "poisson_ratio = -1.0",
       {},
       {"upper.poisson_ratio = -1", "above -1, at most 0.5"}},
      {"negative_friction",
       "friction = 0.1",
       "friction = -0.1",
       {},
       {"contact.friction = -0.1", "zero or positive"}},
      {"moment_ratio_1",
       "moment_ratio = 0.9",
       "moment_ratio = 1.0",
       {},
       {file + ":16", "load.moment_ratio = 1:", "above -1 and below 1", "gross slip"}},
      {"moment_ratio_nan",
       "moment_ratio = 0.9",
       "moment_ratio = nan",
       {},
       {"load.moment_ratio = nan", "above -1 and below 1"}},
      {"infinite_moment", "moment_ratio = 0.9", "moment = inf", {}, {"load.moment = inf:", "finite"}},
      {"infinite_twist", "moment_ratio = 0.9", "twist = inf", {}, {"load.twist = inf", "finite"}},
      {"tolerance_0",
       "tolerance = 1e-7",
       "tolerance = 0",
       {},
       {"solver.tolerance = 0", "from 1e-15 to below 1"}},
      {"tolerance_nan",
       "tolerance = 1e-7",
       "tolerance = nan",
       {},
       {"solver.tolerance = nan", "from 1e-15 to below 1"}},
      {"two_torsion_loads",
       "moment_ratio = 0.9",
       "moment_ratio = 0.9\ntwist = 1e-3",
       {},
       {file, "load.twist", "exactly one of load.moment_ratio, load.moment, load.twist"}},
      {"no_torsion_load",
       "moment_ratio = 0.9",
       "",
       {},
       {file, "(missing)", "exactly one of load.moment_ratio, load.moment, load.twist"}},
      {"force_beside_displacement",
       "force = [0.0, 0.0]",
       "force = [0.0, 1.0]\ndisplacement = [0.0, 1e-6]",
       {},
       {"load.displacement", "one of force, displacement"}},
      {"force_for_the_papers_method",
       "force = [0.0, 0.0]",
       "force = [0.0, 1.0]",
       {},
       {"solver.method = \"paper\"", "coulomb"}},
      {"cells_not_whole",
       "cells = [128, 96]",
       "cells = [128.5, 96]",
       {},
       {"grid.cells", "128.5", "a whole number from 1 to 65536"}},
      {"cells_none",
       "cells = [128, 96]",
       "cells = [128, 0]",
       {},
       {"grid.cells", "a whole number from 1 to 65536"}},
      {"cells_of_length_1", "cells = [128, 96]", "cells = [128]", {}, {"grid.cells", "[a, b], two numbers"}},
      {"cells_of_length_3",
       "cells = [128, 96]",
       "cells = [128, 96, 3]",
       {},
       {"grid.cells", "[a, b], two numbers"}},
      {"cells_as_a_number",
       "cells = [128, 96]",
       "cells = 128",
       {},
       {"grid.cells = 128", "[a, b], two numbers"}},
      {"cells_as_text",
       "cells = [128, 96]",
       "cells = [\"a\", \"b\"]",
       {},
       {"grid.cells", "[a, b], two numbers"}},
      {"negative_extent",
       "extent = [0.0011, 0.0012]",
       "extent = [-1.0, 1.0]",
       {},
       {"grid.extent", "positive and finite"}},
      {"unknown_shape",
       "shape = \"sphere\"",
       "shape = \"cube\"",
       {},
       {file + ":3", "upper.shape = \"cube\"",
        "sphere, ellipsoid, cone, flat_punch, rounded_punch, power, height_map, roughness"}},
      {"unknown_pressure",
       "pressure = \"solved\"",
       "pressure = \"Hertz\"",
       {},
       {"contact.pressure = \"Hertz\"", "solved, hertz, hertz_averaged, file"}},
      {"unknown_coupling",
       "coupling = \"auto\"",
       "coupling = \"both\"",
       {},
       {"contact.coupling = \"both\"", "auto, none, pressure, full"}},
      {"unknown_operator",
       "operator = \"dcfft\"",
       "operator = \"fft\"",
       {},
       {"solver.operator = \"fft\"", "dcfft, direct, dense"}},
      {"unknown_method",
       "method = \"paper\"",
       "method = \"magic\"",
       {},
       {"solver.method = \"magic\"", "paper"}},
      {"unknown_model", "model = \"auto\"", "model = \"some\"", {}, {"solver.model = \"some\"", "auto"}},
      {"no_threads", "threads = 2", "threads = -1", {}, {"solver.threads = -1", "a whole number from 0"}},
      {"no_iterations",
       "max_iterations = 70",
       "max_iterations = 0",
       {},
       {"solver.max_iterations = 0", "a whole number from 1"}},
      {"rigid_with_modulus",
       "radius = 0.018",
       "radius = 0.018\nrigid = true",
       {},
       {file, "upper.rigid = true", "upper.young_modulus left out"}},
      {"rigid_not_a_truth",
       "radius = 0.018",
       "radius = 0.018\nrigid = 1",
       {},
       {"upper.rigid = 1", "true, false"}},
      {"hertz_pressure_of_a_cone",
       "shape = \"sphere\"\nradius = 0.018",
       "shape = \"cone\"\nslope = 0.1",
       {"contact.pressure=hertz"},
       {"contact.pressure", "\"hertz\"", "solved, file"}},
      {"keys_of_another_shape",
       "shape = \"sphere\"",
       "shape = \"cone\"\nslope = 0.1",
       {},
       {"upper.radius = 0.018", "unknown key"}},
      {"pressure_file_without_extent",
       "extent = [0.0011, 0.0012]",
       "",
       {"contact.pressure=file", "contact.pressure_file=p.csv"},
       {"grid.extent", "(missing)"}},
      {"syntax", "friction = 0.1", "friction = = 0.1", {}, {file + ":11"}},
      {"a_key_twice", "friction = 0.1", "friction = 0.1\nfriction = 0.2", {}, {file + ":12"}},
      {"override_of_a_table", "", "", {"load=3"}, {"--set", "load = 3", "a table with the key load.normal"}},
      {"two_torsion_loads_in_overrides",
       "",
       "",
       {"load.twist=1e-3", "load.moment=1e-3"},
       {"--set", "exactly one of load.moment_ratio, load.moment, load.twist"}},
      {"override_without_equals", "", "", {"load.normal"}, {"--set load.normal", "key=value"}},
      {"override_without_key", "", "", {"=3"}, {"--set =3", "key=value"}},
      {"override_of_an_unknown_key",
       "",
       "",
       {"load.nromal=3"},
       {"--set", "load.nromal = 3", "unknown key", "load.normal"}},
      {"override_out_of_range",
       "",
       "",
       {"load.normal=-3"},
       {"--set", "load.normal = -3", "positive and finite"}},
      {"override_below_a_value",
       "",
       "",
       {"load.normal.x=3"},
       {"--set load.normal.x=3", "normal is not a table"}},
      {"empty", kScene, "", {}, {file, "upper.shape", "(missing)"}},
  };
}

class Bad : public SceneFile, public testing::WithParamInterface<BadScene> {};
const auto kName = [](const auto& tested) {
  std::string name = tested.param.name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
};
INSTANTIATE_TEST_SUITE_P(Scenes, Bad, testing::ValuesIn(bad_scenes()), kName);
INSTANTIATE_TEST_SUITE_P(Surfaces, Bad, testing::ValuesIn(bad_surfaces()), kName);

TEST_P(Bad, IsRefusedWithFileKeyValueAndWhatIsAllowed) {
  std::string text = kScene;
  if (!GetParam().replace.empty()) {
    const auto at = text.find(GetParam().replace);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, GetParam().replace.size(), GetParam().by);
  }
  const std::string said = complaint([&] { read(text, GetParam().overrides); });
  EXPECT_NE(said, "");
  for (const std::string& part : GetParam().says) EXPECT_THAT(said, HasSubstr(part));
}

TEST_F(SceneFile, OfTwoRigidBodiesIsRefused) {
  std::string text = kShortScene;
  const std::string elastic = "young_modulus = 210e9\npoisson_ratio = 0.3\n";
  for (int body = 0; body < 2; ++body) text.replace(text.find(elastic), elastic.size(), "rigid = true\n");
  EXPECT_THAT(complaint([&] { read(text); }),
              testing::AllOf(HasSubstr("scene.toml"), HasSubstr("lower.rigid = true"), HasSubstr("false")));
}

TEST_F(SceneFile, ThatIsNoneIsRefused) {
  EXPECT_THAT(complaint([&] { read_scene(folder_ / "none.toml"); }),
              testing::AllOf(HasSubstr("none.toml"), HasSubstr("cannot be read")));
  EXPECT_THAT(complaint([&] { read_scene(folder_); }),
              testing::AllOf(HasSubstr(folder_.string()), HasSubstr("is a folder")));
  const auto binary = write("binary.toml", std::string("\x89HDF\r\n\x1a\n\0\0\0\0", 12));
  EXPECT_THAT(complaint([&] { read_scene(binary); }),
              testing::AllOf(HasSubstr("binary.toml"), HasSubstr("binary file")));
}

TEST_F(SceneFile, OfMoreCellsThanFitInMemoryIsRefused) {
  const Scene scene = read(kShortScene, {"grid.cells=[4096, 4096]", "solver.operator=dense"});
  EXPECT_THAT(complaint([&] { make_model(scene); }),
              testing::AllOf(HasSubstr("scene.toml"), HasSubstr("grid.cells = [4096, 4096]"),
                             HasSubstr("fits in memory"), HasSubstr("operator = \"dense\"")));
}

TEST_F(SceneFile, OfASumWithoutAnExtentIsRefused) {
  std::string text = kShortScene;
  text.replace(text.find("shape = \"sphere\"\nradius = 0.018"), 31,
               "shape = [{shape = \"sphere\", radius = 1}, {shape = \"sphere\", radius = 1}]");
  const Scene scene = read(text);
  EXPECT_THAT(
      complaint([&] { make_model(scene); }),
      testing::AllOf(HasSubstr("scene.toml"), HasSubstr("grid.extent = (missing)"), HasSubstr("[L1, L2]")));
}

TEST_F(SceneFile, OfAnExtentSmallerThanTheContactIsRefused) {
  const Scene scene =
      read(kShortScene, {"grid.extent=[0.0009, 0.0011]"});  // the contact's diameter is 0.978 mm
  EXPECT_THAT(
      complaint([&] { make_model(scene); }),
      testing::AllOf(HasSubstr("grid.extent = [0.0009, 0.0011]"), HasSubstr("larger than the contact")));
  const auto complains = [&](const std::vector<std::string>& overrides) {
    return complaint([&] { make_model(read(kShortScene, overrides)); });
  };
  EXPECT_THAT(complains({"grid.extent=[1, 1]"}),
              testing::AllOf(HasSubstr("grid.extent = [1, 1]"), HasSubstr("at most 16 times the contact")));
  EXPECT_THAT(complains({"grid.extent=[0.0011, 0.0011]", "grid.cells=[8, 16384]"}),
              testing::AllOf(HasSubstr("grid.cells = [8, 16384]"), HasSubstr("1000 times as long as wide")));
}

}  // namespace
}  // namespace slipstick::solver
