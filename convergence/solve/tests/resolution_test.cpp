// What a result says of its mesh, against the exact answer.

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "convergence/oracle/oracle.hpp"
#include "convergence/results/result.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

/// An estimate tells the size of an error, not its digits.
constexpr double kSize = 2.0;

class Resolved : public testing::TestWithParam<std::string> {
 protected:
  static Json result(double moment_ratio, int cells) {
    const solver::Scene scene =
        solver::read_scene(std::string(SLIPSTICK_SCENES) + "/" + GetParam() + ".toml",
                           {"load.moment_ratio=" + std::to_string(moment_ratio),
                            "grid.cells=[" + std::to_string(cells) + "," + std::to_string(cells) + "]"});
    return solve_result(scene, solver::solve(scene), find_oracle(scene));
  }
};
INSTANTIATE_TEST_SUITE_P(Bodies, Resolved, testing::Values("paper", "cone", "rounded_punch", "flat_punch"));

TEST_P(Resolved, UncertaintyIsOfTheErrorsSizeAndLargeOnesAreWarnedOf) {
  for (const int cells : {24, 48}) {
    for (const double ratio : {0.3, 0.7, 0.95, 0.995, 0.9995, 0.99995, 0.999995}) {
      SCOPED_TRACE(testing::Message() << ratio << " of the limit, " << cells << " cells");
      const Json json = result(ratio, cells);
      const Json& resolved = json["resolved"];
      const double error = std::abs(json["twist_error"].get<double>());
      const bool warned = resolved.contains("warning");
      if (resolved["uncertainty"].is_null()) {
        EXPECT_TRUE(resolved.contains("uncertainty_reason"));
        EXPECT_TRUE(warned);
        continue;
      }
      EXPECT_LE(error, kSize * resolved["uncertainty"].get<double>());
      EXPECT_TRUE(warned || error < kSize * solver::kPoorlyResolved);
      EXPECT_FALSE(warned && ratio < 0.9);
    }
  }
}

// From the middle out along an axis and a diagonal, whose first cell is the same one.
TEST(Profile, HasTheMiddleCellOnce) {
  for (const int cells : {16, 17}) {
    const solver::Scene scene = solver::read_scene(std::string(SLIPSTICK_SCENES) + "/paper.toml",
                                                   {fmt::format("grid.cells=[{0},{0}]", cells)});
    std::vector<double> radii;
    for (const Json& row : profile_json(solver::solve(scene), find_oracle(scene)))
      radii.push_back(row["radius"]);
    ASSERT_GT(radii.size(), 5U);
    EXPECT_EQ(std::ranges::count(radii, std::ranges::min(radii)), 1) << cells;
  }
}

}  // namespace
}  // namespace slipstick::convergence
