// Pages of scenes: their parts, their errors and their verdicts.

#include "convergence/report/scene_page.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "convergence/oracle/oracle.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/tests/complaint.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using namespace testing;

TEST(WantedError, IsAQuantityAndANumber) {
  EXPECT_EQ(read_wanted_error("twist=1e-3").quantity, "twist_angle");
  EXPECT_EQ(read_wanted_error("stick_radius=0.02").quantity, "stick_radius");
  EXPECT_EQ(read_wanted_error("stick_radius=0.02").error, 0.02);
}

/// A few cells: everything is there, nothing is accurate.
PageSize tiny() {
  PageSize size = page_size(Effort::quick);
  size.most_cells = size.most_study_cells = 32;
  size.method_cells = 16;
  size.operator_cells = {8, 12};
  size.repetitions = 1;
  return size;
}

/// Numbers that depend on the tangential load.
const std::set<std::string> kJudged{"twist_angle", "displacement", "stick_radius"};

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(SLIPSTICK_SCENES)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

class ScenePage : public ScratchFolder, public testing::WithParamInterface<std::string> {
 protected:
  Json page(const fs::path& scene, const std::vector<WantedError>& wanted = {},
            const std::vector<std::string>& uncertain = {}) const {
    const ProcessPool pool({.folder = folder_ / "points", .program = SLIPSTICK_PROGRAM});
    return to_json(scene_page({{.scene = scene}, tiny(), wanted, uncertain}, folder_, pool));
  }
  static fs::path file(const std::string& name) { return fs::path(SLIPSTICK_SCENES) / (name + ".toml"); }
};
/// A scene for each of the forms that a page has; all of them each night.
std::vector<std::string> paged_scenes() {
  if (std::getenv("SLIPSTICK_TEST_ALL") != nullptr) return scene_names();
  return {"capped_friction", "coated_sphere", "flat_punch",    "honed_surface",
          "patches",         "spence_sphere", "turned_ellipse"};
}
INSTANTIATE_TEST_SUITE_P(Scenes, ScenePage, testing::ValuesIn(paged_scenes()), [](const auto& info) {
  std::string name = info.param;
  std::erase_if(name, [](char c) { return c == '-' || c == '.'; });
  return name;
});

/// Bound of the relative error on few cells, with cell size h and contact radius a: (h/a)^2 for numbers of
/// the whole contact; h/a for a pressure that is singular at the edge, which cells place to h; h over the
/// stick radius for the stick radius; plus the relative growth of the radius in one load step. The whole
/// width of a slip ring may be missing if it is narrower than a cell.
double mesh_bound(const std::string& scene, const std::string& key, const Json& answer) {
  const double radius = std::sqrt(answer["contact_cells"].get<double>() / std::numbers::pi);  // in cells
  const Json& exact = answer["exact"];
  const double stick_ratio = exact.contains("stick_ratio") ? exact["stick_ratio"].get<double>() : 0.0;
  const double growth = scene == "spence_sphere" ? std::cbrt(1.5) - 1.0 : 0.0;
  if (key == "stick_radius") return 1.0 / (radius * stick_ratio) + growth;
  if ((1.0 - stick_ratio) * radius < 1.0) return 1.0 - stick_ratio;
  return scene == "flat_punch" ? 1.0 / radius : 1.0 / (radius * radius);
}

TEST_P(ScenePage, HasThePartsOfItsScene) {
  const solver::Scene scene = solver::read_scene(file(GetParam()));
  const bool exact = find_oracle(scene).oracle.has_value();
  const Json page = this->page(file(GetParam()));
  EXPECT_EQ(page["scene"]["name"], scene.name);
  EXPECT_TRUE(fs::exists(folder_ / "answer.h5"));
  EXPECT_FALSE(page["numbers"].empty());
  for (const Json& row : page["numbers"]) {
    EXPECT_GT(row["value"], 0.0) << row;
    if (!exact) {
      EXPECT_NE(row["basis"], "exact") << row;
    }
    const std::string key = row["key"];
    if (row["error"].is_number() && row["basis"] != "exact") {
      EXPECT_NEAR(row["error"].get<double>(), row["mesh"].get<double>() + row["path"].get<double>(), 1e-12) << row;
    }
    if (row["basis"] == "exact" && kJudged.contains(key)) {
      EXPECT_LE(std::abs(row["error"].get<double>()), mesh_bound(GetParam(), key, page["answer"])) << row;
    }
  }
  EXPECT_GT(page["digits"]["digits"]["contact_radius"]["digits"], 8.0) << "sums of a few hundred cells";
  EXPECT_EQ(page.contains("cost"), !has_given_grid(scene)) << "one mesh has no error to buy";
  EXPECT_EQ(page.contains("operators"), !has_given_grid(scene));
  EXPECT_EQ(page["studies"].size(), has_given_grid(scene) ? 1U : 2U);
  for (const Json& row : page["hard"]["rows"]) EXPECT_NE(row["verdict"], "not_converged") << row;
  EXPECT_EQ(page["headline"]["counts"]["checks"]["Certificate"], "holds");
}

/// Each error contains the stated error by the length of the steps; a number for which this is unknown has no
/// error. The error of a solve is at least the uncertainty of the reference.
TEST_F(ScenePage, CountsTheLengthOfSteps) {
  const Json made = page(file("dissimilar"), {{"twist_angle", 1e-2}});
  const double stated = made["answer"]["resolved"]["path"].get<double>() / made["answer"]["twist_angle"].get<double>();
  ASSERT_GT(stated, 0.01);
  for (const Json& row : made["numbers"]) {
    if (row["key"] == "twist_angle") {
      EXPECT_NEAR(row["path"].get<double>(), stated, 1e-9);
      EXPECT_GE(row["error"].get<double>(), stated);
    }
    if (row["key"] == "stick_radius" || row["key"] == "elastic_energy") {
      EXPECT_TRUE(row["error"].is_null()) << row;
    }
  }
  EXPECT_EQ(made["headline"]["counts"]["checks"]["Error of the twist"], "fails");
  const double known = made["cost"]["reference_uncertainty"];
  EXPECT_GE(known, stated);
  for (const Json& point : made["cost"]["points"]) {
    if (point["error"].is_number()) {
      EXPECT_GE(point["error"], known);
    }
  }
}

/// The page of a long history takes coarser meshes, and says so.
TEST_F(ScenePage, NamesTheMeshesThatALongHistoryOmits) {
  PageSize size = tiny();
  size.long_history = 1;
  const ProcessPool pool({.folder = folder_ / "points", .program = SLIPSTICK_PROGRAM});
  const Json made = to_json(scene_page({{.scene = file("fretting_torsion")}, size}, folder_, pool));
  EXPECT_EQ(made["answer"]["cells"], Json({32, 32})) << "no page has fewer";
  EXPECT_EQ(made["scene"]["summary"].back()[0], "Left out");
}

/// All tractions and motions of a sphere in torsion are proportional to the friction; the limit is.
TEST_F(ScenePage, HasTheUncertaintyByInputs) {
  const Json outputs = page(file("paper"), {}, {"contact.friction=10%"})["uncertainty"]["outputs"];
  for (const char* key : {"twist_angle", "moment_limit"}) {
    EXPECT_NEAR(outputs[key]["relative"].get<double>(), 0.1, 1e-6) << key;
  }
}

/// The page has the error of solve, and a bound on either side of it decides the verdict.
TEST_F(ScenePage, JudgesByTheWantedError) {
  const Json plain = page(file("paper"));
  const double error = std::abs(plain["answer"]["twist_error"].get<double>());
  const auto verdict = [&](double wanted) {
    const Json judged = page(file("paper"), {{"twist_angle", wanted}});
    return judged["headline"]["counts"]["checks"]["Error of the twist"].get<std::string>();
  };
  EXPECT_EQ(verdict(1.01 * error), "holds");
  EXPECT_EQ(verdict(0.99 * error), "fails");
  const auto ask = [&] { page(file("paper"), {{"radius", 0.1}}); };
  EXPECT_THAT(solver::complaint(ask),
              AllOf(HasSubstr("--want"), HasSubstr("radius"), HasSubstr("twist_angle, moment")));
}

}  // namespace
}  // namespace slipstick::convergence
