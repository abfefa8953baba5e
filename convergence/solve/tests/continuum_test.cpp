#include "convergence/solve/continuum.hpp"

#include <gmock/gmock.h>

#include <cmath>

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
      const double width = (found.twist_high - found.twist_low) / twist;
      EXPECT_LT(found.twist_low, twist);
      EXPECT_GT(found.twist_high, twist);
      EXPECT_LT(width, 0.7 * before);
      before = width;
    }
  }
}

TEST(ContinuumInterval, IsMirroredWithTheMoment) {
  const Scene scene = paper_scene(32, 0.5);
  const Scene back = paper_scene(32, -0.5);
  const ContinuumRecord one = continuum_record(scene, solve(scene));
  const ContinuumRecord other = continuum_record(back, solve(back));
  EXPECT_NEAR(other.twist_high, -one.twist_low, 1e-9 * one.twist_high);
  EXPECT_NEAR(other.twist_low, -one.twist_high, 1e-9 * one.twist_high);
}

TEST(ContinuumInterval, IsMissingWithItsReason) {
  Scene scene = paper_scene(32, 0.9999);
  EXPECT_TRUE(std::isnan(continuum_record(scene, solve(scene)).twist_high));
  scene.steps.front().torsion = Twist{1e-4};
  const ContinuumRecord imposed = continuum_record(scene, solve(scene));
  EXPECT_TRUE(std::isnan(imposed.twist_low));
  EXPECT_FALSE(imposed.twist_low.why_missing.empty());
  EXPECT_GT(imposed.gap, 0.0);
}

}  // namespace
}  // namespace slipstick::convergence
