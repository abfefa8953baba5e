#include "convergence/runs/path_uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>

#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::convergence {
namespace {

using namespace solver;

class PathOfLoads : public SceneFile {
 protected:
  Solution solved(const std::string& steps, const std::vector<std::string>& overrides = {}) const {
    std::vector<std::string> keys{"grid.cells=[24,24]", "load.moment_ratio=0"};
    keys.insert(keys.end(), overrides.begin(), overrides.end());
    return solve_with_path(read(kShortScene + steps, keys));
  }
  /// A push, and a twist that is written out in so many steps.
  static std::string push_and_twist(int steps) {
    std::string text = "[[step]]\nforce = [50, 0]\n";
    for (int k = 1; k <= steps; ++k) {
      text += "[[step]]\nmoment_ratio = " + std::to_string(0.5 * k / steps) + "\n";
    }
    return text;
  }
};

// Slip under a push lies along it; the twist that follows turns it.
TEST_F(PathOfLoads, WhatFewPartsLeaveOpenIsStatedWhereSlipTurns) {
  const Solution one = solved(push_and_twist(1));
  const Solution many = solved(push_and_twist(32));
  const double off = std::abs(one.twist_angle - many.twist_angle);
  EXPECT_GT(off, 0.005 * many.twist_angle);
  EXPECT_GT(one.resolution.path.twist, off);
  EXPECT_LT(one.resolution.path.twist, 4.0 * off);
  EXPECT_GE(one.resolution.absolute, one.resolution.path.twist);
  const double shift = std::abs(one.displacement[0] - many.displacement[0]);
  EXPECT_GT(one.resolution.path.displacement, shift);
  // It falls like one over the number of parts, once there are many.
  EXPECT_LT(solved(push_and_twist(1), {"solver.substeps=32"}).resolution.path.twist, 0.2 * one.resolution.path.twist);
}

TEST_F(PathOfLoads, ATwistOfASurfaceOfRevolutionHasNoPath) {
  const std::string loop = "[[step]]\nmoment_ratio = 0.9\n[[step]]\nmoment_ratio = -0.4\n";
  EXPECT_EQ(solved(loop).resolution.path.twist, 0.0);
  EXPECT_GT(solved(loop, {"contact.coupling=\"pressure\"", "lower.young_modulus=70e9"}).resolution.path.twist, 0.0);
}

// An ellipse's error falls like 1/n. Its extrapolated twist is that of four times as many parts, extrapolated
// on its own mesh, within what is stated; one that is not extrapolated is further off.
TEST_F(PathOfLoads, AnEllipseIsCorrectedToTheTwistOfManyParts) {
  const auto ellipse = [&](int parts) {
    Scene scene = paper_scene(40, 0.85);
    Surface& upper = scene.surfaces.front();
    upper.shape = Shape::ellipsoid;
    upper.radius_1 = 2.0 * upper.radius;
    upper.radius_2 = upper.radius;
    scene.solver.substeps = parts;
    return std::pair(scene, solve(scene));
  };
  const auto [scene, few] = ellipse(8);
  const double fine = ellipse(32).second.twist_angle;
  const double finer = ellipse(64).second.twist_angle;
  const double limit = 2.0 * finer - fine;
  const std::optional<PathCorrection> found = path_correction(scene, few);
  ASSERT_TRUE(found);
  const double off = few.twist_angle * (1.0 + found->change) - limit;
  EXPECT_LE(std::abs(off), found->uncertainty * limit);
  EXPECT_LT(found->uncertainty * limit, std::abs(few.twist_angle - limit));
  EXPECT_NEAR((few.twist_angle - limit) / (fine - limit), 4.0, 1.5);
  EXPECT_FALSE(path_correction(ellipse(2).first, few));
}

// Their gaps add up to that of one cone.
TEST_F(PathOfLoads, ATwistOfConesOnOneAxisHasNoPath) {
  const auto path = [&](const std::string& at) {
    const std::string cone = "[[upper.shape]]\nshape = \"cone\"\nslope = 0.005\n";
    const std::string text = with_surface("", cone + cone + "at = " + at + "\n");
    return solve_with_path(read(text, {"grid.cells=[24,24]", "grid.extent=[2e-3,2e-3]"})).resolution.path.twist;
  };
  EXPECT_EQ(path("[0.0, 0.0]"), 0.0);
  EXPECT_GT(path("[2e-4, 0.0]"), 0.0);
}

TEST_F(PathOfLoads, OnAFrictionMapIsStatedBetweenTheTrueErrorAndTenTimesIt) {
  Scene scene = paper_scene(37, 0.6);
  scene.grid.cells = {37, 31};
  scene.contact.friction.map =
      write("map.csv", table_of(37, 31, [](int i, int j) { return 0.4 + 0.05 * ((7 * i + 3 * j) % 17); }));
  scene.steps.assign(2, scene.steps.front());
  scene.steps[0].torsion = MomentRatio{0.0};
  scene.steps[0].force = scene.steps[1].force = {40.0, 10.0};
  const Solution few = solve_with_path(scene);
  scene.solver.substeps = 32;
  const Solution many = solve_with_path(scene);
  const double off = std::abs(few.twist_angle - many.twist_angle);
  EXPECT_GT(off, 1e-3 * many.twist_angle);
  EXPECT_GT(few.resolution.path.twist, off);
  EXPECT_LT(few.resolution.path.twist, 10.0 * off);
}

}  // namespace
}  // namespace slipstick::convergence
