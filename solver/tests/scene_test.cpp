#include "solver/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "solver/field_file.hpp"
#include "solver/input_error.hpp"
#include "solver/model.hpp"
#include "solver/pressure.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

/// Numbers enter a model rounded to 40 bits (over_unit).
constexpr double kModelRounding = 0x1p-40;

using testing::HasSubstr;

constexpr const char* kScene = R"(name = "paper"
[upper]
shape = "sphere"
radius = 0.018
young_modulus = 210e9
poisson_ratio = 0.3
[lower]
young_modulus = 210e9
poisson_ratio = 0.3
[contact]
friction = 0.1
pressure = "solved"
coupling = "auto"
[load]
normal = 1000.0
moment_ratio = 0.9
force = [0.0, 0.0]
[grid]
cells = [128, 96]
extent = [0.0011, 0.0012]
[solver]
method = "paper"
operator = "dcfft"
tolerance = 1e-7
max_iterations = 70
threads = 2
model = "auto"
)";

constexpr const char* kShortScene = R"([upper]
shape = "sphere"
radius = 0.018
young_modulus = 210e9
poisson_ratio = 0.3
[lower]
young_modulus = 210e9
poisson_ratio = 0.3
[contact]
friction = 0.1
[load]
normal = 1000
moment_ratio = 0.9
[grid]
cells = [32, 32]
)";

class SceneFile : public testing::Test {
 protected:
  SceneFile() { std::filesystem::create_directories(folder_); }
  ~SceneFile() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Scene read(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return read_scene(write("scene.toml", text), overrides);
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("scene_" + std::to_string(::getpid()));
};

TEST_F(SceneFile, IsReadKeyByKey) {
  const Scene scene = read(kScene);
  EXPECT_EQ(scene.source, folder_ / "scene.toml");
  EXPECT_EQ(scene.name, "paper");
  EXPECT_EQ(scene.surface.shape, Shape::sphere);
  EXPECT_EQ(scene.surface.radius, 0.018);
  EXPECT_EQ(scene.upper.young_modulus, 210e9);
  EXPECT_EQ(scene.upper.poisson_ratio, 0.3);
  EXPECT_EQ(scene.lower.young_modulus, 210e9);
  EXPECT_EQ(scene.friction, 0.1);
  EXPECT_EQ(scene.pressure, PressureModel::solved);
  EXPECT_EQ(scene.coupling, Coupling::automatic);
  EXPECT_EQ(scene.normal_load, 1000.0);
  EXPECT_EQ(scene.torsion.moment_ratio, 0.9);
  EXPECT_FALSE(scene.torsion.moment || scene.torsion.twist);
  EXPECT_EQ(scene.cells, (std::array<Index, 2>{128, 96}));
  EXPECT_EQ(scene.extent, (std::array<double, 2>{0.0011, 0.0012}));
  EXPECT_EQ(scene.op, OperatorKind::dcfft);
  EXPECT_EQ(scene.tolerance, 1e-7);
  EXPECT_EQ(scene.max_iterations, 70);
  EXPECT_EQ(scene.threads, 2);
}

TEST_F(SceneFile, NeedsNoMoreThanTheProblem) {
  const Scene scene = read(kShortScene);
  EXPECT_EQ(scene.name, "scene");  // the file's
  EXPECT_EQ(scene.pressure, PressureModel::solved);
  EXPECT_EQ(scene.coupling, Coupling::automatic);
  EXPECT_EQ(scene.op, OperatorKind::dcfft);
  EXPECT_FALSE(scene.extent);
  EXPECT_EQ(scene.tolerance, 1e-8);
  EXPECT_EQ(scene.threads, 1);
  EXPECT_EQ(scene.normal_load, 1000.0);  // written as a whole number
}

TEST_F(SceneFile, HasEachShapeWithItsKeys) {
  EXPECT_EQ(read(kShortScene, {"upper.shape=flat_punch"}).surface.shape, Shape::flat_punch);
  const std::string text = kShortScene;
  const auto reshaped = [&](const std::string& keys) {
    std::string changed = text;
    const std::string sphere = "shape = \"sphere\"\nradius = 0.018\n";
    return changed.replace(changed.find(sphere), sphere.size(), keys);
  };
  const Scene ellipsoid = read(reshaped("shape = \"ellipsoid\"\nradius_1 = 0.02\nradius_2 = 0.01\n"));
  EXPECT_EQ(ellipsoid.surface.radius_1, 0.02);
  EXPECT_EQ(ellipsoid.surface.radius_2, 0.01);
  EXPECT_EQ(read(reshaped("shape = \"cone\"\nslope = 0.1\n")).surface.slope, 0.1);
  const Scene map =
      read(reshaped("shape = \"height_map\"\nfile = \"sub/heights.csv\"\nspacing = [1e-5, 2e-5]\n"));
  EXPECT_EQ(map.surface.file, folder_ / "sub/heights.csv");  // relative to the scene
  EXPECT_EQ(map.surface.spacing, (std::array<double, 2>{1e-5, 2e-5}));
}

TEST_F(SceneFile, OverridesAreAppliedFirst) {
  const Scene scene = read(kShortScene, {"load.normal=5", "grid.cells=[8, 9]", "contact.pressure=hertz",
                                         "name=other", "solver.operator=\"dense\"", "load.normal=6"});
  EXPECT_EQ(scene.normal_load, 6.0);  // the last one holds
  EXPECT_EQ(scene.cells, (std::array<Index, 2>{8, 9}));
  EXPECT_EQ(scene.pressure, PressureModel::hertz);
  EXPECT_EQ(scene.name, "other");
  EXPECT_EQ(scene.op, OperatorKind::dense);
  // What is wrong in the file but overridden does not matter.
  std::string text = kShortScene;
  text.replace(text.find("friction = 0.1"), 14, "friction = \"x\"");
  EXPECT_EQ(read(text, {"contact.friction=0.2"}).friction, 0.2);
}

TEST_F(SceneFile, OneTorsionLoadOverridesAnother) {
  const Scene scene = read(kShortScene, {"load.twist=1e-3"});
  EXPECT_EQ(scene.torsion.twist, 1e-3);
  EXPECT_FALSE(scene.torsion.moment_ratio || scene.torsion.moment);
}

TEST_F(SceneFile, MayHaveTablesWithoutKeys) {
  EXPECT_EQ(read(std::string(kShortScene) + "[solver]\n").tolerance, 1e-8);
}

TEST_F(SceneFile, ARigidBodyHasNoModulus) {
  std::string text = kShortScene;
  const std::string modulus =
      "[upper]\nshape = \"sphere\"\nradius = 0.018\nyoung_modulus = 210e9\npoisson_ratio = 0.3\n";
  text.replace(0, modulus.size(), "[upper]\nshape = \"sphere\"\nradius = 0.018\nrigid = true\n");
  const Scene scene = read(text);
  EXPECT_TRUE(std::isinf(scene.upper.young_modulus));
  const Model model = make_model(scene);
  EXPECT_DOUBLE_EQ(model.stress_unit, 210e9 / 2.6);  // that of the other body alone
}

TEST_F(SceneFile, WordsAreThoseOfTheFile) {
  for (const char* word : {"sphere", "ellipsoid", "cone", "flat_punch", "height_map"}) {
    std::string text = kShortScene;
    text.replace(
        text.find("shape = \"sphere\"\nradius = 0.018"), 31,
        std::string("shape = \"") + word +
            "\"\nradius = 1.0\nradius_1 = 1.0\nradius_2 = 1.0\nslope = 1.0\nfile = \"f\"\nspacing = [1, 1]");
    try {
      EXPECT_EQ(to_string(read(text).surface.shape), word);
      ADD_FAILURE() << "keys of other shapes are unknown to " << word;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("unknown key"));
    }
  }
  EXPECT_EQ(to_string(PressureModel::hertz_averaged), "hertz_averaged");
  EXPECT_EQ(to_string(OperatorKind::direct), "direct");
  EXPECT_EQ(to_string(Shape::flat_punch), "flat_punch");
}

// --- bad scenes ---

struct BadScene {
  std::string name;
  std::string replace;  ///< text of the scene; empty: nothing
  std::string by;
  std::vector<std::string> overrides;
  std::vector<std::string> says;  ///< parts of the message: where, key, value, what is allowed
};

void PrintTo(const BadScene& scene, std::ostream* stream) { *stream << scene.name; }

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
       {file + ":6", "upper.poisson_ratio = 0.6", "from 0 to 0.5"}},
      {"negative_poisson",
       "poisson_ratio = 0.3",
       "poisson_ratio = -0.1",
       {},
       {"upper.poisson_ratio = -0.1", "from 0 to 0.5"}},
      {"negative_friction",
       "friction = 0.1",
       "friction = -0.1",
       {},
       {"contact.friction = -0.1", "zero or positive"}},
      {"moment_ratio_1",
       "moment_ratio = 0.9",
       "moment_ratio = 1.0",
       {},
       {file + ":16", "load.moment_ratio = 1:", "from 0 to below 1", "gross slip"}},
      {"moment_ratio_nan",
       "moment_ratio = 0.9",
       "moment_ratio = nan",
       {},
       {"load.moment_ratio = nan", "from 0 to below 1"}},
      {"negative_moment",
       "moment_ratio = 0.9",
       "moment = -1.0",
       {},
       {"load.moment = -1:", "zero or positive"}},
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
      {"tangential_force",
       "force = [0.0, 0.0]",
       "force = [0.0, 1.0]",
       {},
       {"load.force = [0, 1]", "0 (tangential forces are not modelled)"}},
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
       {file + ":3", "upper.shape = \"cube\"", "sphere, ellipsoid, cone, flat_punch, height_map"}},
      {"unknown_pressure",
       "pressure = \"solved\"",
       "pressure = \"Hertz\"",
       {},
       {"contact.pressure = \"Hertz\"", "solved, hertz, hertz_averaged, file"}},
      {"unknown_coupling",
       "coupling = \"auto\"",
       "coupling = \"full\"",
       {},
       {"contact.coupling = \"full\"", "auto, none, pressure"}},
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
      {"no_threads", "threads = 2", "threads = 0", {}, {"solver.threads = 0", "a whole number from 1"}},
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
INSTANTIATE_TEST_SUITE_P(Scenes, Bad, testing::ValuesIn(bad_scenes()), [](const auto& tested) {
  std::string name = tested.param.name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
});

TEST_P(Bad, IsRefusedWithFileKeyValueAndWhatIsAllowed) {
  std::string text = kScene;
  if (!GetParam().replace.empty()) {
    const auto at = text.find(GetParam().replace);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, GetParam().replace.size(), GetParam().by);
  }
  try {
    read(text, GetParam().overrides);
    ADD_FAILURE() << "read without a complaint";
  } catch (const InputError& error) {
    for (const std::string& part : GetParam().says) EXPECT_THAT(error.what(), HasSubstr(part));
  }
}

TEST_F(SceneFile, OfTwoRigidBodiesIsRefused) {
  std::string text = kShortScene;
  const std::string elastic = "young_modulus = 210e9\npoisson_ratio = 0.3\n";
  for (int body = 0; body < 2; ++body) text.replace(text.find(elastic), elastic.size(), "rigid = true\n");
  try {
    read(text);
    ADD_FAILURE() << "read without a complaint";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(HasSubstr("scene.toml"), HasSubstr("lower.rigid = true"), HasSubstr("false")));
  }
}

/// What a call complains of.
template <typename Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no InputError)";
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

TEST_F(SceneFile, OfAnExtentSmallerThanTheContactIsRefused) {
  const Scene scene =
      read(kShortScene, {"grid.extent=[0.0009, 0.0011]"});  // the contact's diameter is 0.978 mm
  EXPECT_THAT(
      complaint([&] { make_model(scene); }),
      testing::AllOf(HasSubstr("grid.extent = [0.0009, 0.0011]"), HasSubstr("larger than the contact")));
}

// --- pressure files ---

class PressureFile : public SceneFile {
 protected:
  /// 4 x 4 cells of 0.25 mm; the file holds some rows of them.
  std::string complaint_about(const std::string& rows, const std::vector<std::string>& overrides = {}) const {
    write("p.csv", "x1,x2,pressure\n" + rows);
    return complaint([&] { pressure(overrides); });
  }
  NormalSolution pressure(std::vector<std::string> overrides = {}) const {
    overrides.insert(overrides.begin(), {"contact.pressure=file", "contact.pressure_file=p.csv",
                                         "grid.cells=[4, 4]", "grid.extent=[0.001, 0.001]"});
    std::string text = kShortScene;
    text.erase(text.find("normal = 1000\n"), 14);
    const Scene scene = read(text, overrides);
    return find_pressure(scene, make_model(scene));
  }
};

TEST_F(PressureFile, IsReadToItsCells) {
  write("p.csv", "pressure,x1,x2\n2e9,-0.000125,0.000375\n1e9,0.000125,0.000125\n");
  const Eigen::ArrayXd p = pressure().pressure;
  const double unit = 210e9 / 2.6 / 2.0;
  EXPECT_NEAR(p[1 * 4 + 3] * unit / 2e9, 1.0, kModelRounding);
  EXPECT_NEAR(p[2 * 4 + 2] * unit / 1e9, 1.0, kModelRounding);
  EXPECT_EQ((p > 0.0).count(), 2);
}

TEST_F(PressureFile, MustFitTheGridAndTheLoad) {
  EXPECT_THAT(complaint([&] { pressure(); }),
              testing::AllOf(HasSubstr("p.csv"), HasSubstr("cannot be read")));
  const std::string good = "0.000125,0.000125,1e9\n";
  EXPECT_EQ(complaint_about(good), "(no InputError)");
  EXPECT_EQ(complaint_about(good, {"load.normal=62.5"}), "(no InputError)");  // 1e9 Pa on (0.25 mm)^2
  EXPECT_THAT(complaint_about(good, {"load.normal=1000"}),
              testing::AllOf(HasSubstr("load.normal = 1000 N"), HasSubstr("62.5"), HasSubstr("p.csv")));
  EXPECT_THAT(complaint_about(good + "0.000125,-0.000125,nan\n"),
              testing::AllOf(HasSubstr("p.csv:3"), HasSubstr("nan")));
  EXPECT_THAT(
      complaint_about(good + "0.000125,-0.000125,-1\n"),
      testing::AllOf(HasSubstr("p.csv"), HasSubstr("row 2"), HasSubstr("-1"), HasSubstr("zero or positive")));
  EXPECT_THAT(complaint_about("0.0002,0.000125,1e9\n"),
              testing::AllOf(HasSubstr("p.csv"), HasSubstr("row 1"), HasSubstr("0.0002"),
                             HasSubstr("not a cell's centre")));
  EXPECT_THAT(complaint_about("0.000625,0.000125,1e9\n"), HasSubstr("not a cell's centre"));  // off the grid
  EXPECT_THAT(complaint_about("0.000125,0.000125,0\n"), HasSubstr("zero everywhere"));
  EXPECT_THAT(complaint_about("0.125,0.125,1e9\n"), HasSubstr("not a cell's centre"));  // mm for m
}

TEST_F(PressureFile, HoldsACellOnce) {
  const std::string row = "0.000125,0.000125,1e9\n";
  EXPECT_THAT(complaint_about(row + row), testing::AllOf(HasSubstr("p.csv"), HasSubstr("row 2")));
}

// --- height maps ---

class HeightMapFile : public SceneFile {
 protected:
  Model model(const std::string& heights, const std::vector<std::string>& overrides = {}) const {
    write("heights.csv", heights);
    std::string text = kShortScene;
    const std::string sphere = "shape = \"sphere\"\nradius = 0.018\n";
    text.replace(text.find(sphere), sphere.size(),
                 "shape = \"height_map\"\nfile = \"heights.csv\"\nspacing = [1e-5, 2e-5]\n");
    text.erase(text.find("[grid]"));
    return make_model(read(text, overrides));
  }
};

TEST_F(HeightMapFile, BringsItsGridAndItsGap) {
  const Model model = this->model("3e-6,2e-6,3e-6\n2e-6,1e-6,2e-6\n");
  EXPECT_EQ(model.grid.n1, 2);
  EXPECT_EQ(model.grid.n2, 3);
  EXPECT_DOUBLE_EQ(model.length_unit, 1e-5);
  EXPECT_DOUBLE_EQ(model.grid.h2, 2.0);
  EXPECT_EQ(model.gap.minCoeff(), 0.0);
  EXPECT_NEAR(model.gap[0], 0.2, 1e-12);
  EXPECT_EQ(model.gap[1 * 3 + 1], 0.0);
  EXPECT_NEAR(model.gap[1], 0.1, 1e-12);
}

TEST_F(HeightMapFile, MustBeARectangleOfNumbers) {
  EXPECT_THAT(complaint([&] { model("1,2\n3\n"); }),
              testing::AllOf(HasSubstr("heights.csv:2"), HasSubstr("1 values; allowed: 2")));
  EXPECT_THAT(complaint([&] { model("1,2\n3,high\n"); }),
              testing::AllOf(HasSubstr("heights.csv:2"), HasSubstr("high"), HasSubstr("a finite number")));
  EXPECT_THAT(complaint([&] { model("1,2\n3,inf\n"); }), HasSubstr("a finite number"));
  EXPECT_THAT(complaint([&] { model(""); }), HasSubstr("holds no rows"));
  EXPECT_THAT(
      complaint([&] { model("1,2\n3,4\n", {"grid.cells=[3, 2]"}); }),
      testing::AllOf(HasSubstr("grid.cells = [3, 2]"), HasSubstr("[2, 2]"), HasSubstr("heights.csv")));
  EXPECT_THAT(complaint([&] { model("1,2\n3,4\n", {"grid.extent=[1, 1]"}); }),
              testing::AllOf(HasSubstr("grid.extent"), HasSubstr("upper.spacing")));
  EXPECT_EQ(complaint([&] { model("1,2\n3,4\n", {"grid.cells=[2, 2]"}); }), "(no InputError)");
}

// --- the model of a scene ---

TEST(Model, IsDimensionless) {
  const Model model = make_model(paper_scene(40, 0.5));
  EXPECT_EQ(model.grid.h1, 1.0);
  EXPECT_EQ(model.pair.shear_compliance, 1.0);
  EXPECT_DOUBLE_EQ(model.stress_unit, 210e9 / 2.6 / 2.0);
  ASSERT_TRUE(model.hertz);
  EXPECT_NEAR(model.hertz->semi_axis_1 * model.length_unit / paper::kContactRadius, 1.0, kModelRounding);
  EXPECT_NEAR(model.hertz->peak_pressure * model.stress_unit / paper::kPeakPressure, 1.0, kModelRounding);
  // The contact and a margin of two cells fill the grid.
  EXPECT_NEAR(40.0 * model.length_unit, 2.0 * paper::kContactRadius + 4.0 * model.length_unit, 1e-15);
}

TEST(Model, SaysWhatItLeavesOut) {
  Scene scene = paper_scene(16, 0.5);
  const auto mentions_coupling = [](const Model& model) {
    for (const Omission& omission : model.left_out) {
      if (omission.what == "K13, K23") return !omission.why.empty();
    }
    return false;
  };
  EXPECT_TRUE(mentions_coupling(make_model(scene)));
  scene.lower.young_modulus = 70e9;
  EXPECT_TRUE(make_model(scene).pressure_coupling);
  EXPECT_FALSE(mentions_coupling(make_model(scene)));
  scene.coupling = Coupling::none;
  EXPECT_FALSE(make_model(scene).pressure_coupling);
  EXPECT_TRUE(mentions_coupling(make_model(scene)));
}

}  // namespace
}  // namespace slipstick::solver
