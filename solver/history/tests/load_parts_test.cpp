#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>

#include "solver/tests/paper_scene.hpp"
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
  const Scene scene = read(kShortScene + push_and_twist(1), {"solver.substeps=8", "solver.max_iterations=3"});
  const Solution last = steps_of(scene).back();
  ASSERT_EQ(last.status, Status::not_converged);
  EXPECT_THAT(last.message, testing::HasSubstr("part 1 of 8"));
  for (const double number : {last.twist_angle, last.moment, last.displacement[0], last.force[1], last.work})
    EXPECT_TRUE(std::isnan(number));
}

/// The part of earlier tractions and motions that rounding leaves.
constexpr double kNothing = 1e-8;

class Nothing : public SceneFile {
 protected:
  /// Each "[[step]]" with these keys, after the short scene with these changes.
  std::vector<Solution> steps_of(const std::vector<std::string>& steps, std::vector<std::string> changes = {},
                                 const std::string& above = "") const {
    std::string text = above + kShortScene;
    for (const std::string& step : steps) text += "[[step]]\n" + step + "\n";
    const std::vector<Solution> solved = solver::steps_of(read(text, changes));
    for (const Solution& at : solved) EXPECT_EQ(at.status, Status::converged) << at.loads.key << at.message;
    return solved;
  }

  static double largest(const Eigen::ArrayXd& field) { return field.abs().maxCoeff(); }

  /// Its pressure is infinite at the edge; 300 N are its limit.
  const std::vector<std::string> punch_{"upper.shape=flat_punch", "upper.radius=0.0005",
                                        "contact.friction=0.3", "load.moment_ratio=0"};
};

/// Where nothing slips the answer is linear in the load: nothing is left, and a part leaves that part.
TEST_F(Nothing, IsLeftWhereAllStuck) {
  for (const std::string force : {"1", "30", "120"}) {
    for (const std::string part : {"0", "e-5"}) {
      const std::string least = part == "0" ? part : force + part;
      const auto steps = steps_of({"force = [" + force + ", 0]", "force = [" + least + ", 0]"}, punch_);
      ASSERT_EQ(steps[0].stick_cells, steps[0].contact_cells);
      const double left = part == "0" ? 0.0 : 1e-5;
      EXPECT_LE(largest(steps[1].traction - left * steps[0].traction), kNothing * largest(steps[0].traction));
      EXPECT_NEAR(steps[1].displacement[0] / steps[0].displacement[0], left, kNothing);
      EXPECT_NEAR(steps[1].certificate.energy / steps[0].elastic_energy, 1.0, kNothing);
    }
  }
}

/// Near zero load, the remaining energy is hardly above the rounding of the energy before.
TEST_F(Nothing, IsReachedThroughTheRoundingOfEnergies) {
  for (const char* part : {"1.255e-4", "1.842e-4", "2.012e-4", "3e-4", "4.319e-4", "5.439e-4"}) {
    const auto steps = steps_of({"force = [1, 0]", fmt::format("force = [{}, 0]", part)},
                                {"upper.shape=flat_punch", "upper.radius=0.0005", "contact.friction=0.3",
                                 "load.moment_ratio=0", "grid.cells=[24, 24]"});
    EXPECT_LE(steps[1].certificate.gap, 1e-8);
  }
}

/// The tractions that stay meet Coulomb's law under the load that stays, over an energy that this load can
/// hold.
TEST_F(Nothing, IsLeftOfTheNormalLoad) {
  for (const double load : {1.0, 1e-4}) {
    const auto steps =
        steps_of({"moment_ratio = 0.4", fmt::format("normal = {}\nmoment_ratio = 0", load)}, punch_);
    EXPECT_LE(steps[1].certificate.friction_bound, kNothing);
    EXPECT_LE(std::abs(steps[1].moment), kNothing * steps[1].moment_limit);
    EXPECT_LE(steps[1].certificate.energy,
              std::max(steps[1].elastic_energy, 1e-3 * load * steps[0].elastic_energy));
  }
}

/// A cell does not push itself aside.
TEST_F(Nothing, IsCarriedByOneCellOfDissimilarBodies) {
  const Solution one =
      steps_of({""}, {"lower.young_modulus=70e9", "upper.at=[1e-4, 1e-4]", "load.normal=1",
                      "load.moment_ratio=0", "grid.cells=[16, 16]", "grid.extent=[0.0032, 0.0032]"})[0];
  EXPECT_EQ(one.contact_cells, 1);
  EXPECT_EQ(largest(one.traction), 0.0);
  EXPECT_EQ(one.certificate.gap, 0.0);
  EXPECT_TRUE(std::isnan(one.slip_direction.mean) && std::isnan(one.slip_direction.max));
}

/// A load that a step leaves out stays as it was, in the second cycle too: to the bits of the steps written
/// out.
TEST_F(Nothing, IsForgottenBetweenCycles) {
  const std::vector<std::string> steps{"moment_ratio = 0.1", "normal = 700\nforce = [0, 0]"};
  const auto in_cycles = steps_of(steps, {"load.force=[30, 0]"}, "cycles = 2\n");
  const auto written = steps_of({steps[0], steps[1], steps[0], steps[1]}, {"load.force=[30, 0]"});
  ASSERT_EQ(in_cycles.size(), written.size());
  for (std::size_t k = 0; k < written.size(); ++k) {
    EXPECT_EQ(in_cycles[k].twist_angle, written[k].twist_angle);
    EXPECT_TRUE((in_cycles[k].traction == written[k].traction).all());
  }
  EXPECT_NEAR(in_cycles[2].normal_load, 700.0, 1e-6);
  EXPECT_TRUE(std::isnan(in_cycles[2].slip_direction.mean));  // nothing changes, so nothing slips
  EXPECT_LE(in_cycles[1].slip_direction.mean, 1e-3);
}

/// A model with a last digit leaves out the same as one without it, and gives the same twist.
TEST_F(Nothing, IsTheCostOfALastDigit) {
  const Solution plain = solve(read(kShortScene));
  ASSERT_EQ(plain.left_out.size(), 5U);  // coupling, translations, the grid's rim, three quarters, one field
  for (const char* change : {"lower.poisson_ratio=0.30000000000000004", "upper.at=[1e-17, 0]",
                             "load.force=[1e-300, 0]", "upper.young_modulus=210000000000.0001"}) {
    const Solution changed = solve(read(kShortScene, {change}));
    EXPECT_NEAR(changed.twist_angle / plain.twist_angle, 1.0, 1e-10) << change;
    for (const Omission& part : plain.left_out) {
      EXPECT_THAT(changed.left_out, Contains(testing::Field(&Omission::what, part.what))) << change;
    }
  }
  EXPECT_NE(solve(read(kShortScene, {"load.force=[1e-7, 0]"})).force[0], 0.0);
  EXPECT_TRUE(read(kShortScene, {"solver.model=full", "load.force=[1e-300, 0]"}).left_out.empty());
}

/// The limit in numbers, where a factor of the loads would be 1.
TEST_F(Nothing, IsSaidByAFactorOfOne) {
  const auto refused = [&](const std::string& force) {
    return complaint([&] { steps_of({}, {"load.moment_ratio=0", "load.force=[" + force + ", 0]"}); });
  };
  EXPECT_THAT(refused("100.0000001"), testing::AllOf(says("[99.99999"), testing::Not(says("1 times"))));
  EXPECT_THAT(refused("125"), says("0.8 times these: ["));
}

/// The answers of resumed histories are tested with the program.
TEST_F(LoadParts, AStateOfAnotherSceneIsRefused) {
  const std::string steps = push_and_twist(1);
  const Scene scene = read(kShortScene + steps, {"load.moment_ratio=0"});
  std::shared_ptr<HistoryState> left;
  solve(scene,
        {.observer = {.state = [&](const HistoryState& at) { left = std::make_shared<HistoryState>(at); }}});
  const Scene other = read(kShortScene + steps, {"load.moment_ratio=0", "grid.cells=[12,12]"});
  EXPECT_THROW(solve(other, {.resumed = left}), std::invalid_argument);
  for (const std::size_t finished : {0U, 2U, 3U}) {
    left->finished = finished;
    EXPECT_THROW(solve(scene, {.resumed = left}), std::invalid_argument) << finished;
  }
}

/// The solutions at the ends of four steps, in which forces and moments come and go.
std::vector<ModelSolution> shaken() {
  Scene scene = paper_scene(20, 0.0);
  scene.solver.tolerance = kGap;
  scene.steps.clear();
  for (const auto& [ratio, force1, force2] : {std::array{0.6, 20.0, 30.0}, std::array{-0.2, 60.0, -10.0},
                                              std::array{0.5, -30.0, -30.0}, std::array{0.0, 10.0, 0.0}}) {
    Step& step = scene.steps.emplace_back();
    step.normal = paper::kLoad;
    step.torsion = MomentRatio{ratio};
    step.force = {force1, force2};
  }
  std::vector<ModelSolution> steps;
  solve_in_model_units(scene, [&](const ModelSolution& solution) { steps.push_back(solution); });
  return steps;
}

double in_energy_norm(const ModelSolution& solution, const Eigen::ArrayXd& q) {
  const Model& model = solution.model;
  const auto op = make_operator(OperatorKind::direct, model.grid, tangential_kernel(), *model.law);
  Eigen::ArrayXd u(q.size());
  op->apply(q, u);
  return (q * u).sum() * model.grid.cell_area() * model.moment_unit();
}

/// In each step: dissipated + stored + |change of q|_K^2/2 is the work of the loads at its end. This follows
/// from Coulomb's law of the step, s.q = -mu p |s|, with s = K (change of q) less the rigid motion.
TEST(Energy, GoesIntoHeatAndElasticity) {
  const auto steps = shaken();
  ASSERT_EQ(steps.size(), 4U);
  Eigen::ArrayXd before = Eigen::ArrayXd::Zero(steps[0].tangential.traction.size());
  double stored = 0.0;
  double twist = 0.0;
  std::array<double, 2> at{};
  for (const ModelSolution& step : steps) {
    const Eigen::ArrayXd change = step.tangential.traction - before;
    const double loads = step.moment * (step.twist_angle - twist) +
                         step.force[0] * (step.displacement[0] - at[0]) +
                         step.force[1] * (step.displacement[1] - at[1]);
    const double scale = step.dissipated + step.elastic_energy;
    EXPECT_NEAR(step.dissipated + step.elastic_energy - stored + 0.5 * in_energy_norm(step, change), loads,
                1e-11 * scale);
    EXPECT_NEAR(step.dissipated - step.work, step.certificate.gap * step.elastic_energy, 1e-13 * scale);
    EXPECT_LE(step.certificate.gap, kGap);
    EXPECT_GE(step.dissipated, 0.0);
    before = step.tangential.traction;
    stored = step.elastic_energy;
    twist = step.twist_angle;
    at = step.displacement;
  }
}

}  // namespace
}  // namespace slipstick::solver
