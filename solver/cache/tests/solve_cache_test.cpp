#include "solver/cache/solve_cache.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <limits>
#include <map>
#include <vector>

#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

/// Scenes whose solves need the same objects and others: of one grid under other loads, with other cell
/// tractions, by other operators and methods, on the whole grid, of dissimilar bodies in turns, step by step.
std::vector<Scene> scenes_that_share() {
  const Scene paper = paper_scene(24, 0.6);
  std::vector<Scene> scenes{paper, paper_scene(24, 0.9), paper_scene(20, 0.6), ellipsoid_scene(24, 0.02, 0.01, 0.5)};
  scenes.insert(scenes.end(), 9, paper);
  scenes[4].solver.cell_traction = CellTraction::smooth;
  scenes[5].solver.op = OperatorKind::direct;
  scenes[6].solver.method = Method::paper;
  scenes[7].solver.model = ModelChoice::full;
  scenes[8].lower.poisson_ratio = 0.1;
  scenes[8].contact.coupling = Coupling::full;
  scenes[9].steps.push_back(scenes[9].steps[0]);
  scenes[9].steps[1].torsion = MomentRatio{-0.5};
  scenes[10].steps[0].normal = 700.0;
  scenes[11].solver.tolerance = 1e-12;
  scenes[12].solver.rounding_seed = 3;
  return scenes;
}

void expect_the_same(const Solution& solution, const Solution& alone) {
  EXPECT_EQ(solution.status, alone.status) << solution.message;
  EXPECT_TRUE((solution.pressure == alone.pressure).all());
  EXPECT_TRUE((solution.traction == alone.traction).all());
  EXPECT_TRUE((solution.slip == alone.slip).all());
  EXPECT_EQ(solution.twist_angle, alone.twist_angle);
  EXPECT_EQ(solution.operator_applications, alone.operator_applications);
  EXPECT_EQ(solution.pressure_applications, alone.pressure_applications);
}

/// A solve that shares tables with others has the bits and the counts of work of a solve by itself; its time
/// is no shorter than the times of its parts.
TEST(SolveCache, ChangesNoBit) {
  const std::vector<Scene> scenes = scenes_that_share();
  std::vector<Solution> alone;
  for (const Scene& scene : scenes) alone.push_back(solve(scene));
  for (const double room : {SolveCache::kDefaultBytes, 2e5}) {
    const auto cache = std::make_shared<SolveCache>(room);
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t i = 0; i < scenes.size(); ++i) {
        SCOPED_TRACE(i);
        const double saved = cache->seconds_saved();
        const Solution solution = solve(scenes[i], {.cache = cache});
        expect_the_same(solution, alone[i]);
        if (scenes[i].steps.size() > 1) continue;  // the seconds are those of the last
        EXPECT_GE(solution.seconds.total, cache->seconds_saved() - saved);
      }
    }
    EXPECT_GT(cache->seconds_saved(), 0.0);
  }
}

/// Rounded otherwise, a kernel has other bits, and so have the sines of a transform that is long enough.
TEST(SolveCache, KeepsApartWhatIsRoundedOtherwise) {
  const Scene scene = paper_scene(64, 0.6);
  const auto rounded = [&](int direction, const std::shared_ptr<SolveCache>& shared) {
    std::fesetround(direction);
    Solution solution = solve(scene, {.cache = shared});
    std::fesetround(FE_TONEAREST);
    return solution;
  };
  std::map<int, Solution> alone;  // before there is a cache, whose plans would leave their trace here too
  for (const int direction : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD}) {
    alone[direction] = rounded(direction, nullptr);
  }
  const auto cache = std::make_shared<SolveCache>();
  for (const int direction : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TONEAREST, FE_UPWARD}) {
    SCOPED_TRACE(direction);
    expect_the_same(rounded(direction, cache), alone[direction]);
  }
}

class KeptThings : public testing::Test {
 protected:
  static CacheKey key(double value) { return CacheKey("number").add(value); }
  void keep(double value) { cache_.keep(key(value), {std::make_shared<double>(value), 1.0}, kBytes); }
  bool has(double value) {
    const SolveCache::CachedObject found = cache_.take(key(value));
    if (!found.object) return false;
    EXPECT_EQ(*std::static_pointer_cast<double>(found.object), value);
    keep(value);
    return true;
  }

  static constexpr double kBytes = 1000.0;
  SolveCache cache_{2.5 * kBytes};
};

TEST_F(KeptThings, TakeNoMoreThanThereIsRoomFor) {
  keep(1.0);
  keep(2.0);
  EXPECT_TRUE(has(1.0));
  keep(3.0);
  EXPECT_FALSE(has(2.0)) << "it was not needed for longest";
  EXPECT_TRUE(has(1.0));
  EXPECT_TRUE(has(3.0));
  cache_.begin_solve(1.5 * kBytes);
  EXPECT_FALSE(has(1.0));
  EXPECT_TRUE(has(3.0));
  cache_.begin_solve(-kBytes);
  EXPECT_FALSE(has(3.0));
  cache_.begin_solve(std::numeric_limits<double>::infinity());
  keep(4.0);
  EXPECT_TRUE(has(4.0));
}

TEST_F(KeptThings, SaveTheTimeOfOtherSolvesAlone) {
  cache_.begin_solve(kBytes * 10.0);
  keep(1.0);
  EXPECT_TRUE(has(1.0));
  EXPECT_EQ(cache_.seconds_saved(), 0.0) << "it was made in this solve";
  cache_.begin_solve(kBytes * 10.0);
  EXPECT_TRUE(has(1.0));
  EXPECT_TRUE(has(1.0));
  EXPECT_EQ(cache_.seconds_saved(), 1.0);
}

}  // namespace
}  // namespace slipstick::solver
