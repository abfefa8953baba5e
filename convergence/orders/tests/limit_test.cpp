#include "convergence/orders/limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "convergence/orders/expected_order.hpp"
#include "convergence/orders/tests/made_sequences.hpp"

namespace slipstick::convergence {
namespace {

using enum OrderVerdict;

constexpr double kLimit = 2.0;
constexpr double kFactor = -0.3;
constexpr double kRounding = 1e-11;  // of differences of numbers near 2, over the least change, above 1e-3

Meshes values(double order, const std::vector<double>& sizes = kHalves) { return power(order, sizes, kFactor, kLimit); }

void expect_found(const Limit& found, double order, double finest, double factor) {
  EXPECT_NEAR(found.value, kLimit, kRounding);
  EXPECT_NEAR(found.uncertainty, factor * std::abs(finest - kLimit), 10.0 * kRounding);
  EXPECT_NEAR(found.order.value, order, 100.0 * kRounding);
  EXPECT_NEAR(found.order.constant, kFactor, 100.0 * kRounding);
  EXPECT_EQ(found.order.verdict, asymptotic) << found.order.why;
}

/// Also where a script in wide use finds 1.33 for a true order of 1.
TEST(Limit, OfAPowerIsFound) {
  const std::vector<double> unequal{3.3, 1.5, 1.0};
  for (const double order : {0.6, 1.0, 1.5, 1.9}) {
    expect_found(richardson_limit(values(order), order), order, values(order).back().value, 1.25);
    expect_found(richardson_limit(values(order, unequal), order), order, kLimit + kFactor, 1.25);
    expect_found(least_squares_limit(values(order), order), order, values(order).back().value, 1.25);
  }
  EXPECT_NEAR(richardson_limit(values(1.0, unequal), 1.0).order.value, 1.0, 1e-14);
}

/// Orders that the method does not trust: the safety factor is 3, about the finest value's distance from the limit.
TEST(Limit, HighOrdersAreMistrusted) {
  expect_found(richardson_limit(values(2.5, {1.0, 0.5, 0.25}), 2.5), 2.5, kLimit + kFactor * std::pow(2, -5), 3.0);
  const Limit found = least_squares_limit(values(4.0), 2.0);
  EXPECT_EQ(found.order.verdict, superconvergent);
  EXPECT_EQ(found.method.find("h^2,"), found.method.find("h^")) << found.method;  // no term of order 4
  EXPECT_LE(std::abs(found.value - kLimit), found.uncertainty);
}

/// In h^0.2 the method falls back on fixed terms, whose uncertainty must reach the limit.
TEST(Limit, LowOrdersFallBackOnFixedTerms) {
  const Limit found = least_squares_limit(values(0.2), 1.0);
  EXPECT_NEAR(found.order.value, 0.2, 1e-9);
  EXPECT_EQ(found.order.verdict, preasymptotic);
  EXPECT_NE(found.method.find("given"), std::string::npos) << found.method;
  const Limit three = richardson_limit(values(0.2), 1.0);
  EXPECT_EQ(three.value, values(0.2).back().value);
  EXPECT_EQ(three.method, "finest mesh");
  EXPECT_TRUE(std::isnan(found.order.constant));  // of a power that led elsewhere
  EXPECT_TRUE(std::isnan(three.order.constant));
}

/// Both error terms are among the fallbacks, which are exact for them. The logarithmic slope of the errors is
/// steeper at the fine end than at the coarse end, as for an order below 0.5.
TEST(Limit, BothTermsTogetherAreFitted) {
  const Meshes meshes = made(kHalves, [](double h) { return kLimit + h - 0.55 * h * h; });
  const Limit found = least_squares_limit(meshes, 1.0);
  EXPECT_LT(found.order.value, 0.5);
  EXPECT_NEAR(found.value, kLimit, kRounding);
  const double error = meshes.back().value - kLimit;
  EXPECT_NEAR(found.uncertainty, 3.0 * error, 100.0 * kRounding);
}

/// Numbers of an independent evaluation of the method (numpy's lstsq, the order by a dense
/// scan of a range): the fit weighted by 1/h has the smaller deviation and an order of 1.006 with a standard
/// error of 0.0832, whose Student's quantile of two degrees of freedom is 4.3027.
TEST(Limit, OfScatteredValuesIsTheMethods) {
  const Limit found = least_squares_limit(made({1.0, 0.52, 0.23, 0.131, 0.06}), 1.0);
  constexpr double independent = 1e-6;  // of the order there
  EXPECT_NEAR(found.value, -0.0008703462, independent);
  EXPECT_NEAR(found.uncertainty, 0.0930964906, independent);
  EXPECT_NEAR(found.order.value, 1.0062819334, independent);
  EXPECT_NEAR(found.order.high - found.order.value, 4.3026527 * 0.0831620245, independent);
  EXPECT_EQ(found.order.verdict, asymptotic) << found.order.why;
}

/// The same evaluation, of values that follow no order: h and h^2 together fit best, with a deviation, 0.204,
/// above the mean change, 0.2.
TEST(Limit, OfValuesThatJumpIsUncertain) {
  const Limit found = least_squares_limit(made({0.4, 1.0, 0.9, 0.2, 0.3}), 1.0);
  EXPECT_EQ(found.order.verdict, oscillatory);
  EXPECT_NEAR(found.value, -0.0215686275, 1e-9);
  EXPECT_NEAR(found.uncertainty, 1.6105315820, 1e-9);
}

TEST(Limit, NoiseOfTheFinestMeshAddsToTheUncertainty) {
  Meshes meshes = values(1.0);
  const double without = least_squares_limit(meshes, 1.0).uncertainty;
  meshes.back().noise = 1e-5;
  EXPECT_NEAR(least_squares_limit(meshes, 1.0).uncertainty, without + 1e-5, kRounding);
}

TEST(Limit, OfValuesWithoutAnOrderIsTheFinest) {
  struct Case {
    Limit (*limit)(const Meshes&, double);
    std::vector<double> values;
    OrderVerdict verdict;
    double uncertainty;
  };
  for (const auto& [limit, values, verdict, uncertainty] :
       {Case{richardson_limit, {1.0, 1.02, 0.95}, oscillatory, 3.0 * 0.07},
        Case{least_squares_limit, {1.0, 1.02, 0.95}, oscillatory, 3.0 * 0.07},
        Case{richardson_limit, {1.0, 0.5, 0.5}, floor, 1.5},
        Case{least_squares_limit, {0.5, 0.5, 0.5, 0.5}, floor, 0.0},
        Case{richardson_limit, {1.0, 0.95}, too_few, 3.0 * 0.05}}) {
    const Limit found = limit(made(values), 1.0);
    EXPECT_EQ(found.order.verdict, verdict);
    EXPECT_EQ(found.value, values.back());
    EXPECT_NEAR(found.uncertainty, uncertainty, 1e-15);
    EXPECT_TRUE(verdict != oscillatory || std::isnan(found.order.value));
  }
  const Limit one = least_squares_limit(made({1.0}), 1.0);
  EXPECT_EQ(one.value, 1.0);
  EXPECT_TRUE(std::isnan(one.uncertainty));
  EXPECT_TRUE(std::isnan(least_squares_limit({}, 1.0).value));
}

TEST(Limit, NoiseIsAFloor) {
  constexpr double noise = 1e-9;
  Meshes meshes = values(2.0, {1.0, 0.5, 0.25, 1e-2, 1e-3});
  for (MeshSample& mesh : meshes) mesh.noise = noise;
  meshes.back().value += noise;
  const Limit found = least_squares_limit(meshes, 2.0);
  EXPECT_EQ(found.order.verdict, asymptotic) << found.order.why;
  meshes.push_back({9e-4, meshes.back().value - 2 * noise, 0.0, 1, noise});
  EXPECT_EQ(least_squares_limit(meshes, 2.0).order.verdict, floor);
  EXPECT_EQ(richardson_limit(meshes, 2.0).order.verdict, floor);
  for (const std::size_t noisy : {2U, 3U}) {  // one of the finest two
    Meshes one = values(2.0, {1.0, 0.5, 0.25, 0.125});
    one[noisy].noise = 0.2 * std::abs(one[3].value - one[2].value);
    EXPECT_EQ(least_squares_limit(one, 2.0).order.verdict, floor) << noisy;
    EXPECT_EQ(richardson_limit(one, 2.0).order.verdict, floor) << noisy;
  }
}

TEST(Limit, KnowsNoUnitsAndNoOrderOfMeshes) {
  Meshes meshes = made({1.0, 0.52, 0.23, 0.131, 0.06});
  Meshes other = meshes;
  for (MeshSample& mesh : other) {
    mesh.size *= 1e-6;
    mesh.value *= -1e-4;
  }
  std::ranges::reverse(other);
  for (const auto& limit : {least_squares_limit, richardson_limit}) {
    const Limit found = limit(meshes, 1.0);
    const Limit same = limit(other, 1.0);
    EXPECT_NEAR(same.value / (-1e-4 * found.value), 1.0, 1e-6);
    EXPECT_NEAR(same.uncertainty / (1e-4 * found.uncertainty), 1.0, 1e-6);
    EXPECT_NEAR(same.order.value, found.order.value, 1e-7);
    EXPECT_NEAR(same.order.low, found.order.low, 1e-6);
    EXPECT_EQ(same.order.verdict, found.order.verdict);
  }
}

/// Linearised: p = log2((a - b)/(b - c)) and, by Aitken, limit = (a c - b^2)/(a - 2 b + c).
TEST(Limit, NoiseOfThreeValuesOpensOrderAndLimit) {
  constexpr double noise = 1e-6;
  Meshes meshes = values(1.0, {1.0, 0.5, 0.25});
  for (MeshSample& mesh : meshes) mesh.noise = noise;
  const double first = 1.0 / 0.15;
  const double second = 1.0 / 0.075;
  const double half = noise * std::hypot(first, first + second, second) / std::log(2.0);
  const Limit found = richardson_limit(meshes, 1.0);
  EXPECT_NEAR(found.order.high - 1.0, half, 1e-4 * half);
  EXPECT_NEAR(1.0 - found.order.low, half, 1e-4 * half);
  const double bend = meshes[0].value - 2.0 * meshes[1].value + meshes[2].value;
  const double doubt = noise / std::abs(bend) *
                       std::hypot(meshes[2].value - kLimit, 2.0 * (kLimit - meshes[1].value), meshes[0].value - kLimit);
  EXPECT_NEAR(found.uncertainty, 1.25 * 0.075 + doubt, 1e-4 * doubt);
}

/// How often drawn sequences have their limit within its uncertainty, and their order in its interval.
struct Held {
  int limits = 0;
  int orders = 0;
};

Held held(Limit (*limit)(const Meshes&, double), double order, int grids, int repetitions) {
  std::mt19937 random(2);
  Held count;
  for (int i = 0; i < repetitions; ++i) {
    Meshes meshes;
    for (const double size : {1.0, 0.7, 0.5, 0.35, 0.25, 0.18}) {
      meshes.push_back(drawn(size, kLimit + kFactor * std::pow(size, order), 1e-3, grids, random));
    }
    const Limit found = limit(meshes, order);
    count.limits += std::abs(found.value - kLimit) <= found.uncertainty ? 1 : 0;
    count.orders += found.order.low <= order && order <= found.order.high ? 1 : 0;
  }
  return count;
}

TEST(Limit, LiesWithinItsUncertainty) {
  constexpr int repetitions = 200;
  for (const double order : {1.0, 1.5, 2.0}) {
    const Held squares = held(least_squares_limit, order, 1, repetitions);
    EXPECT_GE(squares.limits, 0.95 * repetitions) << order;
    EXPECT_GE(squares.orders, 0.91 * repetitions) << order;  // 0.95 less 2.6 standard deviations of the count
    EXPECT_GE(held(richardson_limit, order, 5, repetitions).limits, 0.95 * repetitions) << order;
  }
}

/// C1 h + C2 h^2 fitted by one power misses the limit by less than the stated uncertainty.
TEST(Limit, OfTwoTermsLiesWithinItsUncertainty) {
  for (const double finest : {0.25, 0.01}) {
    const std::vector<double> sizes{8 * finest, 4 * finest, 2 * finest, finest};
    const Meshes meshes = made(sizes, [](double h) { return kLimit + h + h * h; });
    for (const Limit& found : {least_squares_limit(meshes, 1.0), richardson_limit(meshes, 1.0)}) {
      EXPECT_LE(std::abs(found.value - kLimit), found.uncertainty) << finest;
      EXPECT_EQ(found.order.verdict, finest < 0.05 ? asymptotic : preasymptotic) << found.order.why;
    }
  }
}

/// Sums of the powers that edges and corners leave, where the corner's power may be another than the one that
/// is taken (shear tractions have another than pressures).
TEST(Limit, OfKnownPowersLiesWithinItsUncertainty) {
  constexpr int repetitions = 500;
  std::mt19937 random(3);
  std::normal_distribution<double> factor;
  std::uniform_real_distribution<double> doubled_alpha(0.5, 0.9);
  int held = 0;
  for (int i = 0; i < repetitions; ++i) {
    const double corner = doubled_alpha(random);
    std::vector<std::pair<double, double>> terms;
    for (const double power : {1.0, 1.0 + corner, 2.0, 2.0 + corner, 3.0, 4.0}) {
      terms.emplace_back(power, factor(random));
    }
    std::vector<double> sizes;
    for (const double cells : {24, 32, 48, 64, 96, 128, 192}) sizes.push_back(2.0 / cells);
    const Limit found = expansion_limit(made(sizes,
                                             [&](double h) {
                                               double sum = kLimit;
                                               for (const auto& [power, by] : terms) sum += by * std::pow(h, power);
                                               return sum;
                                             }),
                                        aligned_edge_powers(), 1.0);
    held += std::abs(found.value - kLimit) <= found.uncertainty ? 1 : 0;
    EXPECT_LE(found.uncertainty, 1e-4);
  }
  EXPECT_GE(held, 0.985 * repetitions);
}

TEST(Limit, OfFewKnownPowersIsTheirs) {
  const auto two = [](double h) { return kLimit + h - h * h; };
  const Limit found = expansion_limit(made({1.0, 0.6, 0.5, 0.3}, two), {1.0, 2.0}, 1.0);
  EXPECT_NEAR(found.value, kLimit, kRounding);
  Meshes noisy = made({1.0, 0.6, 0.5, 0.3}, two);
  for (MeshSample& mesh : noisy) mesh.noise = 1e-3;
  EXPECT_GT(expansion_limit(noisy, {1.0, 2.0}, 1.0).uncertainty, found.uncertainty + 1e-3)
      << "weights of extrapolation enlarge noise";
  EXPECT_EQ(expansion_limit(made({1.0, 0.5}), {1.0, 2.0}, 1.0).order.verdict, too_few);
}

}  // namespace
}  // namespace slipstick::convergence
