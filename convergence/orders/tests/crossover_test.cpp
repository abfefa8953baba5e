#include "convergence/orders/crossover.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace slipstick::convergence {
namespace {

using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFitRounding = 1e-12;  // relative, of logarithms and their fits
const std::vector<double> kTimedSizes{4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128};

using TimeLaw = std::function<double(double cells)>;

Family exact_family(const TimeLaw& law, const std::vector<double>& sizes = kTimedSizes) {
  Family family;
  for (const double cells : sizes) family.push_back({cells, {law(cells)}});
  return family;
}

/// Repetitions that miss the law by normal deviates of their logarithm.
Family drawn_family(const TimeLaw& law, double scatter, int repetitions, std::mt19937& random,
                    const std::vector<double>& sizes = kTimedSizes) {
  std::normal_distribution<double> normal(0.0, scatter);
  Family family = exact_family(law, sizes);
  for (SizedSeconds& sized : family) {
    sized.seconds.clear();
    for (int i = 0; i < repetitions; ++i) {
      sized.seconds.push_back(law(sized.cells) * std::exp(normal(random)));
    }
  }
  return family;
}

/// The part of the seeded trials that hold.
double part_of(int trials, const std::function<bool()>& holds) {
  int count = 0;
  for (int i = 0; i < trials; ++i) count += holds() ? 1 : 0;
  return static_cast<double>(count) / trials;
}

double fourth(double cells) { return 2e-10 * std::pow(cells, 4); }
double square(double cells) { return 3e-8 * cells * cells; }

TEST(TypicalSeconds, HoldsTheTruthInNinetyFiveOfAHundredDraws) {
  std::mt19937 random(1);
  for (const int repetitions : {3, 5, 20}) {
    const double held = part_of(2000, [&] {
      const auto time = typical(drawn_family(square, 0.1, repetitions, random, {16}).front().seconds);
      return time.low <= square(16) && square(16) <= time.high;
    });
    EXPECT_GT(held, 0.94) << repetitions;
    EXPECT_LT(held, 0.99) << repetitions;
  }
}

TEST(TypicalSeconds, IsTheMedianOfValidTimes) {
  EXPECT_DOUBLE_EQ(typical({3.0, 1.0, 2.0}).seconds, 2.0);
  EXPECT_NEAR(typical({1.0, 4.0}).seconds, 2.0, kFitRounding);  // of the logarithms
  EXPECT_DOUBLE_EQ(typical({2.0}).seconds, 2.0);
  EXPECT_TRUE(std::isnan(typical({2.0}).low));  // one repetition has no interval
  EXPECT_DOUBLE_EQ(typical({kNaN, 2.0, -1.0, 2.0, 0.0, kInfinity, 2.0}).seconds, 2.0);
  for (const std::vector<double>& none : {std::vector<double>{}, {kNaN, 0.0}})
    EXPECT_TRUE(std::isnan(typical(none).seconds));
}

TEST(Crossover, OfPowersIsWhereTheyMeet) {
  const Crossover found = find_crossover(exact_family(fourth), exact_family(square));
  EXPECT_NEAR(found.cells, std::sqrt(3e-8 / 2e-10), 1e-9);
  EXPECT_TRUE(std::isnan(found.low));
  EXPECT_THAT(found.remark, HasSubstr("one repetition"));
}

TEST(Crossover, IsTheLastOfSeveral) {
  const TimeLaw slow = [](double n) { return n == 8 ? 2.0 : n > 48 ? 2.0 : 0.5; };
  const Crossover found = find_crossover(exact_family(slow), exact_family([](double) { return 1.0; }));
  EXPECT_NEAR(found.cells, std::sqrt(48.0 * 64.0), 1e-9);
}

TEST(Crossover, UsesTheSizesThatBothHave) {
  Family quick = exact_family(square, {2, 4, 8, 32, 256});
  quick[2].seconds = {kNaN};
  const Crossover found = find_crossover(exact_family(fourth), quick);
  EXPECT_NEAR(found.cells, std::sqrt(3e-8 / 2e-10), 1e-9);  // between 4 and 32: powers are straight
  EXPECT_THAT(find_crossover(exact_family(fourth, {4}), exact_family(square, {8})).remark,
              HasSubstr("no size"));
}

TEST(Crossover, OutsideTheMeasuredSizesIsAnAnswer) {
  const Crossover already =
      find_crossover(exact_family(fourth, {16, 32, 64}), exact_family(square, {16, 32, 64}));
  EXPECT_TRUE(std::isnan(already.cells));
  EXPECT_THAT(already.remark, HasSubstr("already at 16 cells"));
  const Crossover not_yet = find_crossover(exact_family(fourth, {4, 8}), exact_family(square, {4, 8}));
  EXPECT_TRUE(std::isnan(not_yet.cells));
  EXPECT_THAT(not_yet.remark, HasSubstr("not yet at 8 cells"));
}

TEST(Crossover, HoldsTheTruthInNinetyFiveOfAHundredDraws) {
  std::mt19937 random(4);
  const double truth = std::sqrt(3e-8 / 2e-10);
  const std::vector<double> sizes{8, 12, 16, 24};
  for (const int repetitions : {5, 15}) {
    const double held = part_of(200, [&] {
      const Crossover found = find_crossover(drawn_family(fourth, 0.1, repetitions, random, sizes),
                                             drawn_family(square, 0.1, repetitions, random, sizes));
      return found.low <= truth && truth <= found.high;
    });
    EXPECT_GT(held, 0.93) << repetitions;
    EXPECT_LT(held, 0.999) << repetitions;
  }
}

}  // namespace
}  // namespace slipstick::convergence
