#include "convergence/runs/shard.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "solver/input/tests/complaint.hpp"

namespace slipstick::convergence {
namespace {

TEST(Shard, IsCountedFromOne) {
  const Shard shard = read_shard("2/4");
  EXPECT_EQ(shard.index, 2U);
  EXPECT_EQ(shard.count, 4U);
  EXPECT_EQ(read_shard("1/1").count, 1U);
  for (const char* word : {"0/3", "4/3", "x", "", "1", "1/", "/3", "1/0", "-1/3", "1/3/", "1.5/3", " 1/3",
                           "1/99999999999999999999"}) {
    EXPECT_THAT(solver::complaint([&] { read_shard(word); }),
                testing::AllOf(testing::HasSubstr(std::string("--shard ") + word),
                               testing::HasSubstr("from 1/N to N/N")));
  }
}

/// Graham (1969): dealt in descending order, no part exceeds 4/3 of the largest part of the best split, which
/// is at least the mean and at least the largest cost.
TEST(Shard, CostsAreDealtEvenly) {
  const std::vector<std::vector<double>> lists{
      {}, {1.0}, {1, 4, 16, 64, 256}, {5, 5, 4, 4, 3, 3, 3}, std::vector<double>(100, 2.0)};
  for (const std::vector<double>& costs : lists) {
    for (const std::size_t count : {1U, 2U, 3U, 7U}) {
      const std::vector<std::size_t> shards = deal(costs, count);
      ASSERT_EQ(shards.size(), costs.size());
      std::vector<double> sums(count, 0.0);
      for (std::size_t i = 0; i < costs.size(); ++i) sums.at(shards[i] - 1) += costs[i];
      const double total = std::accumulate(costs.begin(), costs.end(), 0.0);
      const double largest = costs.empty() ? 0.0 : *std::ranges::max_element(costs);
      EXPECT_LE(*std::ranges::max_element(sums),
                std::max(largest, 4.0 / 3.0 * std::max(largest, total / static_cast<double>(count))));
    }
  }
}

TEST(Shard, FinerMeshesAndMoreStepsCostMore) {
  const auto cost = [](const char* scene, std::vector<std::string> overrides) {
    return predicted_cost(
        prepare_run({.scene = std::string(SLIPSTICK_SCENES) + scene, .overrides = std::move(overrides)}));
  };
  const double coarse = cost("/paper.toml", {"grid.cells=[256,256]"});
  const double fine = cost("/paper.toml", {"grid.cells=[512,512]"});
  EXPECT_GT(fine, 2.0 * coarse);
  EXPECT_GT(cost("/torsion_loop.toml", {"grid.cells=[256,256]"}), 2.0 * coarse);
  // A mesh too large for any machine has a cost too.
  EXPECT_GT(cost("/paper.toml", {"grid.cells=[60000,60000]"}), fine);
}

}  // namespace
}  // namespace slipstick::convergence
