#include "convergence/studies/study_run.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cfenv>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <set>

#include "convergence/oracle/errors.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/orders/expected_order.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/studies/study_judgement.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/tests/complaint.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

using testing::HasSubstr;

const std::string kPaper = std::string(SLIPSTICK_SCENES) + "/paper.toml";
const std::string kEllipse = std::string(SLIPSTICK_SCENES) + "/ellipse.toml";

std::string cells(int n) { return "grid.cells=[" + std::to_string(n) + "," + std::to_string(n) + "]"; }

class StudyTest : public ScratchFolder {
 protected:
  Study study(const std::string& text, const std::string& scene = kPaper) {
    return read_study(write("study.toml", "scene = \"" + scene + "\"\n" + text));
  }
  StudyResult result(const std::string& text, const std::string& scene = kPaper) {
    return run_study(study(text, scene), pool_);
  }
  Json run(const std::string& text, const std::string& scene = kPaper) {
    return to_json(result(text, scene));
  }

  ProcessPool pool_{{.folder = folder_ / "points", .program = SLIPSTICK_PROGRAM}};
};

/// Directed rounding changes a result by less than 1e-10.
TEST_F(StudyTest, DirectedRoundingIsSeenAndIsSmall) {
  const BudgetRuns points = budget_runs({kPaper, {cells(32)}}, 1e-8);
  const std::vector<Json> results =
      to_json(pool_.run({points.observed, points.tightened, points.rounded[0], points.rounded[1]}));
  for (const Json& result : results) ASSERT_EQ(result["status"], "converged") << result.dump();
  const Budget budget = split_error("twist_error", results[0], results[1], {results[2], results[3]});
  EXPECT_GT(budget.rounding, 0.0);
  EXPECT_LT(budget.rounding, 1e-10);
  EXPECT_EQ(std::fegetround(), FE_TONEAREST);
  EXPECT_DOUBLE_EQ(budget.observed, results[0]["twist_error"].get<double>());
  EXPECT_DOUBLE_EQ(budget.discretisation + budget.iteration, budget.observed);
  EXPECT_EQ(largest_part(budget), "discretisation");
}

/// Rounded downward this pressure's mirrors hold to rounding and half a turn, which is both of them, nearly
/// to twice as much: one test decides for the quadrant and for the limit load.
TEST_F(StudyTest, APressureThatIsMirroredToRoundingIsSolved) {
  const BudgetRuns points =
      budget_runs({kPaper, {cells(96), "contact.pressure=\"hertz\"", "load.moment_ratio=0.5"}}, 1e-8);
  const std::vector<SolveRecord> results =
      pool_.run({points.tightened, points.rounded[0], points.rounded[1]});
  for (const SolveRecord& result : results) EXPECT_TRUE(result.is_converged()) << result.message;
}

/// A parent that ignores SIGCHLD gets its results.
TEST_F(StudyTest, ResultsAreFoundWhereSigchldIsIgnored) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_TRUE(pool_.run(RunSpec{kPaper, {cells(16)}}).is_converged());
  std::signal(SIGCHLD, before);
}

/// Solves do not reap other children of this process.
TEST_F(StudyTest, OtherChildrenAreNotReaped) {
  const pid_t other = fork();
  if (other == 0) _exit(3);
  EXPECT_TRUE(pool_.run(RunSpec{kPaper, {cells(16)}}).is_converged());
  int status = 0;
  EXPECT_EQ(waitpid(other, &status, 0), other);
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

TEST_F(StudyTest, ALooseToleranceShowsInTheBudget) {
  const Budget budget =
      error_budget(prepare_run({kPaper, {cells(32), "solver.tolerance=0.1"}}), "twist_error", pool_);
  EXPECT_EQ(largest_part(budget), "iteration");
  EXPECT_TRUE(std::isnan(
      error_budget(prepare_run({kEllipse, {"grid.cells=[32,16]"}}), "twist_error", pool_).observed));
}

TEST_F(StudyTest, EveryGridOfAMeshLiesDifferently) {
  const Json rows = run("cells = [12, 16, 24, 32, 48]\nshifts = 3\n")["series"]["paper"]["rows"];
  std::set<double> sizes;
  for (const Json& row : rows) sizes.insert(row["h"].get<double>());
  EXPECT_EQ(rows.size(), 15U);
  EXPECT_EQ(sizes.size(), 15U);
}

/// The contact radius follows from the pressure's second moments: second order (see expected_order.cpp).
TEST_F(StudyTest, FindsSecondOrderOfTheContactRadius) {
  const Json result =
      run("cells = [12, 16, 24, 32, 48, 64]\nshifts = 3\nquantities = [\"contact_radius_error\"]\n");
  const FoundQuantity order = find_quantity(result, "series.paper.order.contact_radius_error.value");
  ASSERT_NE(order.value, nullptr);
  EXPECT_NEAR(order.value->get<double>(), 2.0, 0.3);
  EXPECT_LE(find_quantity(result, "series.paper.order.contact_radius_error.low").value->get<double>(), 2.0);
}

TEST_F(StudyTest, TightensTheToleranceWhereStoppingShows) {
  const StudyResult loose = result("cells = [12, 16, 24]\n[set]\nsolver.tolerance = 1e-2\n");
  const Json series = to_json(loose)["series"]["paper"];
  EXPECT_GT(series["tightened"].get<int>(), 0);
  EXPECT_LT(series["tolerance"].get<double>(), 1e-2);
  EXPECT_THAT(study_text(loose), HasSubstr("tightened"));
  for (const Json& line : series["budget"]) {
    if (line["quantity"] != "twist_error") continue;
    EXPECT_LE(std::abs(line["iteration"].get<double>()),
              0.1 * std::abs(line["discretisation"].get<double>()));
  }
  EXPECT_EQ(run("cells = [12, 16, 24]\n")["series"]["paper"]["tightened"], 0);
}

TEST_F(StudyTest, WithoutAnExactAnswerTheLimitIsExtrapolated) {
  const Json result = run("cells = [16, 24, 32, 48, 64]\nquantities = [\"moment_limit\"]\n", kEllipse);
  const Json& series = result["series"]["ellipse"];
  EXPECT_EQ(series["basis"], "extrapolated");
  EXPECT_EQ(series["order"]["moment_limit"]["basis"], "extrapolated");
  const double exact = find_oracle(solver::read_scene(kEllipse)).oracle->friction.moment_limit;
  const Json& limit = series["extrapolated"]["moment_limit"];
  EXPECT_LE(std::abs(limit["value"].get<double>() - exact), limit["uncertainty"].get<double>());
  EXPECT_LE(limit["uncertainty"].get<double>(), 1e-2 * exact);
}

/// A square plate's capacitance over 4 pi eps0 is 0.366788: by Galerkin's method on rectangles graded towards
/// the edges, which is a lower bound, 0.3667869 from 96 x 96 of them, and 0.36678802 as they shrink.
TEST_F(StudyTest, EdgesBetweenCellsAreExtrapolatedWithTheirPowers) {
  const std::string footing = std::string(SLIPSTICK_SCENES) + "/../literature/scenes/footing.toml";
  const Json series =
      run("cells = [16, 24, 32, 48, 64, 96]\nquantities = [\"approach\"]\n", footing)["series"]["footing"];
  const Json& approach = series["extrapolated"]["approach"];
  const double capacitance = 0.05305164769729845 / approach["value"].get<double>();  // (1 - nu)/(4 pi)
  const double part = approach["uncertainty"].get<double>() / approach["value"].get<double>();
  EXPECT_NEAR(capacitance / 0.366788, 1.0, part + 1e-7);
  EXPECT_LE(part, 3e-6);
  EXPECT_THAT(approach["method"], HasSubstr("h^1.59"));
}

/// The exact answer of an ellipse covers its normal contact only.
TEST_F(StudyTest, ValuesWithoutAnExactAnswerAreExtrapolated) {
  const Json found = run("cells = [16, 24, 32]\n", kEllipse);
  const Json& series = found["series"]["ellipse"];
  EXPECT_EQ(series["basis"], "exact");
  for (const char* path : {"moment_error", "moment_limit_error", "contact_radius_error",
                           "peak_pressure_error", "pressure_error.l1", "pressure_error.l2"}) {
    ASSERT_TRUE(series["order"].contains(path)) << path;
    EXPECT_EQ(series["order"][path]["basis"], "exact") << path;
    EXPECT_FALSE(series["extrapolated"].contains(path)) << path;
  }
  for (const char* path : {"twist_angle", "stick_radius", "dissipated"}) {
    ASSERT_TRUE(series["order"].contains(path)) << path;
    EXPECT_EQ(series["order"][path]["basis"], "extrapolated") << path;
    EXPECT_TRUE(series["extrapolated"][path]["value"].is_number()) << path;
  }
  for (const char* path : {"twist_error", "traction_error.l1", "moment_limit", "contact_radius"}) {
    EXPECT_FALSE(series["order"].contains(path)) << path;
  }
}

TEST_F(StudyTest, EveryCombinationIsASeries) {
  const Json result =
      run("cells = [12, 16]\n[[vary]]\nkey = \"contact.pressure\"\nvalues = [\"solved\", \"hertz\"]\n"
          "[[vary]]\nkey = \"load.moment_ratio\"\nvalues = [0.5, 0.9]\n");
  for (const char* name : {"solved-0.5", "solved-0.9", "hertz-0.5", "hertz-0.9"}) {
    ASSERT_TRUE(result["series"].contains(name)) << name;
    EXPECT_EQ(result["series"][name]["rows"].size(), 2U);
    EXPECT_EQ(result["series"][name]["order"]["twist_error"]["verdict"], "too_few");
  }
  EXPECT_EQ(result["series"]["hertz-0.5"]["set"]["contact.pressure"], "hertz");
  EXPECT_EQ(result["series"]["hertz-0.5"]["set"]["load.moment_ratio"], 0.5);
}

/// The reached tolerance is not larger than the requested one, and the error by stopping falls with it.
TEST_F(StudyTest, AchievedToleranceFollowsTheRequested) {
  const Json result = run("cells = [24]\ntolerances = [1e-6, 1e-1, 1e-3]\n");
  const Json& rows = result["series"]["paper"]["tolerances"];
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0]["requested"], 1e-1);
  for (const Json& row : rows)
    EXPECT_LE(row["certificate.gap"].get<double>(), row["requested"].get<double>());
  EXPECT_GT(std::abs(rows[0]["iteration"]["twist_error"].get<double>()),
            std::abs(rows[2]["iteration"]["twist_error"].get<double>()));
}

/// Without an exact answer a row has the value under its own name, and its distance from the tightest run.
TEST_F(StudyTest, AValueIsNotShownAsAnError) {
  const StudyResult found = result("cells = [16]\ntolerances = [1e-1, 1e-6]\n", kEllipse);
  const Json row = to_json(found)["series"].begin().value()["tolerances"][0];
  EXPECT_GT(row["twist_angle"].get<double>(), 1e-4);  // rad
  const double off = std::abs(row["iteration"]["twist_angle"].get<double>());
  EXPECT_GT(off, 1e-7);  // in rad it would be a thousand times smaller
  EXPECT_LT(off, 0.1);
  EXPECT_THAT(study_text(found), testing::Not(HasSubstr("twist error")));
}

TEST_F(StudyTest, BadStudiesSayWhatIsAllowed) {
  const auto message = [&](const std::string& text) { return solver::complaint([&] { study(text); }); };
  EXPECT_THAT(message(""), HasSubstr("[[vary]]"));
  std::string billions;
  for (int i = 0; i < 9; ++i) {
    billions += "[[vary]]\nkey = \"k" + std::to_string(i) + "\"\nvalues = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n";
  }
  EXPECT_THAT(message(billions), testing::AllOf(HasSubstr("1e+09"), HasSubstr("10000")));
  EXPECT_THAT(message("cell = [16, 32]"), HasSubstr("cells"));
  EXPECT_THAT(message("cells = [16, 16]"), HasSubstr("twice"));
  EXPECT_THAT(message("cells = [16, 0]"), HasSubstr("whole number"));
  EXPECT_THAT(message("cells = 16"), HasSubstr("list"));
  EXPECT_THAT(message("cells = [16, 32]\nshifts = 0"), HasSubstr("shifts = 0"));
  EXPECT_THAT(message("tolerances = [1e-3, -1.0]"), HasSubstr("positive"));
  EXPECT_THAT(message("[[vary]]\nkey = \"grid.cells\"\nvalues = [1]"), HasSubstr("vary[0].key"));
  EXPECT_THROW(run("cells = [12, 16]\nquantities = [\"twist_eror\"]\n"), solver::InputError);
}

/// One series in which no solve may run does not spoil the others.
TEST_F(StudyTest, ASeriesThatCannotBeSolvedIsJudgedTooFew) {
  const Json result =
      run("cells = [12, 16, 24]\nquantities = [\"twist_error\"]\n[set]\nload.moment_ratio = 0.5\n"
          "[[vary]]\nkey = \"solver.max_iterations\"\nvalues = [1, 5000]\n");
  EXPECT_EQ(result["series"]["1"]["order"]["twist_error"]["verdict"], "too_few");
  EXPECT_NE(result["series"]["5000"]["order"]["twist_error"]["verdict"], "too_few");
}

/// Some contacts have an exact ratio only, and a height map fixes the grid.
TEST_F(StudyTest, TakesTheQuantitiesOfTheScene) {
  const Json spence = run("cells = [12, 16]\n", std::string(SLIPSTICK_SCENES) + "/spence.toml");
  EXPECT_TRUE(spence["series"]["spence"]["order"].contains("stick_ratio_error"));
  EXPECT_FALSE(run("cells = [12, 16]\n")["series"]["paper"]["order"].contains("stick_ratio_error"));
  const std::string honed = std::string(SLIPSTICK_SCENES) + "/honed_surface.toml";
  EXPECT_THROW(run("cells = [12, 16]\n", honed), solver::InputError);
  EXPECT_EQ(run("tolerances = [1e-2, 1e-4]\n", honed)["series"]["honed_surface"]["tolerances"].size(), 2U);
}

/// A field that is exact at the centres differs from cell averages only where the traction has an edge, and
/// there less and less: by h^(1/2) in bands of width h.
TEST(TractionError, AverageAndCentreDifferAtTheEdgesOnly) {
  const auto error_at = [](int n) {
    const solver::Scene scene = solver::read_scene(kPaper, {cells(n)});
    const solver::Grid grid = solver::make_model(scene).grid_in_m();
    const Oracle oracle = *find_oracle(scene).oracle;
    return traction_error(exact_fields(oracle, grid).traction, oracle, grid);
  };
  const TractionError coarse = error_at(32);
  const TractionError fine = error_at(128);
  for (const TractionError& error : {coarse, fine}) {
    EXPECT_EQ(error.at_centres.max, 0.0);
    EXPECT_EQ(error.inside.max, 0.0);
    EXPECT_EQ(error.outside.max, 0.0);
    EXPECT_GT(error.stick_edge.l1, 0.0);
    EXPECT_GT(error.contact_edge.l1, 0.0);
  }
  EXPECT_NEAR(std::log(coarse.averaged.l1 / fine.averaged.l1) / std::log(4.0), 1.5, 0.25);
  EXPECT_NEAR(std::log(coarse.averaged.l2 / fine.averaged.l2) / std::log(4.0), 1.0, 0.25);
}

TEST(TractionError, RegionsAddUpToTheWhole) {
  const solver::Scene scene = solver::read_scene(kPaper, {cells(48)});
  const solver::Grid grid = solver::make_model(scene).grid_in_m();
  const Oracle oracle = *find_oracle(scene).oracle;
  const Eigen::ArrayXd exact = exact_fields(oracle, grid).traction;
  const TractionError error = traction_error(1.01 * exact, oracle, grid);
  EXPECT_NEAR(error.at_centres.l1, 0.01, 1e-12);
  EXPECT_NEAR(error.at_centres.l2, 0.01, 1e-12);
  EXPECT_NEAR(error.at_centres.max, 0.01, 1e-12);
  const FieldError parts[] = {error.stick_edge, error.contact_edge, error.inside, error.outside};
  double l1 = 0.0;
  double squares = 0.0;
  double most = 0.0;
  for (const FieldError& part : parts) {
    l1 += part.l1;
    squares += part.l2 * part.l2;
    most = std::max(most, part.max);
  }
  EXPECT_NEAR(l1, error.averaged.l1, 1e-12);
  EXPECT_NEAR(std::sqrt(squares), error.averaged.l2, 1e-12);
  EXPECT_EQ(most, error.averaged.max);
}

TEST(ExpectedOrder, EveryErrorHasOneWithAReasonWhereTheEdgeIsARoot) {
  const solver::Scene sphere = example("paper");
  const solver::Scene punch = example("flat_punch");
  const solver::Scene rough = example("rough_sphere");
  for (const auto& [quantity, label] : error_quantities()) {
    EXPECT_GT(expected_order(quantity, sphere).value, 0.0) << quantity;
    EXPECT_FALSE(expected_order(quantity, sphere).why.empty());
    EXPECT_TRUE(std::isnan(expected_order(quantity, rough).value));
    const double singular = expected_order(quantity, punch).value;
    EXPECT_FALSE(singular > expected_order(quantity, sphere).value) << quantity;
  }
}

}  // namespace
}  // namespace slipstick::convergence
