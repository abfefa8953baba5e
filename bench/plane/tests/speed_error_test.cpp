// The plane's points on small grids.

#include "bench/plane/speed_error.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/timing/checked_solve.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/solve_scene.hpp"

namespace {

using namespace slipstick;
using bench::Json;
using testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kPaper = fs::path(SLIPSTICK_SCENES) / "paper.toml";

/// A point as the design has them.
Json run_on(int cells, double tolerance = 1e-8) {
  return {{"choice", {{"cells", cells}}},
          {"grids", 4},
          {"overrides",
           {fmt::format("grid.cells=[{0},{0}]", cells), fmt::format("solver.tolerance={}", tolerance),
            "solver.threads=1", "load.moment_ratio=0.9"}},
          {"file", fmt::format("point-{}-{}", cells, tolerance)},
          {"label", ""}};
}

/// The error of a point is the root mean square of the errors of single solves.
TEST(PlanePoint, HasTheErrorsOfItsGrids) {
  const Json point = bench::measure_point(kPaper, run_on(24));
  ASSERT_EQ(point["errors"]["twist"].size(), 4U);
  const Json alone = to_json(convergence::solve_scene(solver::read_scene(kPaper, run_on(24)["overrides"])).record);
  EXPECT_DOUBLE_EQ(point["errors"]["twist"][0], alone["twist_error"]);
  EXPECT_DOUBLE_EQ(point["errors"]["traction_l2"][0], alone["traction_error"]["l2"]);
  double sum = 0.0;
  for (const Json& error : point["errors"]["twist"]) sum += error.get<double>() * error.get<double>();
  EXPECT_NEAR(point["error"]["twist"].get<double>(), std::sqrt(sum / 4.0), 1e-15);
  EXPECT_EQ(point["seconds"].size(), 9U);  // as quick work is repeated
  for (const Json& seconds : point["seconds"]) EXPECT_GT(seconds.get<double>(), 0.0);
  // 20 to 18 of 24 cells: the margin is two cells on each side, and grids grow by up to 1.5 cells.
  EXPECT_GT(point["contact_cells"].get<double>(), 18.0);
  EXPECT_LT(point["contact_cells"].get<double>(), 20.2);
}

TEST(PlanePoint, IsNotTimedWhereItDoesNotConverge) {
  const convergence::TemporaryFolder folder;
  const fs::path scene = folder / "slow.toml";
  std::ofstream(scene) << convergence::read_text(kPaper) << "max_iterations = 1\n";
  const Json point = bench::measure_point(scene, run_on(24));
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
  const auto load = [](const Json& runs) { return Json{{"name", "paper"}, {"moment_ratio", 0.9}, {"runs", runs}}; };
  convergence::Progress progress;
  progress.begin_runs(3, 3.0, 3);
  const Json first = bench::measure_load(options, load(Json::array({run_on(16)})), progress);
  const Json both = bench::measure_load(options, load(Json::array({run_on(16), run_on(16, 1e-4)})), progress);
  ASSERT_EQ(both["points"].size(), 2U);
  EXPECT_EQ(both["points"][0], first["points"][0]);  // seconds and all: it was not measured again
  EXPECT_LE(both["exact"]["error"].get<double>(), 1e-13);
}

}  // namespace
