// Choices of --accuracy and the accuracy that they reach, on artificial data and in solves.

#include "convergence/solve/accuracy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "convergence/oracle/errors.hpp"
#include "convergence/solve/accurate_solve.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

/// Errors 1/cells^order.
AccuracyData made_data(double order) {
  AccuracyData data;
  for (const double cells : {10.0, 20.0, 40.0, 80.0}) {
    const double error = std::pow(cells, -order);
    data.meshes.push_back({.cells_across = cells,
                           .errors = {{{error, 0.1 * error}, {error, 0.1 * error}, {error, 0.1 * error}}},
                           .tolerances = {1e-2, 1e-4},
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

/// The data of the program are monotonic, as the choice of a mesh needs.
TEST(AccuracyData, OfTheProgramFallFromMeshToMesh) {
  const AccuracyData data = accuracy_data();
  ASSERT_GE(data.meshes.size(), 3U);
  for (std::size_t i = 1; i < data.meshes.size(); ++i) {
    const auto& [across, errors, tolerances, work] = data.meshes[i];
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
}

/// By the data of the program.
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

/// The scene's model on the chosen cells has the requested number of cells across its contact.
TEST(AccuracyChoice, CountsCellsAcrossTheContactNotTheGrid) {
  for (const std::vector<std::string>& overrides :
       std::vector<std::vector<std::string>>{{}, {"grid.extent=[3e-3,3e-3]"}, {"grid.extent=[1.2e-3,2e-3]"}}) {
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

// With a given extent, cells across the contact are proportional to the cells. Without one, a fixed number of
// cells is outside the contact.
TEST(AccuracyChoice, ScalesTheContactWithTheCellsOfAGivenExtent) {
  const ContactOnGrid given = contact_on_grid(example("paper", {"grid.extent=[1.2e-3,2e-3]"}));
  EXPECT_NEAR(cells_across(given, 256) / cells_across(given, 64), 4.0, 1e-12);
  const ContactOnGrid free = contact_on_grid(example("paper"));
  EXPECT_GT(cells_across(free, 256) / cells_across(free, 64), 4.0 * (1.0 + 2.0 / 64.0));
}

// The mesh is chosen for the target less the error by the length of the steps.
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

// A file fixes the grid.
TEST(AccuracyChoice, KnowsTheCellsAcrossAGridThatIsGiven) {
  solver::Scene at = example("paper", {"grid.cells=[24,12]", "grid.extent=[2e-3,1e-3]"});
  at.contact.pressure = solver::PressureModel::file;
  at.steps.front().normal.reset();
  const ContactOnGrid contact = contact_on_grid(at);
  EXPECT_DOUBLE_EQ(cells_across(contact, 24), contact.cells_across);
}

// A solve refuses such a contact too; a mesh would be chosen for a part of it.
TEST(AccuracyChoice, IsRefusedWhereTheContactGoesOnBeyondTheExtent) {
  const solver::Scene cut = example("patches", {"grid.extent=[1.4e-3,0.7e-3]"});
  EXPECT_THROW(contact_on_grid(cut), solver::InputError);
  EXPECT_NO_THROW(contact_on_grid(example("patches")));
}

/// Without their exact answers: the estimate is above the error, by less than a factor. The error of
/// tractions under a flat punch is larger than that of smooth contacts.
TEST(Accuracy, IsEstimatedFromTwoMeshesAboveTheErrorThatIsThere) {
  for (const char* name : {"paper", "flat_punch"}) {
    const solver::Scene at = example(name, {"grid.cells=[64,64]"});
    const solver::Solution solution = solver::solve(at);
    const Errors errors = compare(solution, *find_oracle(at).oracle);
    const auto estimate = [&](AccuracyOf of) { return reached_error(at, solution, ErrorsRecord{}, of); };
    const bool smooth = std::string(name) == "paper";
    const double traction = smooth ? errors.traction.at_centres.l2 : errors.traction.averaged.l2;
    EXPECT_GE(estimate(AccuracyOf::traction).error, traction) << name;
    EXPECT_LE(estimate(AccuracyOf::traction).error, 5.0 * traction) << name;
    if (!smooth) continue;
    EXPECT_EQ(estimate(AccuracyOf::twist).how, "estimated");
    EXPECT_GE(estimate(AccuracyOf::twist).error, std::abs(errors.twist));
    EXPECT_LE(estimate(AccuracyOf::twist).error, 30.0 * std::abs(errors.twist));
  }
}

/// A scene whose error is estimated from two meshes: its tractions are singular at the edge.
solver::Scene punch() { return example("flat_punch"); }

/// An answer with the error constant/cells^order.
SolvedScene made_answer(const solver::Scene& at, double constant, double order) {
  SolvedScene answer;
  answer.solution.status = solver::Status::converged;
  const auto cells = static_cast<double>(at.grid.cells[0]);
  answer.record.problem.cells = at.grid.cells;
  answer.record.end.errors.twist = {-constant * std::pow(cells, -order)};
  return answer;
}

AccurateAnswer made_accuracy(double error, double constant, double order) {
  return solve_to_accuracy(punch(), {error},
                           [=](const solver::Scene& at, solver::Detail) { return made_answer(at, constant, order); });
}

TEST(Accuracy, IsReachedByRefiningWhereTheFirstMeshIsTooCoarse) {
  const auto found = made_accuracy(1e-3, 100.0, 2.0);
  EXPECT_TRUE(found.reached());
  const std::vector<AttemptAccount>& attempts = found.accuracy.grid->attempts;
  EXPECT_GE(attempts.size(), 2U);
  EXPECT_LE(found.accuracy.error(), 1e-3);
  for (std::size_t i = 1; i < attempts.size(); ++i) {
    EXPECT_GT(attempts[i].cells[0], attempts[i - 1].cells[0]);
    EXPECT_LT(attempts[i].tolerance, attempts[i - 1].tolerance);
  }
}

TEST(Accuracy, IsGivenUpAfterThreeRefinementsOrWhereNoMeshThatMayBeChosenGetsThere) {
  const auto found = made_accuracy(1e-2, 0.02, 0.0);
  EXPECT_FALSE(found.reached());
  EXPECT_EQ(found.accuracy.grid->attempts.size(), 4U);
  EXPECT_DOUBLE_EQ(found.accuracy.error(), 0.02);
  const auto far = made_accuracy(1e-2, 0.99, 0.0);
  EXPECT_FALSE(far.reached());
  EXPECT_LE(far.accuracy.grid->attempts.size(), 4U);
  EXPECT_LE(far.accuracy.grid->attempts.back().cells[0], kMaxCellsAcross + 8.0);
  EXPECT_EQ(made_accuracy(1e-5, 0.99, 0.0).accuracy.grid->attempts.size(), 1U);
}

TEST(Accuracy, ThatIsNoNumberIsNeverReached) {
  int solves = 0;
  const auto found = solve_to_accuracy(punch(), {1e-2}, [&](const solver::Scene& at, solver::Detail) {
    ++solves;
    SolvedScene answer = made_answer(at, 1.0, 1.0);
    answer.solution.status = solver::Status::not_converged;
    return answer;
  });
  EXPECT_FALSE(found.reached());
  EXPECT_EQ(solves, 1);
  EXPECT_TRUE(std::isnan(found.accuracy.error()));
}

// ---------------------------------------------------------------- errors estimated from two meshes

constexpr double kApart = 0.25;  ///< larger than the least error of any mesh as fine as these

/// A scene, and an artificial answer on its mesh: each number and traction is the one on half as many cells,
/// times a factor.
struct TwoMeshes {
  solver::Scene scene;
  solver::Solution fine;

  TwoMeshes(const std::string& name, const std::string& load, double factor)
      : scene(example(name, {"grid.cells=[48,48]", load})), fine(solver::solve(scene)) {
    solver::Scene half = scene;
    half.grid.cells = {24, 24};
    half.grid.extent = {48.0 * fine.grid.h1, 48.0 * fine.grid.h2};
    const solver::Solution coarse = solver::solve(half);
    fine.twist_angle = factor * coarse.twist_angle;
    fine.moment = factor * coarse.moment;
    fine.stick_radius = factor * coarse.stick_radius;
    for (const solver::Index component : {0, 1}) {
      for (solver::Index i = 0; i < 48; ++i) {
        for (solver::Index j = 0; j < 48; ++j) {
          fine.traction[(component * 48 + i) * 48 + j] =
              factor * coarse.traction[(component * 24 + i / 2) * 24 + j / 2];
        }
      }
    }
  }

  ReachedError error(AccuracyOf of) const { return reached_error(scene, fine, ErrorsRecord{}, of); }
};

const std::string kHalfTheLimit = "load.moment_ratio=0.5";

// The fine value is 1 + d times the coarse one: the estimate is 3 d/(1 + d)/(2^p - 1), relative (Roache
// 1998). The theoretical order p is 2 for a smooth contact's twist, 1 for its stick radius and for a punch
// with its singular edge. A rough surface has none; 1 is taken.
TEST(ReachedError, OfANumberIsThreeTimesTheExtrapolatedDistance) {
  const double apart = kApart / (1.0 + kApart);
  for (const auto& [scene, of, order] :
       std::vector<std::tuple<std::string, AccuracyOf, double>>{{"paper", AccuracyOf::twist, 2.0},
                                                                {"paper", AccuracyOf::stick_radius, 1.0},
                                                                {"flat_punch", AccuracyOf::twist, 1.0},
                                                                {"rough_sphere", AccuracyOf::twist, 1.0}}) {
    const ReachedError found =
        TwoMeshes(scene, scene == "flat_punch" ? "load.moment_ratio=0.9" : kHalfTheLimit, 1.0 + kApart).error(of);
    EXPECT_EQ(found.how, "estimated") << scene;
    EXPECT_NEAR(found.error, 3.0 * apart / (std::exp2(order) - 1.0), 1e-6) << scene;
    EXPECT_NE(found.why.find("24 x 24"), std::string::npos) << scene;
  }
}

TEST(ReachedError, OfAnImposedTwistIsThatOfTheMoment) {
  TwoMeshes made("paper", "load.twist=2e-3", 1.0);
  made.fine.moment *= 1.0 + kApart;
  EXPECT_NEAR(made.error(AccuracyOf::twist).error, kApart / (1.0 + kApart), 1e-6);  // 3 times it over 2^2 - 1
}

// Tractions that are 1 + d times the coarse ones differ by d of these in the root mean square. The order is
// 1, so the estimate is this difference times 1.25.
TEST(ReachedError, OfTractionsIsTheDifferenceInTheRootMeanSquare) {
  const TwoMeshes made("paper", kHalfTheLimit, 1.0 + kApart);
  EXPECT_NEAR(made.error(AccuracyOf::traction).error, 1.25 * kApart / (1.0 + kApart), 1e-6);
}

// Two meshes may agree by chance.
TEST(ReachedError, IsNeverLessThanThatOfSmoothContactsOnSuchAMesh) {
  const TwoMeshes made("paper", kHalfTheLimit, 1.0);
  const double across = 2.0 * made.fine.contact_radius / std::sqrt(made.fine.grid.cell_area());
  for (const AccuracyOf of : {AccuracyOf::twist, AccuracyOf::traction, AccuracyOf::stick_radius}) {
    EXPECT_EQ(made.error(of).error, error_with(accuracy_data(), of, across));
  }
}

}  // namespace
}  // namespace slipstick::convergence
