// The plane's design, its points on small grids, its judgement of made points.

#include "bench/plane/speed_error.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "bench/timing/checked_solve.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/solve_scene.hpp"

namespace {

using namespace slipstick;
using bench::Json;
using bench::PlaneChoice;
using testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kPaper = fs::path(SLIPSTICK_SCENES) / "paper.toml";

TEST(PlaneDesign, HoldsNoChoiceTwiceAndOnlyReadableOnes) {
  for (const bool quick : {false, true}) {
    for (const double ratio : bench::plane_moment_ratios(quick)) {
      std::set<std::vector<std::string>> seen;
      for (const PlaneChoice& choice : bench::plane_design(ratio, quick)) {
        EXPECT_TRUE(seen.insert(bench::overrides(choice)).second) << choice.method << choice.cells;
        EXPECT_NO_THROW(solver::read_scene(kPaper, bench::overrides(choice)));
      }
      EXPECT_GT(seen.size(), 20U);
    }
  }
}

TEST(PlaneDesign, TriesEachChoiceSomewhere) {
  std::set<std::string> words;
  for (const PlaneChoice& choice : bench::plane_design(0.9, false)) {
    words.insert({choice.method, choice.op, choice.model, choice.pressure});
  }
  for (const char* word : {"coulomb", "paper", "projected_gradient", "dcfft", "direct", "dense", "auto",
                           "full", "solved", "hertz", "hertz_averaged"}) {
    EXPECT_TRUE(words.contains(word)) << word;
  }
}

/// The error of a point is the root mean square of the errors of single solves.
TEST(PlanePoint, HasTheErrorsOfItsGrids) {
  const PlaneChoice choice{.cells = 24};
  const Json point = bench::measure_point(kPaper, 0.9, choice);
  ASSERT_EQ(point["errors"]["twist"].size(), 4U);
  std::vector<std::string> overrides = bench::overrides(choice);
  overrides.push_back("load.moment_ratio=0.9");
  const Json alone = to_json(convergence::solve_scene(solver::read_scene(kPaper, overrides)).record);
  EXPECT_DOUBLE_EQ(point["errors"]["twist"][0], alone["twist_error"]);
  EXPECT_DOUBLE_EQ(point["errors"]["traction_l2"][0], alone["traction_error"]["l2"]);
  double sum = 0.0;
  for (const Json& error : point["errors"]["twist"]) sum += error.get<double>() * error.get<double>();
  EXPECT_NEAR(point["error"]["twist"].get<double>(), std::sqrt(sum / 4.0), 1e-15);
  EXPECT_GT(point["seconds"]["median"].get<double>(), 0.0);
  EXPECT_LE(point["seconds"]["low"], point["seconds"]["median"]);
  EXPECT_EQ(point["seconds"]["repetitions"], 9);  // as quick work is repeated
  // 20 to 18 of 24 cells: the margin is two cells on each side, and grids grow by up to 1.5 cells.
  EXPECT_GT(point["contact_cells"].get<double>(), 18.0);
  EXPECT_LT(point["contact_cells"].get<double>(), 20.2);
}

TEST(PlanePoint, IsNotTimedWhereItDoesNotConverge) {
  const convergence::TemporaryFolder folder;
  const fs::path scene = folder / "slow.toml";
  std::ofstream(scene) << convergence::read_text(kPaper) << "max_iterations = 1\n";
  const PlaneChoice choice{.cells = 24};
  const Json point = bench::measure_point(scene, 0.9, choice);
  EXPECT_TRUE(point["seconds"].is_null());
  EXPECT_FALSE(point["not_timed"].get<std::string>().empty());
}

TEST(InvalidReason, IsGivenForErrorsThatMeshAndToleranceDoNotExplain) {
  solver::Scene scene = solver::read_scene(kPaper, {"grid.cells=[48,48]"});
  const solver::Solution solution = solver::solve(scene);
  const convergence::Errors right = convergence::compare(solution, *convergence::find_oracle(scene).oracle);
  EXPECT_EQ(bench::invalid_reason(scene, solution, right), "");
  for (const double twist : {-0.06, std::nan("")}) {
    convergence::Errors errors = right;
    errors.twist = twist;
    EXPECT_THAT(bench::invalid_reason(scene, solution, errors), HasSubstr("twist error")) << twist;
  }
  for (const double traction : {0.2, std::nan("")}) {  // the mesh alone accounts for less than a fifth
    convergence::Errors errors = right;
    errors.traction.at_centres.l2 = traction;
    EXPECT_THAT(bench::invalid_reason(scene, solution, errors), HasSubstr("traction error")) << traction;
    scene.solver.tolerance = 0.04;  // leaves 0.2 open
    EXPECT_EQ(bench::invalid_reason(scene, solution, errors).empty(), traction == 0.2);
    scene.solver.tolerance = 1e-8;
  }
}

TEST(PlaneScene, GoesOnFromKeptPoints) {
  const convergence::TemporaryFolder folder;
  const bench::PlaneOptions options{.scene = kPaper, .output = folder / "kept"};
  const PlaneChoice choice{.cells = 16};
  convergence::Progress progress(3, 3.0);
  const Json first = bench::measure_scene(options, 0.5, {choice}, progress);
  PlaneChoice next = choice;
  next.tolerance = 1e-4;
  const Json both = bench::measure_scene(options, 0.5, {choice, next}, progress);
  ASSERT_EQ(both["points"].size(), 2U);
  EXPECT_EQ(both["points"][0], first["points"][0]);  // seconds and all: it was not measured again
  EXPECT_LE(both["exact"]["error"].get<double>(), 1e-13);
}

/// A made point whose times have an interval.
Json made_point(const std::string& method, double cells, double error, double low, double median,
                double high) {
  Json point{{"method", method},     {"operator", "dcfft"}, {"model", "auto"},
             {"pressure", "solved"}, {"cells", cells},      {"tolerance", 1e-8}};
  point["seconds"] = {{"median", median}, {"low", low}, {"high", high}, {"repetitions", 5}};
  point["error"] = {{"twist", error}};
  return point;
}

Json judged_plane(const std::vector<Json>& points) {
  Json plane;
  plane["quantities"] = {{{"name", "twist"}, {"label", "twist"}}};
  plane["scenes"].push_back({{"name", "made"}, {"points", points}});
  plane["scenes"][0]["exact"]["seconds"] = {{"low", 0.3}, {"median", 0.4}, {"high", 0.7}};
  bench::judge_plane(plane);
  return plane;
}

TEST(PlaneJudgement, FindsEnvelopeTimesAndWhatIsNotTimed) {
  Json wrong = made_point("paper", 256, 1e-6, 0.001, 0.001, 0.001);
  wrong["seconds"] = nullptr;
  wrong["not_timed"] = "twist error 0.06 above 0.001";
  const Json plane = judged_plane({made_point("coulomb", 64, 2e-3, 1.0, 1.0, 1.0),
                                   made_point("coulomb", 128, 5e-4, 4.0, 4.0, 4.0),
                                   made_point("paper", 128, 5e-4, 8.0, 8.0, 8.0), wrong});
  EXPECT_EQ(plane["scenes"][0]["envelope"]["twist"], Json({0, 1}));
  const auto time_to = [&](double error, const std::string& method) {
    for (const Json& row : plane["scenes"][0]["time_to"]) {
      if (row["error"] == error && row["method"] == method) return row;
    }
    return Json();
  };
  EXPECT_EQ(time_to(1e-2, "coulomb")["seconds"], 1.0);
  EXPECT_EQ(time_to(1e-2, "paper")["point"], 2);
  EXPECT_EQ(time_to(1e-3, "any")["point"], 1);
  EXPECT_TRUE(time_to(1e-4, "any")["seconds"].is_null());
  EXPECT_THAT(time_to(1e-4, "any")["reason"].get<std::string>(), HasSubstr("0.0005"));
  ASSERT_EQ(plane["not_timed"].size(), 1U);
  EXPECT_EQ(plane["not_timed"][0]["choice"]["cells"], 256.0);
  EXPECT_THAT(bench::times_text(plane), HasSubstr("1e-03      4 s  1e-04        -"));
}

// The choice with the least median differs from the choices with the least lower and upper ends.
TEST(PlaneJudgement, GoesByMedians) {
  const Json plane = judged_plane({made_point("coulomb", 64, 1e-3, 0.5, 2.0, 2.1),
                                   made_point("paper", 64, 1e-3, 1.0, 1.5, 4.0),
                                   made_point("projected_gradient", 64, 1e-3, 0.4, 1.8, 1.9)});
  const Json& scene = plane["scenes"][0];
  EXPECT_EQ(scene["envelope"]["twist"], Json({1}));
  for (const Json& row : scene["time_to"]) {
    if (row["error"] != 1e-2) continue;
    const std::map<std::string, double> medians{
        {"any", 1.5}, {"coulomb", 2.0}, {"paper", 1.5}, {"projected_gradient", 1.8}, {"exact", 0.4}};
    EXPECT_EQ(row["seconds"], medians.at(row["method"])) << row;
  }
  EXPECT_EQ(scene["time_to"].size(), 4U * 5U);
}

}  // namespace
