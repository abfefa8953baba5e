#include "solver/newton/load_balance.hpp"

#include <gtest/gtest.h>

#include <random>

#include "solver/contact/limit_load.hpp"
#include "solver/newton/admissible.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXf;

/// Loads over what the field could carry at most: what LoadBalance promises.
constexpr double kMet = 1e-12;

/// A rough contact, and the rigid motions of its body: those whose loads are imposed.
struct Body {
  Body(int conditions, unsigned seed) : generator(seed) {
    bound = random(grid.cells(), -0.3, 1.0).max(0.0);
    const ArrayXd contact = (bound > 0.0).cast<double>().replicate(2, 1);
    std::array<ArrayXd, kMaxConditions> motions;
    for (Index k = 0; k < 2; ++k) {
      motions[static_cast<std::size_t>(k)].setZero(2 * grid.cells());
      motions[static_cast<std::size_t>(k)].segment(k * grid.cells(), grid.cells()).setOnes();
    }
    motions[2] = rotation_field(grid);
    for (std::size_t k = conditions == 1 ? 2 : 0; fields.size() < static_cast<std::size_t>(conditions); ++k) {
      fields.push_back(contact * motions[k]);
      as_motions.emplace_back(grid, k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0);
      moved.push_back(k);
    }
  }

  ArrayXd random(Index size, double low, double high) {
    std::uniform_real_distribution<double> uniform(low, high);
    return ArrayXd::NullaryExpr(size, [&] { return uniform(generator); });
  }

  double capacity(std::size_t k) const {
    const Index n = grid.cells();
    return (bound * (fields[k].head(n).square() + fields[k].tail(n).square()).sqrt()).sum();
  }

  /// Loads in a random direction, at a part of the most that tractions can balance in it.
  std::vector<double> loads(double part) {
    std::vector<double> result(fields.size());
    ImposedLoads imposed;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      result[k] = random(1, -1.0, 1.0)[0] * capacity(k);
      imposed[moved[k]] = result[k];
    }
    const double factor = find_limit(grid, bound, imposed).factor;
    for (double& load : result) load *= part * factor;
    return result;
  }

  std::vector<Condition> conditions(const std::vector<double>& loads) const {
    std::vector<Condition> result;
    for (std::size_t k = 0; k < fields.size(); ++k) result.push_back({&as_motions[k], loads[k]});
    return result;
  }

  /// The largest load that P(z) leaves missing, over the condition's capacity.
  double missing(const ArrayXd& z, const std::vector<double>& loads) const {
    const Index n = grid.cells();
    const ArrayXd size = (z.head(n).square() + z.tail(n).square()).sqrt();
    const ArrayXd factor = (size > bound).select(bound / size, 1.0);
    double worst = 0.0;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const double load = (fields[k] * factor.replicate(2, 1) * z).sum();
      const double part = std::abs(load - loads[k]) / capacity(k);
      worst = part <= worst ? worst : part;  // keeps NaN
    }
    return worst;
  }

  Grid grid{9, 7, 1.0, 0.8};
  std::mt19937_64 generator;
  ArrayXd bound;
  std::vector<ArrayXd> fields;
  std::vector<MotionField> as_motions;
  std::vector<std::size_t> moved;  ///< 0, 1: along x1, x2; 2: turned
};

class Balance : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Conditions, Balance, testing::Values(1, 2, 3));

/// The largest load that is missing once y is balanced from a guess x.
double missing_after(const Body& body, ArrayXd y, const std::vector<double>& loads, Coefficients x) {
  const FrictionDiscs discs(body.grid, body.bound);
  const LoadBalance balance(discs, body.conditions(loads));
  EXPECT_TRUE(balance.solve(y, x));
  balance.add(x, y);
  return body.missing(y, loads);
}

TEST_P(Balance, MeetsLoadsUpToTheirLimitAndSmallOnesToTheirOwnSize) {
  const Coefficients none = Coefficients::Zero(GetParam());
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const auto expect_met = [&](Body& body, double part, double size, double allowed) {
      const ArrayXd y = size * body.random(2 * body.grid.cells(), -1.0, 1.0);
      EXPECT_LE(missing_after(body, y, body.loads(part), none), allowed) << part << ", " << size;
    };
    Body body(GetParam(), seed);
    for (const double part : {0.0, 0.3, 0.9, 0.99, 0.999}) {
      for (const double size : {0.1, 1.0, 1e3}) expect_met(body, part, size, kMet);
    }
    Body slightly_loaded(GetParam(), seed);
    for (const double part : {1e-6, 1e-9, 1e-12}) expect_met(slightly_loaded, part, part, kMet * part);
  }
}

TEST_P(Balance, IsFoundFromFarAway) {
  std::vector<double> starts{-1e3, 1e3, 1e6};
  if (GetParam() == 1) starts.push_back(std::numeric_limits<double>::quiet_NaN());
  for (unsigned seed = 21; seed <= 26; ++seed) {
    Body body(GetParam(), seed);
    const ArrayXd y = body.random(2 * body.grid.cells(), -1.0, 1.0);
    const std::vector<double> loads = body.loads(0.8);
    for (const double far : starts) {
      const Coefficients x = far * body.random(GetParam(), -1.0, 1.0).matrix();
      EXPECT_LE(missing_after(body, y, loads, x), kMet) << far << ", seed " << seed;
    }
  }
}

/// Fields that answer a motion as elastic tractions do: in its sense, not everywhere alike.
std::vector<ArrayXf> answers(Body& body) {
  std::vector<ArrayXf> result;
  for (const ArrayXd& c : body.fields) {
    const ArrayXd factor = body.random(c.size(), 0.5, 1.5);
    result.push_back((factor * c).cast<float>());
  }
  return result;
}

/// From tractions whose loads are a hundredth of their capacity off, as after a Newton step.
TEST_P(Balance, IsMetAlongOtherFields) {
  for (unsigned seed = 31; seed <= 40; ++seed) {
    Body body(GetParam(), seed);
    const FrictionDiscs discs(body.grid, body.bound);
    const ArrayXd y = 0.8 * body.random(2 * body.grid.cells(), -1.0, 1.0);
    ArrayXd q = y;
    discs.project(q);
    std::vector<double> loads;
    for (std::size_t k = 0; k < body.fields.size(); ++k) {
      loads.push_back((body.fields[k] * q).sum() + body.random(1, -0.01, 0.01)[0] * body.capacity(k));
    }
    const std::vector<ArrayXf> w = answers(body);
    std::vector<const ArrayXf*> directions;
    for (const ArrayXf& direction : w) directions.push_back(&direction);
    const LoadBalance balance(discs, body.conditions(loads));
    Coefficients x = Coefficients::Zero(GetParam());
    ASSERT_TRUE(balance.solve_along<ArrayXf>(y, directions, x)) << "seed " << seed;
    ArrayXd z = y;
    for (std::size_t k = 0; k < w.size(); ++k) {
      z += x[static_cast<Index>(k)] * w[k].cast<double>();
    }
    EXPECT_LE(body.missing(z, loads), kMet);
  }
}

/// Where no tractions balance the loads, no x is made up; the search ends soon.
TEST_P(Balance, KnowsWhatCannotBeCarried) {
  long most = 0;
  for (unsigned seed = 41; seed <= 46; ++seed) {
    Body body(GetParam(), seed);
    const FrictionDiscs discs(body.grid, body.bound);
    const ArrayXd y = body.random(2 * body.grid.cells(), -1.0, 1.0);
    for (const double part : {1.001, 1.1, 10.0}) {
      const LoadBalance balance(discs, body.conditions(body.loads(part)));
      Coefficients x = Coefficients::Zero(GetParam());
      EXPECT_FALSE(balance.solve(y, x)) << part << ", seed " << seed;
      most = std::max(most, balance.evaluations());
    }
  }
  EXPECT_LE(most, 450);  // two searches of 200 steps, few of them tried twice
}

TEST_P(Balance, KnowsWhatIsNotANumber) {
  Body body(GetParam(), 51);
  const FrictionDiscs discs(body.grid, body.bound);
  ArrayXd y = body.random(2 * body.grid.cells(), -1.0, 1.0);
  const LoadBalance balance(discs, body.conditions(body.loads(0.5)));
  Index slipping = 0;
  body.bound.maxCoeff(&slipping);
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    y[slipping] = wrong;
    Coefficients x = Coefficients::Zero(GetParam());
    EXPECT_FALSE(balance.solve(y, x));
  }
}

TEST(BalanceOfNothing, IsMet) {
  Body body(1, 71);
  const FrictionDiscs discs(body.grid, body.bound);
  Coefficients x;
  const ArrayXd y = body.random(2 * body.grid.cells(), -1.0, 1.0);
  EXPECT_TRUE(LoadBalance(discs, {}).solve(y, x));
  const ArrayXd no_friction = ArrayXd::Zero(body.grid.cells());
  const FrictionDiscs nothing(body.grid, no_friction);
  x = Coefficients::Zero(1);
  EXPECT_TRUE(LoadBalance(nothing, body.conditions({0.0})).solve(y, x));
  EXPECT_EQ(x[0], 0.0);
}

}  // namespace
}  // namespace slipstick::solver
