// The envelope of made ways, whose quickest ones are known.

#include "bench/plane/envelope.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using slipstick::bench::pareto_front;
using slipstick::bench::quickest_to;
using slipstick::bench::Way;
using namespace testing;

TEST(ParetoFront, HoldsTheWaysThatNoneBeats) {
  EXPECT_THAT(pareto_front({Way{3.0, 0.1}, Way{1.0, 0.5}, Way{2.0, 0.5}, Way{4.0, 0.2}}), ElementsAre(1, 0));
  EXPECT_THAT(pareto_front({Way{1.0, 1.0}}), ElementsAre(0));
  EXPECT_THAT(pareto_front({}), IsEmpty());
  EXPECT_THAT(pareto_front({Way{1.0, 0.5}, Way{1.0, 0.5}}), ElementsAre(0, 1));  // both of a tie
  EXPECT_THAT(pareto_front({Way{2.0, 0.5}, Way{1.0, 0.5}, Way{1.0, 0.6}}), ElementsAre(1));
  EXPECT_THAT(pareto_front({Way{1.0, NAN}, Way{NAN, 0.1}, Way{2.0, 0.5}, Way{0.1, INFINITY}}),
              ElementsAre(2));
}

TEST(QuickestTo, IsTheQuickestOfThoseAsGood) {
  const std::vector<Way> ways{Way{3.0, 1e-3}, Way{2.0, 1e-2}, Way{1.0, 1e-1}, Way{0.1, NAN}};
  EXPECT_EQ(quickest_to(ways, 1e-2), 1U);
  EXPECT_EQ(quickest_to(ways, 5e-3), 0U);
  EXPECT_EQ(quickest_to(ways, 1.0), 2U);
  EXPECT_EQ(quickest_to(ways, 1e-4), std::nullopt);
}

}  // namespace
