// The envelope of made ways, whose quickest and dominated ones are known.

#include "bench/plane/envelope.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using slipstick::bench::dominated_choices;
using slipstick::bench::pareto_front;
using slipstick::bench::quickest_to;
using slipstick::bench::Way;
using testing::ElementsAre;
using testing::IsEmpty;

Way way(double seconds, double error) {
  return {.choice = {}, .seconds = seconds, .low = seconds, .high = seconds, .error = error};
}

/// Times known to 10 %.
Way way_by(const std::string& method, double cells, double seconds, double error) {
  return {.choice = {{"method", method}, {"tolerance", "1e-08"}},
          .cells = cells,
          .seconds = seconds,
          .low = 0.9 * seconds,
          .high = 1.1 * seconds,
          .error = error};
}

TEST(ParetoFront, HoldsTheWaysThatNoneBeats) {
  EXPECT_THAT(pareto_front({way(3.0, 0.1), way(1.0, 0.5), way(2.0, 0.5), way(4.0, 0.2)}), ElementsAre(1, 0));
  EXPECT_THAT(pareto_front({way(1.0, 1.0)}), ElementsAre(0));
  EXPECT_THAT(pareto_front({}), IsEmpty());
  EXPECT_THAT(pareto_front({way(1.0, 0.5), way(1.0, 0.5)}), ElementsAre(0, 1));  // both of a tie
  EXPECT_THAT(pareto_front({way(2.0, 0.5), way(1.0, 0.5), way(1.0, 0.6)}), ElementsAre(1));
  EXPECT_THAT(pareto_front({way(1.0, NAN), way(NAN, 0.1), way(2.0, 0.5), way(0.1, INFINITY)}),
              ElementsAre(2));
}

TEST(QuickestTo, IsTheQuickestOfThoseAsGood) {
  const std::vector<Way> ways{way(3.0, 1e-3), way(2.0, 1e-2), way(1.0, 1e-1), way(0.1, NAN)};
  EXPECT_EQ(quickest_to(ways, 1e-2), 1U);
  EXPECT_EQ(quickest_to(ways, 5e-3), 0U);
  EXPECT_EQ(quickest_to(ways, 1.0), 2U);
  EXPECT_EQ(quickest_to(ways, 1e-4), std::nullopt);
}

TEST(DominatedChoices, NameWhatIsSurelySlowerAndByWhat) {
  const std::vector<Way> ways{way_by("good", 64, 1.0, 0.1), way_by("good", 128, 4.0, 0.02),
                              way_by("bad", 64, 3.0, 0.1), way_by("bad", 128, 20.0, 0.02)};
  const auto found = dominated_choices(ways);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].key, "method");
  EXPECT_EQ(found[0].word, "bad");
  EXPECT_EQ(found[0].by, "good");
  EXPECT_TRUE(found[0].everywhere);
  EXPECT_EQ(found[0].from_cells, 64.0);
  EXPECT_DOUBLE_EQ(found[0].least, 3.0);
  EXPECT_DOUBLE_EQ(found[0].most, 5.0);
}

TEST(DominatedChoices, AreNotThoseThatMayBeAsQuickOrAreBetterOrNotTimed) {
  Way untimed = way_by("untimed", 64, NAN, 0.01);
  untimed.low = untimed.high = NAN;
  for (const Way& other : {way_by("other", 64, 1.15, 0.1), way_by("other", 64, 10.0, 0.05), untimed})
    EXPECT_THAT(dominated_choices({way_by("one", 64, 1.0, 0.1), other}), IsEmpty());
}

TEST(DominatedChoices, SayFromWhichMeshOn) {
  const std::vector<Way> ways{way_by("fft", 16, 1.0, 0.3),  way_by("fft", 32, 2.0, 0.1),
                              way_by("fft", 64, 4.0, 0.03), way_by("sum", 16, 0.5, 0.3),
                              way_by("sum", 32, 16.0, 0.1), way_by("sum", 64, 256.0, 0.03)};
  const auto found = dominated_choices(ways);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].word, "sum");
  EXPECT_FALSE(found[0].everywhere);
  EXPECT_EQ(found[0].from_cells, 32.0);
  EXPECT_EQ(found[0].ways, 2U);
}

TEST(DominatedChoices, CompareOnlyWhatDiffersInThatKey) {
  Way full = way_by("coulomb", 64, 3.0, 0.1);
  full.choice["model"] = "full";
  Way other = way_by("paper", 64, 1.0, 0.1);
  other.choice["model"] = "auto";
  EXPECT_THAT(dominated_choices({full, other}), IsEmpty());
  Way rival = way_by("coulomb", 32, 1.0, 0.1);
  rival.choice["model"] = "auto";
  rival.choice["tolerance"] = "1e-04";  // free, as the mesh is
  const auto found = dominated_choices({full, other, rival});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].word, "full");
}

}  // namespace
