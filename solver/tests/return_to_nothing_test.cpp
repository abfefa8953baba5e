#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "solver/model_solution.hpp"
#include "solver/scene/last_digits.hpp"
#include "solver/solve.hpp"
#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

/// Loads that fall to nothing or to next to nothing, and numbers that are next to nothing.
namespace slipstick::solver {
namespace {

using testing::HasSubstr;

/// Tractions and motions that rounding leaves of those before.
constexpr double kNothing = 1e-8;

std::vector<Solution> steps_of(const Scene& scene) {
  std::vector<Solution> steps;
  SolveOptions options;
  options.on_step = [&](const Solution& at) {
    EXPECT_EQ(at.status, Status::converged) << at.loads.key << ": " << at.message;
    steps.push_back(at);
  };
  solve(scene, options);
  return steps;
}

/// A flat punch of 0.5 mm under 1 kN, friction 0.3: the pressure is infinite at its edge.
Scene punch(Index cells) {
  Scene scene = paper_scene(cells, 0.0);
  scene.surfaces.front().shape = Shape::flat_punch;
  scene.surfaces.front().radius = 0.5e-3;
  scene.friction = 0.3;
  return scene;
}

Scene with_steps(Scene scene, const std::vector<Step>& steps) {
  for (const Step& given : steps) {
    Step step = given;
    if (!step.normal) step.normal = paper::kLoad;
    scene.steps.push_back(step);
  }
  scene.steps.erase(scene.steps.begin());
  return scene;
}

double largest(const Eigen::ArrayXd& field) { return field.abs().maxCoeff(); }

/// Where nothing slips the answer is linear in the load: nothing is left, and a part leaves that part.
TEST(ReturnToNothing, LeavesNothingWhereAllStuck) {
  for (const double force : {1.0, 30.0, 120.0}) {
    for (const double part : {0.0, 1e-5}) {
      const auto steps = steps_of(with_steps(
          punch(32), {{.force = {force, 0.0}}, {.force = {part * force, 0.0}}, {.force = {force, 0.0}}}));
      ASSERT_EQ(steps[0].stick_cells, steps[0].contact_cells);
      EXPECT_LE(largest(steps[1].traction - part * steps[0].traction), kNothing * largest(steps[0].traction));
      EXPECT_NEAR(steps[1].displacement[0] / steps[0].displacement[0], part, kNothing);
      EXPECT_NEAR(steps[2].displacement[0] / steps[0].displacement[0], 1.0, kNothing);
      EXPECT_GE(steps[1].certificate.energy, 0.99 * steps[0].elastic_energy);
    }
  }
  const auto steps =
      steps_of(with_steps(punch(24), {{.torsion = MomentRatio{0.1}}, {.torsion = MomentRatio{0.0}}}));
  EXPECT_LE(std::abs(steps[1].twist_angle), kNothing * steps[0].twist_angle);
}

/// Masing's rule: what stays is phi(m) - 2 phi(m/2), and nothing where no cell slipped.
TEST(ReturnToNothing, LeavesWhatMasingsRuleSays) {
  for (const double ratio : {0.003, 0.05, 0.5}) {
    const auto back = steps_of(
        with_steps(paper_scene(32, 0.0), {{.torsion = MomentRatio{ratio}}, {.torsion = MomentRatio{0.0}}}));
    const double half = solve(paper_scene(32, 0.5 * ratio)).twist_angle;
    EXPECT_NEAR(back[1].twist_angle, back[0].twist_angle - 2.0 * half, 1e-6 * back[0].twist_angle) << ratio;
  }
}

/// What is left has to meet Coulomb's law under the load that is left.
TEST(ReturnToNothing, LetsTheNormalLoadDown) {
  for (const double load : {1.0, 1e-4}) {
    for (const Scene& scene : {punch(24), paper_scene(32, 0.0)}) {
      const auto steps = steps_of(
          with_steps(scene, {{.torsion = MomentRatio{0.4}}, {.normal = load, .torsion = MomentRatio{0.0}}}));
      EXPECT_LE(steps[1].certificate.friction_bound, kNothing);
      EXPECT_LE(std::abs(steps[1].moment), kNothing * steps[1].moment_limit);
      // Over what today's pressure could hold, not over what yesterday's did.
      EXPECT_LE(steps[1].certificate.energy,
                std::max(steps[1].elastic_energy, 2.0 * load / 1e3 * steps[0].elastic_energy));
    }
  }
}

/// A cell does not push itself aside.
TEST(ReturnToNothing, OneCellBetweenDissimilarBodiesCarriesNothing) {
  Scene scene = paper_scene(16, 0.0);
  scene.lower = {70e9, 0.2};
  scene.surfaces.front().at = {1e-4, 1e-4};
  scene.extent = {3.2e-3, 3.2e-3};
  scene.steps[0].normal = 1.0;
  const Solution solution = solve(scene);
  EXPECT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_EQ(solution.contact_cells, 1);
  EXPECT_EQ(largest(solution.traction), 0.0);
  EXPECT_EQ(solution.certificate.gap, 0.0);
}

TEST(ReturnToNothing, SlipThatIsNoneHasNoDirection) {
  const Solution stuck = solve(with_steps(punch(16), {{.force = {1.0, 0.0}}}));
  ASSERT_EQ(stuck.stick_cells, stuck.contact_cells);
  EXPECT_TRUE(std::isnan(stuck.slip_direction.mean) && std::isnan(stuck.slip_direction.max));
  EXPECT_LE(solve(paper_scene(16, 0.5)).slip_direction.max, 1e-3);
}

using Cycles = SceneFile;

/// What a step does not say stays as it was, in the second cycle too.
TEST_F(Cycles, AreTheirStepsWrittenOut) {
  const std::string scene = std::string(kShortScene) + "[[step]]\nforce = [30, 0]\nmoment_ratio = 0.4\n";
  const std::string steps = "[[step]]\nmoment_ratio = 0.1\n[[step]]\nnormal = 700\nforce = [0, 0]\n";
  const auto in_cycles = steps_of(read("cycles = 2\n" + std::string(kShortScene) + steps));
  const auto written = steps_of(read(kShortScene + steps + steps));
  ASSERT_EQ(in_cycles.size(), written.size());
  for (std::size_t k = 0; k < written.size(); ++k) {
    EXPECT_EQ(in_cycles[k].twist_angle, written[k].twist_angle);
    EXPECT_TRUE((in_cycles[k].traction == written[k].traction).all());
  }
  EXPECT_NEAR(in_cycles[2].normal_load, 700.0, 1e-6);
}

using LastDigits = SceneFile;

/// Whether a model of the scene leaves out what one without the change does, and gives the same twist.
TEST_F(LastDigits, CostNoSymmetry) {
  const Solution plain = solve(read(kShortScene));
  ASSERT_EQ(plain.left_out.size(), 5U);  // coupling, translations, the grid's rim, three quarters, one field
  for (const char* change :
       {"lower.poisson_ratio=0.30000000000000004", "upper.at=[1e-18, 0]", "load.force=[1e-300, 0]",
        "load.force=[0, -1e-13]", "upper.young_modulus=210000000000.0001"}) {
    const Solution changed = solve(read(kShortScene, {change}));
    EXPECT_NEAR(changed.twist_angle / plain.twist_angle, 1.0, 1e-10) << change;
    for (const Omission& part : plain.left_out) {
      EXPECT_THAT(changed.left_out, Contains(testing::Field(&Omission::what, part.what))) << change;
    }
  }
}

TEST_F(LastDigits, DoNotHideALoad) {
  EXPECT_NE(solve(read(kShortScene, {"load.force=[1e-7, 0]"})).force[0], 0.0);
  const auto small = solve(read(kShortScene, {"load.force=[1e-9, 0]", "load.moment_ratio=0"}));
  EXPECT_NEAR(small.force[0], 1e-9, 1e-15);
  EXPECT_TRUE(read(kShortScene, {"solver.model=full", "load.force=[1e-300, 0]"}).left_out.empty());
}

/// In numbers, where a factor of the loads would be 1.
TEST_F(LastDigits, OfALimitAreSaid) {
  const auto refused = [&](const std::string& force) {
    return complaint([&] {
      solve(read(kShortScene, {"load.moment_ratio=0", "load.force=[" + force + ", 0]"}));
    });
  };
  EXPECT_THAT(refused("100.0000001"),
              testing::AllOf(HasSubstr("[99.9999999"), testing::Not(HasSubstr("1 times"))));
  EXPECT_THAT(refused("125"), HasSubstr("0.8 times these: [1"));
}

}  // namespace
}  // namespace slipstick::solver
