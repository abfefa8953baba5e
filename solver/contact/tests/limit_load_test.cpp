#include "solver/contact/limit_load.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "solver/contact/tangential_problem.hpp"
#include "solver/tests/limits.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// The factor is a least value, so that what Newton's method leaves in the motion counts to second order;
/// sums of some thousands of cells round by less.
constexpr double kRelative = 1e-12;
/// The motion, its centre and the resultants depend on the root of the error of the least value, 5e-8,
/// times the contact's condition.
constexpr double kMotion = 2e-7;

struct LimitContact {
  Grid grid;
  ArrayXd bound;

  double sum() const { return bound.sum(); }
  LimitLoad limit(const ImposedLoads& loads) const { return find_limit(grid, bound, loads); }
  double moment() const { return free_moment_limit(grid, bound); }
  double& operator()(Index i, Index j) { return bound[i * grid.n2 + j]; }
};

LimitContact empty(Index n1, Index n2, double h1 = 0.25, double h2 = 0.25) {
  return {{n1, n2, h1, h2}, ArrayXd::Zero(n1 * n2)};
}

LimitContact hertz_disc(Index n) {
  LimitContact disc = empty(n, n, 2.0 / static_cast<double>(n), 2.0 / static_cast<double>(n));
  const ArrayXd r_square = cell_x1(disc.grid).square() + cell_x2(disc.grid).square();
  disc.bound = (1.0 - r_square).max(0.0).sqrt();
  return disc;
}

LimitContact ring(Index n) {
  LimitContact ring = hertz_disc(n);
  ring.bound = (ring.bound > 0.0 && ring.bound < 0.5).cast<double>();
  return ring;
}

/// No symmetry, a third of the cells in contact, and optionally one cell much stronger than the others.
LimitContact rough(unsigned seed, double strongest = 1.0) {
  LimitContact contact = empty(11, 8, 0.2, 0.3);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  for (double& bound : contact.bound) {
    if (uniform(random) < 0.35) bound = uniform(random);
  }
  contact(9, 6) = strongest;
  return contact;
}

void expect_relative(double value, double expected, double tolerance = kRelative) {
  EXPECT_NEAR(value, expected, tolerance * std::abs(expected));
}

void expect_centre(const LimitLoad& limit, double c1, double c2, double tolerance = kMotion) {
  ASSERT_TRUE(limit.centre.has_value());
  EXPECT_NEAR((*limit.centre)[0], c1, tolerance);
  EXPECT_NEAR((*limit.centre)[1], c2, tolerance);
}

TEST(LimitMoment, OfASymmetricContactIsTheOneAboutItsCentre) {
  for (const LimitContact& contact : {hertz_disc(24), hertz_disc(25), ring(24), ring(25)}) {
    expect_relative(contact.moment(), moment_limit(contact.grid, contact.bound));
    expect_centre(contact.limit({0.0, 0.0, 1.0}), 0.0, 0.0);
  }
}

TEST(LimitMoment, OfAStrongAndAWeakCellTurnsAboutTheStrongOne) {
  for (const double weak : {0.5, 1e-3, 1e-12}) {
    LimitContact pair = empty(7, 5);
    pair(6, 4) = 1.0;
    pair(0, 1) = weak;
    expect_relative(pair.moment(), weak * std::hypot(6 * 0.25, 3 * 0.25));
    expect_centre(pair.limit({0.0, 0.0, 1.0}), pair.grid.x1(6), pair.grid.x2(4));
  }
}

// Along the line friction has no curvature, only kinks, and here two neighbours that both are medians.
TEST(LimitMoment, OfManyCellsOnALineIsTheOneAboutTheirMedian) {
  for (const Index n : {16, 128, 512}) {
    LimitContact line = empty(n, 2);
    for (Index i = 0; i < n; i += 2) line(i, 1) = static_cast<double>(i + 1);
    const ArrayXd x1 = cell_x1(line.grid);
    double least = kInfinity;
    for (const double centre : x1) least = std::min(least, (line.bound * (x1 - centre).abs()).sum());
    expect_relative(line.moment(), least);
  }
}

TEST(LimitMoment, OfThreeEqualCellsTurnsAboutFermatsPoint) {
  // An equilateral triangle of side 2: the distances from the middle add up to sqrt(3) times the side.
  const double root3 = std::numbers::sqrt3;
  LimitContact triangle = empty(3, 2, 1.0, root3);
  triangle(0, 0) = triangle(2, 0) = triangle(1, 1) = 1.0;
  expect_relative(triangle.moment(), 2.0 * root3);
  expect_centre(triangle.limit({0.0, 0.0, 1.0}), 0.0, triangle.grid.x2(0) + root3 / 3.0);
  // An angle above 120 degrees: Fermat's point is the cell at its apex.
  triangle.grid.h2 = 0.5;
  expect_relative(triangle.moment(), 2.0 * std::hypot(1.0, 0.5));
  expect_centre(triangle.limit({0.0, 0.0, 1.0}), 0.0, triangle.grid.x2(1));
}

TEST(LimitMoment, AboutAnImposedCentreIsTheSumAboutIt) {
  const LimitContact contact = rough(5);
  const LimitLoad limit = contact.limit({std::nullopt, std::nullopt, 1.0});
  expect_relative(limit.factor, moment_limit(contact.grid, contact.bound));
  EXPECT_EQ(limit.sliding.delta1, 0.0);
  EXPECT_EQ(limit.sliding.delta2, 0.0);
}

TEST(LimitForce, IsAllOfTheFrictionThroughTheCentreOfASymmetricContact) {
  for (const LimitContact& contact : {hertz_disc(24), hertz_disc(25), ring(25)}) {
    const LimitLoad limit = contact.limit({0.3, -0.4, 0.0});
    expect_relative(limit.factor, contact.sum() / 0.5);
    EXPECT_FALSE(limit.centre.has_value());
  }
}

/// Duality: the friction in any motion in which the loads do unit work is at least any factor of the loads
/// that admissible tractions balance. Both are `factor` here, so it is the limit. The cell about which the
/// body turns has no direction: it carries any rest within its bound.
TEST(LimitLoad, IsTheFrictionInItsSlidingAndBalancedByTractions) {
  for (const double strongest : {0.5, 2.0, 20.0}) {  // the last: turning about that cell
    for (unsigned seed = 0; seed < 20; ++seed) {
      const LimitContact contact = rough(seed, strongest);
      const ArrayXd x1 = cell_x1(contact.grid), x2 = cell_x2(contact.grid);
      for (const ImposedLoads& loads :
           {ImposedLoads{0.0, 0.0, 1.0}, ImposedLoads{0.3, -0.2, 1.0}, ImposedLoads{1.0, std::nullopt, 0.1},
            ImposedLoads{1.0, 1.0, 0.0}, ImposedLoads{std::nullopt, 0.0, 1.0}, ImposedLoads{0.3, -0.4, std::nullopt}}) {
        SCOPED_TRACE(testing::Message() << seed << ' ' << strongest);
        const LimitLoad limit = contact.limit(loads);
        EXPECT_LE(limit.carried, limit.factor);
        EXPECT_GE(limit.carried, (1.0 - kRelative) * limit.factor);
        const auto& [delta1, delta2, twist] = limit.sliding;
        const ArrayXd v1 = delta1 - twist * x2, v2 = delta2 + twist * x1;
        const ArrayXd speed = (v1.square() + v2.square()).sqrt();
        expect_relative(limit.factor, (contact.bound * speed).sum());
        const ArrayXd q = (speed > 1e-3 * speed.maxCoeff()).select(contact.bound / speed, ArrayXd::Zero(speed.size()));
        const ArrayXd open = (q == 0.0).select(contact.bound, 0.0);
        const ArrayXd arm = (x1.square() + x2.square()).sqrt();
        const std::array motion{delta1, delta2, twist};
        const std::array carried{(q * v1).sum(), (q * v2).sum(), (q * (x1 * v2 - x2 * v1)).sum()};
        const std::array rest{open.sum(), open.sum(), (open * arm).sum()};
        double work = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
          if (!loads[k]) {
            EXPECT_EQ(motion[k], 0.0);
            continue;
          }
          work += *loads[k] * motion[k];
          EXPECT_NEAR(carried[k], limit.factor * *loads[k], rest[k] + kMotion * contact.sum());
        }
        EXPECT_NEAR(work, 1.0, kRelative);
      }
    }
  }
}

TEST(LimitLoad, ScalesWithLoadsFrictionAndLength) {
  const LimitContact contact = rough(10);
  const double factor = contact.limit({0.3, -0.2, 1.0}).factor;
  expect_relative(contact.limit({-3.0, 2.0, -10.0}).factor, factor / 10.0);
  LimitContact other = contact;
  other.bound *= 7e5;
  expect_relative(other.limit({0.3, -0.2, 1.0}).factor, 7e5 * factor);
  other = contact;
  other.grid.h1 *= 1e-6;
  other.grid.h2 *= 1e-6;
  const LimitLoad limit = other.limit({0.3, -0.2, 1e-6});
  expect_relative(limit.factor, factor);
  expect_relative(limit.carried, factor);
}

TEST(LimitLoad, OfNoLoadIsInfinite) {
  const LimitContact contact = rough(13);
  for (const ImposedLoads& loads : {ImposedLoads{0.0, 0.0, 0.0}, ImposedLoads{std::nullopt, 0.0, 0.0},
                                    ImposedLoads{std::nullopt, std::nullopt, std::nullopt}}) {
    EXPECT_EQ(contact.limit(loads).factor, kInfinity);
    EXPECT_EQ(contact.limit(loads).carried, kInfinity);
  }
}

TEST(LimitLoad, OfOneCellIsItsForceAndNoMoment) {
  LimitContact cell = empty(6, 5);
  cell(1, 3) = 2.0;
  const double x1 = cell.grid.x1(1), x2 = cell.grid.x2(3);
  EXPECT_NEAR(cell.moment(), 0.0, kRelative * 2.0);
  const LimitLoad through = cell.limit({0.3, 0.4, 0.4 * x1 - 0.3 * x2});
  expect_relative(through.factor, 2.0 / 0.5);
  expect_relative(through.carried, 2.0 / 0.5);
  EXPECT_NEAR(cell.limit({0.3, 0.4, 0.0}).factor, 0.0, kRelative * 2.0);
}

TEST(LimitLoad, WithoutFrictionIsZero) {
  const LimitContact contact = empty(6, 5);
  EXPECT_EQ(contact.limit({0.3, 0.4, 1.0}).factor, 0.0);
  EXPECT_EQ(contact.moment(), 0.0);
}

TEST(LimitLoad, RefusesWhatIsNoFrictionBoundAndNoLoad) {
  const LimitContact contact = rough(14);
  for (const double bad : {kNaN, kInfinity, -1.0}) {
    LimitContact other = contact;
    other(2, 2) = bad;
    EXPECT_THROW(other.limit({0.0, 0.0, 1.0}), std::invalid_argument);
  }
  EXPECT_THROW(contact.limit({0.0, kNaN, 1.0}), std::invalid_argument);
  EXPECT_THROW(contact.limit({0.0, 0.0, kInfinity}), std::invalid_argument);
  EXPECT_THROW(find_limit(contact.grid, contact.bound.head(5), {0.0, 0.0, 1.0}), std::invalid_argument);
  Grid quadrant = contact.grid;
  quadrant.quadrant = true;
  EXPECT_THROW(find_limit(quadrant, contact.bound, {0.0, 0.0, 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace slipstick::solver
