// How --accuracy chooses, what it reaches, and that it says so: on made data, in solves, by the program.

#include "convergence/solve/accuracy.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "convergence/programs/tests/program_run.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/solve/accurate_solve.hpp"
#include "convergence/solve/reached.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model.hpp"

namespace {

using namespace slipstick;
using convergence::AccuracyChoice;
using convergence::AccuracyData;
using convergence::AccuracyOf;
using convergence::AccuracyTarget;
using convergence::ContactOnGrid;
using convergence::Json;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string kScenes = SLIPSTICK_SCENES;

ProgramRun solve(const std::string& scene, const std::string& arguments) {
  return run_program_with("solve " + kScenes + "/" + scene + ".toml " + arguments);
}

Json solved(const std::string& scene, const std::string& arguments, int exit_code = 0) {
  const ProgramRun out = solve(scene, arguments + " --json -");
  EXPECT_EQ(out.exit_code, exit_code) << out.output;
  Json result = Json::parse(out.output, nullptr, false);
  EXPECT_FALSE(result.is_discarded()) << out.output;
  return result;
}

solver::Scene scene(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return solver::read_scene(fs::path(kScenes) / (name + ".toml"), overrides);
}

/// Errors 1/cells^order.
AccuracyData made_data(double order) {
  AccuracyData data;
  for (const double cells : {10.0, 20.0, 40.0, 80.0}) {
    const double error = std::pow(cells, -order);
    data.meshes.push_back({.cells_across = cells,
                           .errors = {{{error, 0.1 * error}, {error, 0.1 * error}, {error, 0.1 * error}}},
                           .tolerances = {1e-2, 1e-4},
                           .applications = {5.0, 10.0},
                           .work = {cells * cells, 3.0 * cells * cells}});
  }
  return data;
}

TEST(AccuracyData, FollowAPowerBetweenAndBeyondTheMeshes) {
  for (const double order : {1.0, 2.0}) {
    const AccuracyData data = made_data(order);
    for (const double cells : {10.0, 15.0, 40.0, 79.0, 200.0}) {
      const double error = std::pow(cells, -order);
      EXPECT_NEAR(needed_for(data, AccuracyOf::twist, error).cells_across / cells, 1.0, 1e-12);
      EXPECT_NEAR(error_with(data, AccuracyOf::twist, cells) / error, 1.0, 1e-12);
      EXPECT_LE(needed_for(data, AccuracyOf::twist, error).tolerance, 0.1 * error * (1.0 + 1e-12));
    }
    EXPECT_NEAR(falling_order(data, AccuracyOf::traction), order, 1e-12);
    EXPECT_EQ(needed_for(data, AccuracyOf::twist, 0.9).cells_across, 10.0);
  }
}

TEST(AccuracyData, TellTheWorkBetweenMeshesAndTolerances) {
  const AccuracyData data = made_data(2.0);
  EXPECT_NEAR(work_of(data, 30.0, 1e-2), 900.0, 1e-9);
  EXPECT_NEAR(work_of(data, 160.0, 1e-4), 3.0 * 25600.0, 1e-6);
  EXPECT_NEAR(work_of(data, 20.0, 1e-3), 2.0 * 400.0, 1e-9);  // half-way in digits
  EXPECT_NEAR(work_of(data, 20.0, 0.5), 400.0, 1e-9);
}

TEST(AccuracyData, ComeBackFromTheirText) {
  const AccuracyData data = made_data(2.0);
  const AccuracyData back = convergence::parse_accuracy_data(accuracy_toml(data, "made"));
  ASSERT_EQ(back.meshes.size(), data.meshes.size());
  for (std::size_t i = 0; i < data.meshes.size(); ++i) {
    EXPECT_NEAR(back.meshes[i].cells_across, data.meshes[i].cells_across, 1e-9);
    EXPECT_EQ(back.meshes[i].tolerances, data.meshes[i].tolerances);
    for (std::size_t q = 0; q < convergence::kAccuracies; ++q) {
      EXPECT_NEAR(back.meshes[i].errors[q].error / data.meshes[i].errors[q].error, 1.0, 1e-2);
    }
  }
}

TEST(AccuracyData, AreRefusedWhereTheyCannotBePickedBy) {
  const auto refused = [](const std::string& text) {
    EXPECT_THROW(convergence::parse_accuracy_data(text), std::runtime_error) << text;
  };
  refused("");
  refused("version = 7");
  refused("version = 1");
  refused("version = ");
  AccuracyData rising = made_data(2.0);
  rising.meshes[2].errors[1].error = 1.0;
  refused(accuracy_toml(rising, ""));
  refused(accuracy_toml(made_data(0.0), ""));  // never better
  AccuracyData negative = made_data(2.0);
  negative.meshes[0].work[1] = -1.0;
  refused(accuracy_toml(negative, ""));
}

/// Those that come with the program, in every scene that may ask for them.
TEST(AccuracyChoice, TakesNoFewerCellsForASmallerError) {
  for (const char* name : {"paper", "ellipse", "unequal_patches", "off_centre"}) {
    const solver::Scene at = scene(name);
    const ContactOnGrid contact = convergence::contact_on_grid(at);
    for (const AccuracyOf of : {AccuracyOf::twist, AccuracyOf::traction, AccuracyOf::stick_radius}) {
      AccuracyChoice before;
      before.tolerance = 1.0;
      for (double error = 0.5; error > 0.006; error /= 1.3) {
        const AccuracyChoice choice = convergence::choose_grid(at, contact, {error, of}, false);
        EXPECT_GE(choice.cells, before.cells);
        EXPECT_LE(choice.tolerance, before.tolerance);
        EXPECT_GE(convergence::choose_grid(at, contact, {error, of}, true).cells, choice.cells);
        before = choice;
      }
    }
  }
}

/// The scene's own model on the chosen cells has as many across its contact as were asked for.
TEST(AccuracyChoice, CountsCellsAcrossTheContactNotTheGrid) {
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {}, {"grid.extent=[3e-3,3e-3]"}, {"grid.extent=[1.2e-3,2e-3]"}}) {
    const solver::Scene at = scene("paper", overrides);
    const ContactOnGrid contact = convergence::contact_on_grid(at);
    const solver::Index cells = convergence::cells_for(contact, 50.0);
    const solver::Model model = solver::make_model(convergence::with_cells(at, cells));
    const double across = 2.0 * 0.48909732465087485e-3 / (model.length_unit * std::sqrt(model.grid.h2));
    EXPECT_NEAR(across, cells_across(contact, cells), 1.5);
    EXPECT_GE(across, 49.0);
    EXPECT_LE(across, 56.0);
  }
}

// An extent that is given stays, so that twice the cells are twice as many across. Without one a few stay
// free whatever their number.
TEST(AccuracyChoice, ScalesTheContactWithTheCellsOfAGivenExtent) {
  const ContactOnGrid given = convergence::contact_on_grid(scene("paper", {"grid.extent=[1.2e-3,2e-3]"}));
  EXPECT_NEAR(cells_across(given, 256) / cells_across(given, 64), 4.0, 1e-12);
  const ContactOnGrid free = convergence::contact_on_grid(scene("paper"));
  EXPECT_GT(cells_across(free, 256) / cells_across(free, 64), 4.0 * (1.0 + 2.0 / 64.0));
}

// Of a grid that stands in a file.
TEST(AccuracyChoice, KnowsTheCellsAcrossAGridThatIsGiven) {
  solver::Scene at = scene("paper", {"grid.cells=[24,12]", "grid.extent=[2e-3,1e-3]"});
  at.pressure = solver::PressureModel::file;
  at.steps.front().normal.reset();
  const ContactOnGrid contact = convergence::contact_on_grid(at);
  EXPECT_DOUBLE_EQ(cells_across(contact, 24), contact.cells_across);
}

// As a solve refuses it: else a mesh would be chosen for a part of the contact.
TEST(AccuracyChoice, IsRefusedWhereTheContactGoesOnBeyondTheExtent) {
  const solver::Scene cut = scene("patches", {"grid.extent=[1.4e-3,0.7e-3]"});
  EXPECT_THROW(convergence::contact_on_grid(cut), solver::InputError);
  EXPECT_NO_THROW(convergence::contact_on_grid(scene("patches")));
}

TEST(Accuracy, SaysWhichGridWouldDoInstead) {
  const solver::Scene oblong = scene("paper", {"grid.extent=[2e-3,1e-3]", "grid.cells=[128,64]"});
  const Json accuracy = convergence::exact_accuracy(oblong, {1e-2});
  const Json& cells = accuracy["grid_instead"]["cells"];
  EXPECT_EQ(cells[0].get<int>(), 2 * cells[1].get<int>());
  EXPECT_THAT(
      convergence::accuracy_text({{"accuracy", accuracy}}),
      HasSubstr(fmt::format("it would take {} x {} cells", cells[0].get<int>(), cells[1].get<int>())));
}

TEST(Accuracy, IsReachedOnGridsOfThePapersScene) {
  for (const double wanted : {1e-2, 1e-3, 1e-4}) {
    for (const double ratio : {0.5, 0.9}) {
      const Json result = solved("paper", "--model auto --accuracy " + std::to_string(wanted) +
                                              " --set load.moment_ratio=" + std::to_string(ratio));
      EXPECT_LE(std::abs(result["twist_error"].get<double>()), wanted);
      EXPECT_EQ(result["accuracy"]["reached"], std::abs(result["twist_error"].get<double>()));
      EXPECT_EQ(result["accuracy"]["how"], "exact");
      EXPECT_EQ(result["accuracy"]["wanted"], wanted);
      EXPECT_LE(result["accuracy"]["attempts"].size(), 2U);  // such loads are those that meshes are chosen by
      EXPECT_EQ(result["accuracy"]["attempts"].back()["cells"], result["cells"]);
      EXPECT_GT(result["accuracy"]["predicted_seconds"].get<double>(), 0.0);
    }
  }
}

TEST(Accuracy, OfTractionsAndStickRadiusIsReached) {
  const Json traction = solved("paper", "--model auto --accuracy 1e-2 --accuracy-of traction");
  EXPECT_LE(traction["traction_error"]["l2"].get<double>(), 1e-2);
  const Json stick = solved("paper", "--model auto --accuracy 1e-2 --accuracy-of stick_radius");
  EXPECT_LE(std::abs(stick["stick_radius_error"].get<double>()), 1e-2);
  EXPECT_EQ(stick["accuracy"]["quantity"], "stick_radius");
}

TEST(Accuracy, OfAnImposedTwistIsThatOfTheMoment) {
  const Json result = solved("paper", "--model auto --accuracy 1e-3 --set load.twist=2e-3");
  EXPECT_EQ(result["accuracy"]["quantity"], "moment");
  EXPECT_EQ(result["accuracy"]["reached"], std::abs(result["moment_error"].get<double>()));
  EXPECT_LE(result["accuracy"]["reached"].get<double>(), 1e-3);
}

TEST(Accuracy, OfAHistoryIsThatOfItsLastStep) {
  const Json result = solved("fretting_torsion", "--model auto --accuracy 1e-2");
  EXPECT_EQ(result["accuracy"]["reached"], std::abs(result["steps"].back()["twist_error"].get<double>()));
}

TEST(Accuracy, NeedsNoGridWhereThereIsAnExactAnswer) {
  const Json result = solved("paper", "--accuracy 1e-9");
  EXPECT_EQ(result["method"], "exact");
  EXPECT_LE(result["accuracy"]["reached"].get<double>(), 1e-9);
  EXPECT_TRUE(result["accuracy"]["grid_instead"].is_null());  // no grid gets there, and the reason is said
  EXPECT_GT(solved("paper", "--accuracy 1e-3")["accuracy"]["grid_instead"]["seconds"].get<double>(), 0.0);
  EXPECT_THAT(solve("paper", "--accuracy 1e-3").output, HasSubstr("on a grid"));
  // Unless the user says that it be on a grid.
  EXPECT_EQ(solved("paper", "--accuracy 1e-2 --set solver.model=full")["method"], "coulomb");
  EXPECT_EQ(solve("paper", "--accuracy 1e-16").exit_code, 2);
}

/// Of an ellipse no exact twist is known: the estimate holds against a mesh three times as fine, and as many
/// times the parts of the step.
TEST(Accuracy, IsEstimatedOnAnEllipse) {
  for (const double wanted : {1e-2, 1e-3}) {
    const Json result = solved("ellipse", "--accuracy " + std::to_string(wanted));
    solver::Scene finer =
        scene("ellipse",
              {convergence::cells_override(scene("ellipse"), 3 * result["cells"][0].get<solver::Index>())});
    finer.substeps = 3 * result["accuracy"]["substeps"].get<int>();
    const Json fine = convergence::solve_scene(finer).result;
    const double error = result["twist_angle"].get<double>() / fine["twist_angle"].get<double>() - 1.0;
    EXPECT_EQ(result["accuracy"]["how"], "estimated");
    EXPECT_LE(result["accuracy"]["reached"].get<double>(), wanted);
    EXPECT_LE(std::abs(error), result["accuracy"]["reached"].get<double>());
  }
}

/// The sphere as if it had no exact answer: the estimate is above the error, and not by orders.
TEST(Accuracy, IsEstimatedFromTwoMeshesAboveTheErrorThatIsThere) {
  const solver::Scene at = scene("paper", {"grid.cells=[64,64]"});
  const solver::Solution solution = solver::solve(at);
  const convergence::Errors errors = compare(solution, *convergence::find_oracle(at).oracle);
  const auto estimate = [&](AccuracyOf of) {
    return convergence::reached_error(at, solution, Json::object(), of);
  };
  EXPECT_EQ(estimate(AccuracyOf::twist).how, "estimated");
  EXPECT_GE(estimate(AccuracyOf::twist).error, std::abs(errors.twist));
  EXPECT_LE(estimate(AccuracyOf::twist).error, 30.0 * std::abs(errors.twist));
  EXPECT_GE(estimate(AccuracyOf::traction).error, errors.traction.at_centres.l2);
  EXPECT_LE(estimate(AccuracyOf::traction).error, 5.0 * errors.traction.at_centres.l2);
}

/// Under a flat punch tractions err more than smooth contacts do on any mesh, and the estimate says so.
TEST(Accuracy, IsEstimatedFromTheDifferenceWhereContactsAreNotSmooth) {
  const solver::Scene at = scene("flat_punch", {"grid.cells=[64,64]"});
  const solver::Solution solution = solver::solve(at);
  const convergence::Errors errors = compare(solution, *convergence::find_oracle(at).oracle);
  const double estimate =
      convergence::reached_error(at, solution, Json::object(), AccuracyOf::traction).error;
  EXPECT_GE(estimate, errors.traction.averaged.l2);
  EXPECT_LE(estimate, 5.0 * errors.traction.averaged.l2);
}

/// A twist that one mesh and another estimate: its tractions are no roots at the edge.
solver::Scene punch() { return scene("flat_punch"); }

/// Solves whose errors are made.
convergence::SolvedScene made_answer(const solver::Scene& at, double constant, double order) {
  convergence::SolvedScene answer;
  answer.solution.status = solver::Status::converged;
  const auto cells = static_cast<double>(at.cells[0]);
  answer.result = {{"cells", at.cells}, {"twist_error", -constant * std::pow(cells, -order)}};
  return answer;
}

TEST(Accuracy, IsReachedByRefiningWhereTheFirstMeshIsTooCoarse) {
  const auto found = convergence::solve_to_accuracy(
      punch(), {1e-3}, [](const solver::Scene& at, solver::Detail) { return made_answer(at, 100.0, 2.0); });
  EXPECT_TRUE(found.reached);
  EXPECT_GE(found.accuracy["attempts"].size(), 2U);
  EXPECT_LE(found.accuracy["reached"].get<double>(), 1e-3);
  const Json& attempts = found.accuracy["attempts"];
  for (std::size_t i = 1; i < attempts.size(); ++i) {
    EXPECT_GT(attempts[i]["cells"][0], attempts[i - 1]["cells"][0]);
    EXPECT_LT(attempts[i]["tolerance"], attempts[i - 1]["tolerance"]);
  }
}

TEST(Accuracy, IsGivenUpAfterThreeRefinements) {
  const auto found = convergence::solve_to_accuracy(
      punch(), {1e-2}, [](const solver::Scene& at, solver::Detail) { return made_answer(at, 0.02, 0.0); });
  EXPECT_FALSE(found.reached);
  EXPECT_EQ(found.accuracy["attempts"].size(), 4U);
  EXPECT_DOUBLE_EQ(found.accuracy["reached"], 0.02);
}

TEST(Accuracy, IsGivenUpWhereNoMeshThatMayBeChosenGetsThere) {
  const auto found = convergence::solve_to_accuracy(
      punch(), {1e-2}, [](const solver::Scene& at, solver::Detail) { return made_answer(at, 0.99, 0.0); });
  EXPECT_FALSE(found.reached);
  EXPECT_LE(found.accuracy["attempts"].size(), 4U);
  EXPECT_LE(found.accuracy["attempts"].back()["cells"][0].get<double>(), convergence::kMaxCellsAcross + 8.0);
  const auto at_once = convergence::solve_to_accuracy(
      punch(), {1e-5}, [](const solver::Scene& at, solver::Detail) { return made_answer(at, 0.99, 0.0); });
  EXPECT_EQ(at_once.accuracy["attempts"].size(), 1U);
  EXPECT_THAT(at_once.accuracy["not_reached"].get<std::string>(), HasSubstr("finer than 2048"));
}

TEST(Accuracy, ThatIsNoNumberIsNeverReached) {
  int solves = 0;
  const auto found =
      convergence::solve_to_accuracy(punch(), {1e-2}, [&](const solver::Scene& at, solver::Detail) {
        ++solves;
        convergence::SolvedScene answer = made_answer(at, 1.0, 1.0);
        answer.solution.status = solver::Status::not_converged;
        return answer;
      });
  EXPECT_FALSE(found.reached);
  EXPECT_EQ(solves, 1);
  EXPECT_TRUE(found.accuracy["reached"].is_null());
}

TEST(Accuracy, ThatCannotBeAskedForIsExitCode2) {
  const auto refused = [](const std::string& name, const std::string& arguments, const std::string& says) {
    const ProgramRun out = solve(name, arguments);
    EXPECT_EQ(out.exit_code, 2) << arguments;
    EXPECT_THAT(out.output, HasSubstr(says));
  };
  for (const char* error : {"0", "-1e-3", "nan", "2", "inf"}) {
    refused("paper", "--accuracy " + std::string(error), "above 0 and below 1");
  }
  refused("paper", "--accuracy 1e-9 --model auto", "allowed on a grid");
  refused("paper", "--accuracy 1e-3 --set grid.cells=[64,64]", "--set grid.cells=[64,64]");
  refused("paper", "--accuracy 1e-3 --set solver.tolerance=1e-6", "left out beside --accuracy");
  refused("paper", "--accuracy 1e-3 --model auto --set solver.method=paper", "solver.method");
  refused("paper", "--accuracy 1e-3 --accuracy-of moment", "moment");
  refused("mindlin", "--accuracy 1e-3 --model auto", "no torsion");
  refused("honed_surface", "--accuracy 1e-3", "the grid is that of upper.file");
}

// A contact of millimetres in a square metre: no mesh that resolves it over all of that has an end.
TEST(Accuracy, NeedsAnExtentInWhichTheContactIsSeen) {
  const auto is_refused =
      AllOf(HasSubstr("grid.extent = [1, 1]"), HasSubstr("less than one of [64, 64] cells"));
  for (const char* options : {"--accuracy 0.1", "--accuracy 0.1 --plan", "--set grid.cells=[64,64]"}) {
    const ProgramRun out = solve("turned_ellipse", std::string(options) + " --set 'grid.extent=[1, 1]'");
    EXPECT_EQ(out.exit_code, 2) << options;
    EXPECT_THAT(out.output, is_refused) << options;
  }
  // How large the contact of a sum will be is known after a solve alone.
  const ProgramRun rough = solve("patches", "--accuracy 0.1 --set 'grid.extent=[1, 1]'");
  EXPECT_EQ(rough.exit_code, 2);
  EXPECT_THAT(rough.output,
              AllOf(HasSubstr("grid.extent = [1, 1]"), HasSubstr("too few to choose a mesh by")));
}

TEST(Accuracy, SaysWhatItReplaces) {
  const ProgramRun out = solve("paper", "--accuracy 1e-2 --model auto");
  EXPECT_THAT(out.output,
              AllOf(HasSubstr("replaced"), HasSubstr("grid.cells = [128, 128]"), HasSubstr("attempt")));
}

TEST(Plan, PredictsWhatASolveTakesAndStops) {
  const std::string size = "--set grid.cells=[48,48] ";
  const Json plan = solved("paper", size + "--plan");
  const Json result = solved("paper", size);
  EXPECT_FALSE(plan.contains("status"));
  EXPECT_EQ(plan["plan"]["cells"], result["cells"]);
  EXPECT_EQ(plan["plan"]["bytes"], result["predicted_bytes"]);
  EXPECT_GT(plan["plan"]["seconds"].get<double>(), 0.0);
  // Two tractions in each contact cell, an eighth of them: two mirror axes and the diagonal.
  EXPECT_NEAR(plan["plan"]["unknowns"].get<double>(), result["contact_cells"].get<double>() / 4.0, 10.0);
}

TEST(Plan, OfAnAccuracyIsThatOfTheFirstAttempt) {
  const Json plan = solved("paper", "--model auto --accuracy 1e-2 --plan");
  const Json result = solved("paper", "--model auto --accuracy 1e-2");
  EXPECT_EQ(plan["plan"]["cells"], result["accuracy"]["attempts"][0]["cells"]);
  EXPECT_EQ(plan["plan"]["tolerance"], result["accuracy"]["attempts"][0]["tolerance"]);
}

TEST(Plan, HoldsForScenesOfAllKinds) {
  for (const char* name : {"honed_surface", "unequal_patches", "fretting_force", "dissimilar"}) {
    EXPECT_GT(solved(name, "--plan")["plan"]["bytes"].get<double>(), 0.0) << name;
  }
  EXPECT_TRUE(solved("paper", "--plan --model exact")["plan"]["cells"].is_null());
  EXPECT_TRUE(solved("paper", "--plan --set solver.method=paper")["plan"]["seconds"].is_null());
}

}  // namespace
