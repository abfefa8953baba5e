// How --accuracy chooses, what it reaches, and that it says so: on made data and in solves.

#include "convergence/solve/accuracy.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "convergence/runs/run_spec.hpp"
#include "convergence/solve/accurate_solve.hpp"
#include "convergence/solve/reached.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

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

/// Those that come with the program, so that a mesh can be picked by them; and the file that holds them,
/// which is what would be written of them.
TEST(AccuracyData, OfTheProgramFallFromMeshToMesh) {
  const AccuracyData data = accuracy_data();
  ASSERT_GE(data.meshes.size(), 3U);
  for (std::size_t i = 1; i < data.meshes.size(); ++i) {
    const auto& [across, errors, tolerances, applications, work] = data.meshes[i];
    EXPECT_GT(across, data.meshes[i - 1].cells_across);
    for (std::size_t q = 0; q < kAccuracies; ++q) {
      EXPECT_LE(errors[q].error, data.meshes[i - 1].errors[q].error);
      EXPECT_LE(errors[q].tolerance, data.meshes[i - 1].errors[q].tolerance);
    }
    EXPECT_TRUE(std::ranges::is_sorted(tolerances, std::ranges::greater{}));
    EXPECT_EQ(work.size(), tolerances.size());
    EXPECT_GT(std::ranges::min(work), 0.0);
  }
  for (const auto& [word, of] : accuracy_words()) EXPECT_GT(falling_order(data, of), 0.0) << word;
  const std::string file = solver::read_input_file(
      fs::path(SLIPSTICK_SCENES).parent_path() / "solve/accuracy.toml", 1 << 20, "accuracy data");
  const std::size_t origin = file.find("# ", 1);
  const std::string written = file.substr(origin + 2, file.find('\n', origin) - origin - 2);
  EXPECT_EQ(accuracy_toml(data, written), file);
}

/// Those that come with the program, in every scene that may ask for them.
TEST(AccuracyChoice, TakesNoFewerCellsForASmallerError) {
  for (const char* name : {"paper", "ellipse", "unequal_patches", "off_centre"}) {
    const solver::Scene at = example(name);
    const ContactOnGrid contact = contact_on_grid(at);
    for (const AccuracyOf of : {AccuracyOf::twist, AccuracyOf::traction, AccuracyOf::stick_radius}) {
      AccuracyChoice before;
      before.tolerance = 1.0;
      for (double error = 0.5; error > 0.006; error /= 1.3) {
        const AccuracyChoice choice = choose_grid(at, contact, {error, of}, false);
        EXPECT_GE(choice.cells, before.cells);
        EXPECT_LE(choice.tolerance, before.tolerance);
        EXPECT_GE(choose_grid(at, contact, {error, of}, true).cells, choice.cells);
        before = choice;
      }
    }
  }
}

/// The scene's own model on the chosen cells has as many across its contact as were asked for.
TEST(AccuracyChoice, CountsCellsAcrossTheContactNotTheGrid) {
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {}, {"grid.extent=[3e-3,3e-3]"}, {"grid.extent=[1.2e-3,2e-3]"}}) {
    const solver::Scene at = example("paper", overrides);
    const ContactOnGrid contact = contact_on_grid(at);
    const solver::Index cells = cells_for(contact, 50.0);
    const solver::Model model = solver::make_model(with_cells(at, cells));
    const double across = 2.0 * 0.48909732465087485e-3 / (model.length_unit * std::sqrt(model.grid.h2));
    EXPECT_NEAR(across, cells_across(contact, cells), 1.5);
    EXPECT_GE(across, 49.0);
    EXPECT_LE(across, 56.0);
  }
}

// An extent that is given stays, so that twice the cells are twice as many across. Without one a few stay
// free whatever their number.
TEST(AccuracyChoice, ScalesTheContactWithTheCellsOfAGivenExtent) {
  const ContactOnGrid given = contact_on_grid(example("paper", {"grid.extent=[1.2e-3,2e-3]"}));
  EXPECT_NEAR(cells_across(given, 256) / cells_across(given, 64), 4.0, 1e-12);
  const ContactOnGrid free = contact_on_grid(example("paper"));
  EXPECT_GT(cells_across(free, 256) / cells_across(free, 64), 4.0 * (1.0 + 2.0 / 64.0));
}

// What the length of steps leaves is no part of what the mesh may leave.
TEST(AccuracyChoice, LeavesTheLengthOfStepsItsPart) {
  const solver::Scene at = example("paper");
  const ContactOnGrid contact = contact_on_grid(at);
  for (const double path : {1e-3, 4e-3}) {
    const AccuracyTarget both{.error = 1e-2, .path = path};
    const AccuracyTarget mesh{.error = 1e-2 - path};
    EXPECT_EQ(choose_grid(at, contact, both, true).cells, choose_grid(at, contact, mesh, true).cells);
    EXPECT_EQ(choose_shifted(at, contact, both, {}).cells, choose_shifted(at, contact, mesh, {}).cells);
  }
}

// The grid stands in a file.
TEST(AccuracyChoice, KnowsTheCellsAcrossAGridThatIsGiven) {
  solver::Scene at = example("paper", {"grid.cells=[24,12]", "grid.extent=[2e-3,1e-3]"});
  at.contact.pressure = solver::PressureModel::file;
  at.steps.front().normal.reset();
  const ContactOnGrid contact = contact_on_grid(at);
  EXPECT_DOUBLE_EQ(cells_across(contact, 24), contact.cells_across);
}

// As a solve refuses it: else a mesh would be chosen for a part of the contact.
TEST(AccuracyChoice, IsRefusedWhereTheContactGoesOnBeyondTheExtent) {
  const solver::Scene cut = example("patches", {"grid.extent=[1.4e-3,0.7e-3]"});
  EXPECT_THROW(contact_on_grid(cut), solver::InputError);
  EXPECT_NO_THROW(contact_on_grid(example("patches")));
}

/// The sphere as if it had no exact answer: the estimate is above the error, and not by orders.
TEST(Accuracy, IsEstimatedFromTwoMeshesAboveTheErrorThatIsThere) {
  const solver::Scene at = example("paper", {"grid.cells=[64,64]"});
  const solver::Solution solution = solver::solve(at);
  const Errors errors = compare(solution, *find_oracle(at).oracle);
  const auto estimate = [&](AccuracyOf of) { return reached_error(at, solution, Json::object(), of); };
  EXPECT_EQ(estimate(AccuracyOf::twist).how, "estimated");
  EXPECT_GE(estimate(AccuracyOf::twist).error, std::abs(errors.twist));
  EXPECT_LE(estimate(AccuracyOf::twist).error, 30.0 * std::abs(errors.twist));
  EXPECT_GE(estimate(AccuracyOf::traction).error, errors.traction.at_centres.l2);
  EXPECT_LE(estimate(AccuracyOf::traction).error, 5.0 * errors.traction.at_centres.l2);
}

/// Under a flat punch tractions err more than smooth contacts do on any mesh, and the estimate says so.
TEST(Accuracy, IsEstimatedFromTheDifferenceWhereContactsAreNotSmooth) {
  const solver::Scene at = example("flat_punch", {"grid.cells=[64,64]"});
  const solver::Solution solution = solver::solve(at);
  const Errors errors = compare(solution, *find_oracle(at).oracle);
  const double estimate = reached_error(at, solution, Json::object(), AccuracyOf::traction).error;
  EXPECT_GE(estimate, errors.traction.averaged.l2);
  EXPECT_LE(estimate, 5.0 * errors.traction.averaged.l2);
}

/// A twist that one mesh and another estimate: its tractions are no roots at the edge.
solver::Scene punch() { return example("flat_punch"); }

/// Solves whose errors are made.
SolvedScene made_answer(const solver::Scene& at, double constant, double order) {
  SolvedScene answer;
  answer.solution.status = solver::Status::converged;
  const auto cells = static_cast<double>(at.grid.cells[0]);
  answer.result = {{"cells", at.grid.cells}, {"twist_error", -constant * std::pow(cells, -order)}};
  return answer;
}

/// What an accuracy of a punch comes to whose errors are made.
AccurateAnswer made_accuracy(double wanted, double constant, double order) {
  return solve_to_accuracy(punch(), {wanted}, [=](const solver::Scene& at, solver::Detail) {
    return made_answer(at, constant, order);
  });
}

TEST(Accuracy, IsReachedByRefiningWhereTheFirstMeshIsTooCoarse) {
  const auto found = made_accuracy(1e-3, 100.0, 2.0);
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
  const auto found = made_accuracy(1e-2, 0.02, 0.0);
  EXPECT_FALSE(found.reached);
  EXPECT_EQ(found.accuracy["attempts"].size(), 4U);
  EXPECT_DOUBLE_EQ(found.accuracy["reached"], 0.02);
}

TEST(Accuracy, IsGivenUpWhereNoMeshThatMayBeChosenGetsThere) {
  const auto found = made_accuracy(1e-2, 0.99, 0.0);
  EXPECT_FALSE(found.reached);
  EXPECT_LE(found.accuracy["attempts"].size(), 4U);
  EXPECT_LE(found.accuracy["attempts"].back()["cells"][0].get<double>(), kMaxCellsAcross + 8.0);
  const auto at_once = made_accuracy(1e-5, 0.99, 0.0);
  EXPECT_EQ(at_once.accuracy["attempts"].size(), 1U);
  EXPECT_THAT(at_once.accuracy["not_reached"].get<std::string>(), HasSubstr("finer than 2048"));
}

TEST(Accuracy, ThatIsNoNumberIsNeverReached) {
  int solves = 0;
  const auto found = solve_to_accuracy(punch(), {1e-2}, [&](const solver::Scene& at, solver::Detail) {
    ++solves;
    SolvedScene answer = made_answer(at, 1.0, 1.0);
    answer.solution.status = solver::Status::not_converged;
    return answer;
  });
  EXPECT_FALSE(found.reached);
  EXPECT_EQ(solves, 1);
  EXPECT_TRUE(found.accuracy["reached"].is_null());
}

}  // namespace
}  // namespace slipstick::convergence
