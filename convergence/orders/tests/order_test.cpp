#include "convergence/orders/order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "convergence/orders/tests/made_sequences.hpp"

namespace slipstick::convergence {
namespace {

constexpr double kLogRounding = 1e-12;  // of logarithms of numbers to 16 digits, over changes above 0.1
using enum OrderVerdict;

OrderVerdict verdict(const Meshes& errors, double expected) { return fit_order(errors, expected).verdict; }

/// Means over `grids` grids each, with a spread that is a part of the error.
Meshes spread_over(Meshes errors, int grids, double part) {
  for (MeshSample& error : errors) error.grids = grids, error.spread = part * error.value;
  return errors;
}

void expect_found(double order, const std::vector<double>& sizes) {
  const Order found = fit_order(power(order, sizes, -0.3), order);
  EXPECT_NEAR(found.value, order, kLogRounding);
  EXPECT_NEAR(found.low, order, kLogRounding);
  EXPECT_NEAR(found.high, order, kLogRounding);
  EXPECT_NEAR(found.constant, -0.3, kLogRounding);
  EXPECT_EQ(found.verdict, asymptotic) << found.why;
}

TEST(Order, OfAPowerIsFound) {
  for (const double order : {1.0, 1.5, 2.0}) {
    expect_found(order, kHalves);
    expect_found(order, {1.0, 1.5, 3.3});
    expect_found(order, {0.01, 0.02, 0.023, 0.09});
  }
}

TEST(Order, ThatIsUncertainOnOneSideAgreesWithNothing) {
  const auto verdict_of = [](double low, double high) {
    const Order order{.value = 2.0, .low = low, .high = high, .constant = 1.0, .verdict = floor, .why = {}};
    return judged_by_interval(order, 2.0).verdict;
  };
  EXPECT_EQ(verdict_of(1.6, 2.4), asymptotic);
  EXPECT_EQ(verdict_of(1.4, 2.1), preasymptotic);
  EXPECT_EQ(verdict_of(1.9, 2.6), preasymptotic);
}

/// Least squares by hand: log errors 0, -1, -1, -2 at log sizes 0, -1, -2, -3 (base 2) lie about a line of
/// slope 0.6 with squared residuals 0.2, so that the slope's standard error is sqrt(0.2/2/5), and Student's
/// 97.5 % quantile of two degrees of freedom is 4.3026527.
TEST(Order, IntervalIsStudents) {
  const Order found = fit_order(made({1.0, 0.5, 0.5, 0.25}), 0.6);
  EXPECT_NEAR(found.value, 0.6, kLogRounding);
  const double half = 4.302652729911275 * std::sqrt(0.02);
  EXPECT_NEAR(found.low, 0.6 - half, 1e-9);
  EXPECT_NEAR(found.high, 0.6 + half, 1e-9);
}

/// Means of three grids, each mesh with the same relative spread s: all weigh alike, and the slope's standard
/// error is s/sqrt(3) over the root of the sum of squares of log size, (0.5 + 0.5) log(2)^2 ... 2 log(2)^2.
TEST(Order, KnownSpreadGivesTheInterval) {
  constexpr double spread = 0.02;
  constexpr double quantile = 2.446911851144969;  // Student's of 3 (3 - 1) degrees of freedom
  const double half = quantile * spread / std::sqrt(3.0) / (std::sqrt(2.0) * std::log(2.0));
  const Order found = fit_order(spread_over(power(1.0, {1.0, 0.5, 0.25}), 3, spread), 1.0);
  EXPECT_NEAR(found.high - found.value, half, 1e-9);
  EXPECT_NEAR(found.value - found.low, half, 1e-9);
  EXPECT_EQ(found.verdict, asymptotic);
}

/// An unknown noise is not zero: a mesh without a noise is not fitted.
TEST(Order, AMeshWithoutANoiseTakesNoPart) {
  Meshes errors = power(1.0);
  errors[1].value *= 3.0;
  errors[1].noise = std::nan("");
  const Order found = fit_order(errors, 1.0);
  EXPECT_EQ(found.sizes.size(), errors.size() - 1);
  EXPECT_NEAR(found.value, 1.0, kLogRounding);
  EXPECT_NE(found.why.find("no noise is known"), std::string::npos) << found.why;
}

/// A residual that the spread does not explain widens the interval.
TEST(Order, SpreadTooSmallForTheResidualsIsNotBelieved) {
  const Order found = fit_order(spread_over(made({1.0, 0.5, 0.5, 0.25}), 4, 1e-3), 0.6);
  EXPECT_NEAR(found.high - found.value, 4.302652729911275 * std::sqrt(0.02), 1e-6);
}

TEST(Order, NoiseWidensTheInterval) {
  Meshes errors = power(2.0);
  errors.back().noise = 0.05 * errors.back().value;
  const Order found = fit_order(errors, 2.0);
  // The finest of five halvings has 2/10 of the slope's weight, per log 2.
  EXPECT_NEAR(found.high - found.value, 0.05 * 0.2 / std::log(2.0), 1e-9);
  EXPECT_EQ(found.verdict, asymptotic);
}

/// How often the interval of drawn sequences holds the order that they were drawn with.
int covered(int grids, int repetitions, double order) {
  std::mt19937 random(1);
  int held = 0;
  for (int i = 0; i < repetitions; ++i) {
    Meshes errors;
    for (const double size : kHalves) {
      const double error = std::pow(size, order);
      errors.push_back(drawn(size, error, 0.05 * error, grids, random));
    }
    const Order found = fit_order(errors, order);
    held += found.low <= order && order <= found.high ? 1 : 0;
  }
  return held;
}

/// 95 % of 2000 draws is 1900, with a standard deviation of 10.
TEST(Order, IntervalCoversTheOrderAsOftenAsItSays) {
  constexpr int repetitions = 2000;
  for (const int grids : {1, 4, 9}) {
    const int held = covered(grids, repetitions, 1.5);
    EXPECT_GE(held, 1900 - 40) << grids;
    EXPECT_LE(held, 1900 + 60) << grids;
  }
}

TEST(Order, KnowsNoUnitsAndNoOrderOfMeshes) {
  const Meshes errors{{1.0, 0.31}, {0.5, 0.14}, {0.25, 0.078}, {0.125, 0.036}};
  const Order found = fit_order(errors, 1.0);
  Meshes other = errors;
  for (MeshSample& error : other) {
    error.size *= 1e-6;
    error.value *= -1e4;
  }
  std::ranges::reverse(other);
  std::swap(other[1], other[3]);
  const Order same = fit_order(other, 1.0);
  EXPECT_NEAR(same.value, found.value, kLogRounding);
  EXPECT_NEAR(same.low, found.low, 1e-10);
  EXPECT_NEAR(same.high, found.high, 1e-10);
  EXPECT_NEAR(same.constant / (-1e4 * found.constant * std::pow(1e6, found.value)), 1.0, 1e-10);
  EXPECT_EQ(same.verdict, found.verdict);
}

TEST(OrderVerdict, IsThatOfMadeErrors) {
  struct Case {
    Meshes errors;
    double expected;
    OrderVerdict verdict;
  };
  Meshes noisy = power(1.0, {1.0, 0.5, 0.25});
  noisy[1].noise = 0.5 * noisy[1].value;
  const double none = std::nan("");
  const std::vector<Case> cases{
      {{}, 1.0, too_few},
      {power(1.0, {1.0, 0.5}), 1.0, too_few},
      {noisy, 1.0, too_few},
      {made({1.0, 1.02, 0.95}), 1.0, oscillatory},
      {made({1.0, -0.5, 0.25, -0.125}), 1.0, oscillatory},
      {made({1.0, 0.5, 0.25, -0.125}), 1.0, oscillatory},
      {made({1.0, 0.1, 0.5, 0.05}), 1.0, oscillatory},
      {made({1.0, -0.5, 0.25, 0.125, 0.0625}), 1.0, oscillatory},
      {made({1.0, 0.5, 0.25, 0.2501, 0.25}), 1.0, floor},  // errors that stop to fall
      {made({0.5, 0.5, 0.5}), 1.0, floor},
      {made({0.0, 0.0, 0.0}), 1.0, floor},
      {made({1.0, 0.5, 0.25, 0.0}), 1.0, floor},
      {made({1.0, 0.5, 0.5}), none, floor},
      {power(2.0), 1.0, superconvergent},
      {power(76.0, {1.0, 0.9, 0.8}), 2.0, superconvergent},
      {power(1.05), 1.0, asymptotic},
      {made({1.0, 1e-3, 9e-4}), 2.0, preasymptotic},  // steps of very different heights: no order
      {spread_over(power(1.0, {1.0, 0.5, 0.25}), 2, 0.3), 1.0, preasymptotic},  // 1 +- 0.69
      {power(1.0), 2.0, preasymptotic},
      {power(-1.0), 1.0, preasymptotic},
      {power(1.0), none, preasymptotic}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Order found = fit_order(cases[i].errors, cases[i].expected);
    EXPECT_EQ(found.verdict, cases[i].verdict) << i << ": " << found.why;
    const bool no_number = cases[i].verdict == too_few || cases[i].errors.front().value == 0.0;
    EXPECT_TRUE(!no_number || std::isnan(found.value)) << i;
  }
  const Order unexpected = fit_order(power(1.0), none);
  EXPECT_NE(unexpected.why.find("no expected order"), std::string::npos) << unexpected.why;
  EXPECT_NEAR(unexpected.value, 1.0, kLogRounding);
}

TEST(OrderVerdict, NaNDoesNotCountAndIsNamed) {
  Meshes errors = power(1.0, {1.0, 0.5, 0.25});
  errors.push_back({0.125, std::nan("")});
  const Order found = fit_order(errors, 1.0);
  EXPECT_EQ(found.verdict, asymptotic);
  EXPECT_NE(found.why.find("0.125"), std::string::npos) << found.why;
  errors[0].grids = 0;
  const Order few = fit_order(errors, 1.0);
  EXPECT_EQ(few.verdict, too_few);
  EXPECT_NE(few.why.find("0.125"), std::string::npos) << few.why;
  EXPECT_NE(few.why.find("size 1"), std::string::npos) << few.why;
}

/// -h + 2 h^2 passes zero at h = 1/2: coarser meshes show the other term. Finer ones become asymptotic.
TEST(OrderVerdict, OneEarlyChangeOfSignIsLeftBehind) {
  const auto error = [](double size) { return -size + 2.0 * size * size; };
  std::vector<double> sizes{1.0, 0.8};
  for (int i = 4; i < 10; ++i) sizes.push_back(std::pow(0.5, i));
  const Order found = fit_order(made(sizes, error), 1.0);
  EXPECT_EQ(found.verdict, asymptotic) << found.why;
  EXPECT_EQ(found.sizes, std::vector<double>(sizes.begin() + 2, sizes.end()));
  EXPECT_NE(found.why.find("2 coarser"), std::string::npos) << found.why;
  EXPECT_LT(found.constant, 0.0);
}

/// A rise that the scatter explains is none.
TEST(OrderVerdict, ScatterIsNoOscillation) {
  const Meshes errors = made({1.0, 0.5, 0.51, 0.13, 0.06});
  EXPECT_EQ(verdict(errors, 1.0), oscillatory);
  const Order scattered = fit_order(spread_over(errors, 4, 0.5), 1.0);
  EXPECT_EQ(scattered.verdict, asymptotic) << scattered.why;
}

TEST(OrderVerdict, FloorOfNoise) {
  constexpr double noise = 1e-9;
  std::vector<double> sizes;
  for (int i = 0; i < 20; ++i) sizes.push_back(std::pow(0.5, i));
  int sign = 1;
  Meshes errors = made(sizes, [&](double size) { return size * size + noise * (sign = -sign); });
  for (MeshSample& error : errors) error.noise = noise;
  const Order found = fit_order(errors, 2.0);
  EXPECT_EQ(found.verdict, floor) << found.why;
  EXPECT_NEAR(found.value, 2.0, 0.01);  // of the meshes above the noise: h^2 > 1e-8, or h > 2^-13.3
  EXPECT_EQ(found.sizes.size(), 14U);
  errors.resize(10);
  EXPECT_EQ(verdict(errors, 2.0), asymptotic);
}

/// C1 h + C2 h^2: the orders of neighbouring meshes fall from 2 to 1 about size C1/C2.
TEST(OrderVerdict, TwoTermsBecomeAsymptotic) {
  const auto two_terms = [](double size) { return size + size * size; };
  const auto finer = [](double times) {
    std::vector<double> sizes = kHalves;
    for (double& size : sizes) size *= times;
    return sizes;
  };
  for (const double times : {2.0, 1.0}) {
    EXPECT_EQ(verdict(made(finer(times), two_terms), 1.0), preasymptotic) << times;
  }
  for (const double times : {0.1, 0.01}) {
    const Order found = fit_order(made(finer(times), two_terms), 1.0);
    EXPECT_EQ(found.verdict, asymptotic) << found.why;
  }
}

TEST(Order, RefusesSizesThatAreNone) {
  EXPECT_THROW(fit_order({{0.0, 1.0}}, 1.0), std::invalid_argument);
  EXPECT_THROW(fit_order({{std::nan(""), 1.0}}, 1.0), std::invalid_argument);
  EXPECT_THROW(fit_order({{1.0, 1.0}, {1.0, 2.0}}, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace slipstick::convergence
