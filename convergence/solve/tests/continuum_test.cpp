#include "convergence/solve/continuum.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "solver/solve.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::convergence {
namespace {

using namespace solver;

// The exact twist lies in the interval, whose width falls like the root of the gap, with the mesh.
TEST(ContinuumInterval, HoldsTheExactTwistOfThePaper) {
  for (const auto& [moment_ratio, twist] : paper::kTwists) {
    double before = 1.0;
    for (const Index cells : {32, 64, 128}) {
      const Scene scene = paper_scene(cells, moment_ratio);
      const ContinuumRecord found = continuum_record(scene, solve(scene));
      const double width = (found.high - found.low) / twist;
      EXPECT_LT(found.low, twist);
      EXPECT_GT(found.high, twist);
      EXPECT_LT(width, 0.7 * before);
      before = width;
    }
  }
}

/// The interval holds the number on cells a quarter as long, whose own error is far smaller than the interval.
void expect_held(Scene scene, const char* name) {
  const ContinuumRecord found = continuum_record(scene, solve(scene));
  for (Index& cells : scene.grid.cells) cells *= 4;
  const Solution fine = solve(scene);
  const double number = found.number == "twist_angle" ? fine.twist_angle
                        : found.number == "moment"    ? fine.moment
                        : found.number == "force"     ? std::hypot(fine.force[0], fine.force[1])
                                                      : std::hypot(fine.displacement[0], fine.displacement[1]);
  EXPECT_LT(found.low, number) << name;
  EXPECT_GT(found.high, number) << name;
  EXPECT_LT(found.high - found.low, 0.3 * number) << name;
}

TEST(ContinuumInterval, HoldsTheTwistOfOtherScenes) {
  Scene ellipse = ellipsoid_scene(32, 0.04, 0.018, 0.8);
  expect_held(ellipse, "ellipse");
  ellipse.steps.front().force = {40.0, 20.0};
  expect_held(ellipse, "with a force");
  Scene tresca = paper_scene(32, 0.6);
  tresca.contact.friction.kind = FrictionKind::tresca;
  tresca.contact.friction.shear_strength = 1e8;
  expect_held(tresca, "Tresca");
}

TEST(ContinuumInterval, HoldsTheNumberThatTheLoadsLeaveOpen) {
  Scene scene = paper_scene(32, 0.0);
  scene.steps.front().torsion = Twist{1e-3};
  expect_held(scene, "moment of a twist");
  scene.steps.front().force = {20.0, 0.0};
  expect_held(scene, "moment of a twist, with a force");
  scene = paper_scene(32, 0.0);
  scene.steps.front().force = {30.0, -40.0};
  expect_held(scene, "displacement");
  scene.steps.front().force = {};
  scene.steps.front().displacement = {0.2e-6, 0.1e-6};
  expect_held(scene, "force of a displacement");
}

// Under an imposed displacement the force falls as the moment rises: a part of the energy's change is the
// work of that displacement.
TEST(ContinuumInterval, HoldsTheTwistUnderAnImposedDisplacement) {
  Scene scene = paper_scene(64, 0.0);
  scene.steps.front().torsion = Moment{0.8 * paper::kMomentLimit};
  scene.steps.front().displacement = {0.4e-6, 0.0};
  expect_held(scene, "displacement");
}

// A stated uncertainty that does not reach from the twist into the interval is too small for certain.
TEST(ContinuumInterval, IsReachedByTheStatedUncertainty) {
  std::mt19937 random(12);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int known = 0;
  for (int k = 0; k < 12; ++k) {
    const double radius = between(0.005, 0.03);
    Scene scene =
        ellipsoid_scene(2 * static_cast<Index>(between(8, 20)), radius * between(1, 3), radius, between(0.05, 0.9));
    scene.lower.poisson_ratio = scene.upper.poisson_ratio = between(0.0, 0.49);
    const Solution solution = solve(scene);
    const ContinuumRecord found = continuum_record(scene, solution);
    if (std::isnan(found.low + found.high)) continue;
    ++known;
    EXPECT_LE(found.low - solution.twist_angle, solution.resolution.absolute) << k;
    EXPECT_LE(solution.twist_angle - found.high, solution.resolution.absolute) << k;
  }
  EXPECT_GT(known, 8);
}

TEST(ContinuumInterval, IsMirroredWithTheMoment) {
  const Scene scene = paper_scene(32, 0.5);
  const Scene back = paper_scene(32, -0.5);
  const ContinuumRecord one = continuum_record(scene, solve(scene));
  const ContinuumRecord other = continuum_record(back, solve(back));
  EXPECT_NEAR(other.high, -one.low, 1e-9 * one.high);
  EXPECT_NEAR(other.low, -one.high, 1e-9 * one.high);
}

TEST(ContinuumInterval, IsMissingWithItsReason) {
  Scene scene = paper_scene(32, 0.9999);
  EXPECT_TRUE(std::isnan(continuum_record(scene, solve(scene)).high));
  scene.steps.front().torsion = Moment{0.0};
  const ContinuumRecord free = continuum_record(scene, solve(scene));
  EXPECT_TRUE(std::isnan(free.low));
  EXPECT_FALSE(free.low.why_missing.empty());
  scene = paper_scene(16, 0.5);
  Solution broken = solve(scene);
  broken.traction.setConstant(NAN);
  const ContinuumRecord none = continuum_record(scene, broken);
  EXPECT_TRUE(std::isnan(none.gap) && std::isnan(none.low) && std::isnan(none.high));
}

ProvenAnswer proven(const Scene& scene, double width) {
  return solve_until_proven(scene, width, [](const Scene& chosen) { return solve_scene(chosen); });
}

TEST(Proven, TakesCellsUntilTheIntervalIsNarrow) {
  const ProvenAnswer answer = proven(paper_scene(32, 0.5), 0.02);
  const ContinuumRecord& found = *answer.solved.record.end.certificate.continuum;
  const double twist = paper::kTwists[1].twist;
  EXPECT_LT(found.low, twist);
  EXPECT_GT(found.high, twist);
  EXPECT_LT(found.high - found.low, 0.02 * twist);
  EXPECT_FALSE(answer.account.contains("not_reached"));
  EXPECT_GT(answer.account["attempts"].size(), 1U);
  EXPECT_EQ(answer.account["attempts"].back()["cells"][0], answer.solved.solution.grid.n1);
}

TEST(Proven, KeepsTheLastAnswerWhereTheNextCannotBeHad) {
  Scene scene = paper_scene(32, 0.5);
  scene.solver.memory_limit = 40e6;
  const ProvenAnswer answer = proven(scene, 1e-4);
  EXPECT_TRUE(answer.account.contains("not_reached"));
  EXPECT_GT(answer.solved.solution.twist_angle, 0.0);
  scene.steps.push_back(scene.steps.front());
  EXPECT_EQ(proven(scene, 1e-4).account["not_reached"], "the contact has a history of loads");
}

}  // namespace
}  // namespace slipstick::convergence
