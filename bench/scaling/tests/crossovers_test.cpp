#include "bench/scaling/crossovers.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace slipstick::bench {
namespace {

using convergence::Json;

/// dense 1e-9 N^4, dcfft 64 times 1e-9 N^2: they meet at 8 cells.
TEST(Crossovers, SayWhereDcfftOvertakes) {
  Json seconds{{"application/dense", Json::array()}, {"application/dcfft", Json::array()}};
  for (const double cells : {4.0, 6.0, 12.0, 24.0, 48.0}) {
    const auto add = [&](const char* name, double time) {
      seconds[name].push_back({cells, {time, 1.01 * time, 0.99 * time}});
    };
    add("application/dense", 1e-9 * std::pow(cells, 4));
    add("application/dcfft", 64e-9 * cells * cells);
  }
  const Json found = crossovers(seconds);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0]["slow"], "application/dense");
  EXPECT_EQ(found[0]["quick"], "application/dcfft");
  EXPECT_NEAR(found[0]["cells"], 8.0, 1e-9);
  EXPECT_LT(found[0]["low"], 8.0);
  EXPECT_GT(found[0]["high"], 8.0);
  EXPECT_THAT(crossovers_text(found),
              testing::HasSubstr("application/dcfft is quicker than application/dense from 8 cells a side"));
}

}  // namespace
}  // namespace slipstick::bench
