#include "solver/history/load_parts.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "solver/solve.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

class LoadParts : public SceneFile {
 protected:
  Solution solved(const std::string& steps, const std::vector<std::string>& overrides = {}) const {
    std::vector<std::string> keys{"grid.cells=[24,24]", "load.moment_ratio=0"};
    keys.insert(keys.end(), overrides.begin(), overrides.end());
    return solve(read(kShortScene + steps, keys));
  }
  /// A push, and a twist in a given number of steps.
  static std::string push_and_twist(int steps) {
    std::string text = "[[step]]\nforce = [50, 0]\n";
    for (int k = 1; k <= steps; ++k) {
      text += "[[step]]\nmoment_ratio = " + std::to_string(0.5 * k / steps) + "\n";
    }
    return text;
  }
};

TEST_F(LoadParts, PartsEndWithTheStepAndGoStraightToIt) {
  Scene scene;
  scene.solver.substeps = 4;
  const Step before{.name = {}, .normal = 1000.0, .displacement = {}};
  Step step = before;
  step.torsion = Moment{0.03};
  step.force = {10.0, -20.0};
  const StepEnd end{.moment = -0.01, .force = {2.0, 0.0}};
  const std::vector<Step> parts = parts_of(scene, step, &before, end);
  ASSERT_EQ(parts.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const double part = 0.25 * static_cast<double>(k + 1);
    EXPECT_NEAR(std::get<Moment>(parts[k].torsion).value, -0.01 + 0.04 * part, 1e-17);
    EXPECT_NEAR(parts[k].force[0], 2.0 + 8.0 * part, 1e-14);
    EXPECT_NEAR(parts[k].force[1], -20.0 * part, 1e-14);
    EXPECT_EQ(parts[k].normal, 1000.0);
  }
  EXPECT_EQ(parts.back().force, step.force);
}

TEST_F(LoadParts, TheNormalLoadComesFirstWhileTheOthersStay) {
  Scene scene;
  scene.solver.substeps = 4;
  const Step before{.name = {}, .normal = 1000.0, .displacement = {}};
  Step step = before;
  step.normal = 800.0;
  step.torsion = Twist{2e-4};
  const StepEnd end{.twist = 1e-4, .force = {3.0, 4.0}};
  const std::vector<Step> parts = parts_of(scene, step, &before, end);
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_EQ(parts[0].normal, 900.0);
  EXPECT_EQ(parts[1].normal, 800.0);
  for (const std::size_t k : {0, 1}) {
    EXPECT_EQ(std::get<Twist>(parts[k].torsion).value, 1e-4);
    EXPECT_EQ(parts[k].force, end.force);
  }
  EXPECT_NEAR(std::get<Twist>(parts[2].torsion).value, 1.5e-4, 1e-19);
  EXPECT_EQ(parts[2].normal, 800.0);
}

TEST_F(LoadParts, AStepInPartsEndsAsStepsThatAreWrittenOut) {
  const std::string tight = "solver.tolerance=1e-12";
  const Solution in_parts =
      solved("[[step]]\nforce = [50, 0]\n[[step]]\nforce = [30, 20]\n", {"solver.substeps=2", tight});
  const Solution written = solved(
      "[[step]]\nforce = [25, 0]\n[[step]]\nforce = [50, 0]\n[[step]]\nforce = [40, 10]\n[[step]]\nforce = "
      "[30, 20]\n",
      {tight});
  ASSERT_EQ(in_parts.status, Status::converged);
  EXPECT_NEAR(in_parts.displacement[0], written.displacement[0], 1e-12 * std::abs(written.displacement[0]));
  EXPECT_NEAR(in_parts.displacement[1], written.displacement[1], 1e-12 * std::abs(written.displacement[1]));
  EXPECT_GT(in_parts.dissipated, written.dissipated);  // of both parts, not of the last one
}

// A step that stops in one of its parts has no answer: its numbers are NaN.
TEST_F(LoadParts, AStepThatBreaksOffHasNoAnswer) {
  std::vector<Solution> steps;
  SolveOptions options;
  options.observer.step = [&](const Solution& at) { steps.push_back(at); };
  const Scene scene = read(kShortScene + push_and_twist(1), {"solver.substeps=8", "solver.max_iterations=3"});
  solve(scene, options);
  const Solution& last = steps.back();
  ASSERT_EQ(last.status, Status::not_converged);
  EXPECT_THAT(last.message, testing::HasSubstr("part 1 of 8"));
  for (const double number : {last.twist_angle, last.moment, last.displacement[0], last.force[1], last.work})
    EXPECT_TRUE(std::isnan(number));
}

}  // namespace
}  // namespace slipstick::solver
