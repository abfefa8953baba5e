#include "solver/newton/admissible.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXf;
using Eigen::Matrix2d;
using Eigen::MatrixXd;

constexpr double kRounding = 1e-13;
constexpr double kSinglePrecision = 5e-7;
const Grid kGrid{8, 5, 1.0, 1.0};
constexpr Index kCells = 40;
constexpr std::array<double, 2> kMeans{1.7, 0.9};
constexpr double kRho = 0.3;

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double value() { return std::uniform_real_distribution<double>(-1.0, 1.0)(generator_); }
  ArrayXd field(Index size) {
    return ArrayXd::NullaryExpr(size, [this] { return value(); });
  }
  /// Some cells without friction among bounds up to 1.
  ArrayXd bounds(Index cells) {
    ArrayXd bound = field(cells);
    return (bound > -0.6).select(bound.abs() + 0.01, 0.0);
  }
  /// 1 where the bodies can touch.
  ArrayXd reachable(Index cells) { return (field(cells) > -0.5).cast<double>(); }
  /// Symmetric, positive definite.
  MatrixXd stiffness(Index size) {
    const MatrixXd factor = MatrixXd::NullaryExpr(size, size, [this] { return value(); });
    return factor * factor.transpose() / static_cast<double>(size) + 0.1 * MatrixXd::Identity(size, size);
  }

 private:
  std::mt19937_64 generator_;
};

/// Zero outside the contact cells, which a projection may skip.
template <class Set>
ArrayXd projected(const Set& set, const ArrayXd& field) {
  ArrayXd inside = ArrayXd::Zero(field.size());
  set.sweep().each([&](Index first, Index last) {
    for (Index start = first; start < field.size(); start += set.cells())
      inside.segment(start, last - first) = field.segment(start, last - first);
  });
  set.project(inside);
  return inside;
}

template <class Set>
constexpr Index size_of() {
  return Set::kComponents * kCells;
}

double energy(const MatrixXd& K, const ArrayXd& g, const ArrayXd& q) {
  return 0.5 * q.matrix().dot(K * q.matrix()) + (g * q).sum();
}

ArrayXd displacement(const MatrixXd& K, const ArrayXd& g, const ArrayXd& q) { return (K * q.matrix()).array() + g; }

/// The point with a given c.q on the segment between two fields; a convex set contains it with its ends.
ArrayXd with_load(const ArrayXd& below, const ArrayXd& above, const ArrayXd& c, double load) {
  const double low = (below * c).sum();
  const double high = (above * c).sum();
  EXPECT_TRUE(low <= load && load <= high) << low << ' ' << load << ' ' << high;
  return below + (load - low) / (high - low) * (above - below);
}

// --- both sets: projection, load along a line, gap ---

template <class Set>
class Admissible : public testing::Test {
 protected:
  /// Bounds, or which cells can be reached.
  static ArrayXd shape(unsigned seed) {
    Random random(seed);
    return Set::kComponents == 2 ? random.bounds(kCells) : random.reachable(kCells);
  }
  /// Made without the projection; every other cell is on its set's edge, or far out.
  static ArrayXd random_admissible(const ArrayXd& shape, Random& random) {
    ArrayXd q(size_of<Set>());
    for (Index i = 0; i < kCells; ++i) {
      const double part = std::min(2.0 * std::abs(random.value()), 1.0);
      const double angle = 4.0 * random.value();
      q[i] = Set::kComponents == 2 ? shape[i] * part * std::cos(angle) : shape[i] * 2.0 * (1.0 - part);
      if (Set::kComponents == 2) q[i + kCells] = shape[i] * part * std::sin(angle);
    }
    return q;
  }
  static ArrayXd extreme(const Set& set, const ArrayXd& c, double length) { return projected(set, length * c); }
};
using Sets = testing::Types<PositivePressures, FrictionDiscs>;

struct SetNames {
  template <class Set>
  static std::string GetName(int) {
    return Set::kComponents == 2 ? "FrictionDiscs" : "PositivePressures";
  }
};
TYPED_TEST_SUITE(Admissible, Sets, SetNames);

/// The projection p of z onto a convex set is the point with (z - p).(q - p) <= 0 for all q in it.
TYPED_TEST(Admissible, ProjectionIsTheNearestPoint) {
  const ArrayXd shape = this->shape(1);
  const TypeParam set(shape);
  Random random(2);
  const ArrayXd z = 2.0 * random.field(size_of<TypeParam>());
  const ArrayXd p = projected(set, z);
  for (int i = 0; i < 200; ++i) {
    const ArrayXd q = this->random_admissible(shape, random);
    const ArrayXd towards = (z - p) * (q - p);
    for (Index cell = 0; cell < kCells; ++cell) {
      EXPECT_LE(towards[cell] + (TypeParam::kComponents == 2 ? towards[cell + kCells] : 0.0), kRounding);
    }
  }
}

const MotionField kMotion(kGrid, 0.5, -2.0, 1.5);

/// As fields that are kept: exact in single precision too.
ArrayXd kept(Index size) {
  ArrayXd field(size);
  for (Index start = 0; start < size; start += kGrid.n2) {
    field.segment(start, kGrid.n2) = kMotion.segment(start, kGrid.n2);
  }
  return field;
}

template <typename Set, typename Direction>
LoadsAlong<1> along(const Set& set, const ArrayXd& y, const Direction& direction, double x) {
  return set.template loads_along<1, Direction>(y, {&direction}, Eigen::Vector<double, 1>(x), {&kMotion});
}

TYPED_TEST(Admissible, LoadAlongALineIsThatOfItsProjection) {
  const ArrayXd shape = this->shape(5);
  const TypeParam set(kGrid, shape);
  Random random(6);
  const ArrayXd y = random.field(size_of<TypeParam>());
  const ArrayXf single = random.field(size_of<TypeParam>()).template cast<float>();
  const ArrayXd direction = single.template cast<double>();
  const ArrayXd c = kept(size_of<TypeParam>());
  const auto load = [&](double x) { return (c * projected(set, ArrayXd(y + x * direction))).sum(); };
  for (const double x : {-3.0, -0.41, 0.0, 0.77, 5.0}) {
    const LoadsAlong<1> at = along(set, y, single, x);
    EXPECT_NEAR(at.load[0], load(x), kRounding * c.abs().maxCoeff());
    // A cell that changes its state within the step would show as half its part of the slope.
    constexpr double step = 1e-6;
    EXPECT_NEAR(at.slope(0, 0), (load(x + step) - load(x - step)) / (2.0 * step), 1e-8 * c.abs().maxCoeff());
  }
}

TYPED_TEST(Admissible, LoadAlongAMotionIsThatAlongItsField) {
  const ArrayXd shape = this->shape(7);
  const TypeParam set(kGrid, shape);
  Random random(8);
  const ArrayXd y = random.field(size_of<TypeParam>());
  const ArrayXf field = kept(size_of<TypeParam>()).template cast<float>();
  const LoadsAlong<1> motion = along(set, y, kMotion, 0.3);
  const LoadsAlong<1> kept_motion = along(set, y, field, 0.3);
  const double largest = kRounding * kept(size_of<TypeParam>()).square().sum();
  EXPECT_NEAR(motion.load[0], kept_motion.load[0], largest);
  EXPECT_NEAR(motion.slope(0, 0), kept_motion.slope(0, 0), largest);
}

/// Whatever the multiplier, the gap is at least what the energy can fall by under the same load, and positive.
TYPED_TEST(Admissible, GapBoundsWhatTheEnergyCanFallBy) {
  const ArrayXd shape = this->shape(9);
  const TypeParam set(shape);
  Random random(10);
  const Index size = size_of<TypeParam>();
  const MatrixXd K = random.stiffness(size);
  const ArrayXd g = random.field(size);
  // The load of pressures weighs all cells that can be reached alike.
  const ArrayXd c = TypeParam::kComponents == 1 ? shape : random.field(size);
  const ArrayXd above = this->extreme(set, c, 100.0);
  const ArrayXd below = this->extreme(set, c, -100.0);
  for (int i = 0; i < 30; ++i) {
    const ArrayXd q = this->random_admissible(shape, random);
    const double gap = set.gap(q, displacement(K, g, q) - random.value() * c);
    EXPECT_GT(gap, 0.0);  // random fields violate Coulomb's law
    for (int j = 0; j < 30; ++j) {
      const ArrayXd other = this->random_admissible(shape, random);
      const double load = (q * c).sum();
      const ArrayXd same_load =
          (other * c).sum() < load ? with_load(other, above, c, load) : with_load(below, other, c, load);
      EXPECT_GE(gap, energy(K, g, q) - energy(K, g, same_load) - kRounding);
    }
  }
}

TYPED_TEST(Admissible, GapIsNotANumberWhereADisplacementIsNone) {
  const ArrayXd shape = ArrayXd::Ones(kCells);
  const TypeParam set(shape);
  Random random(11);
  const ArrayXd q = this->random_admissible(shape, random);
  for (const Index cell : {Index{0}, Index{17}, kCells - 1}) {
    ArrayXd u = random.field(size_of<TypeParam>());
    u[cell] = std::nan("");
    EXPECT_TRUE(std::isnan(set.gap(q, u))) << cell;
  }
}

// --- the gap of hand-made states ---

TEST(FrictionGap, VanishesExactlyUnderCoulombsLaw) {
  // Sticks within its bound; slips against its traction, twice; carries nothing where there is no pressure;
  // sticks at its bound.
  const ArrayXd bound{{1.0, 5.0, 13.0, 0.0, 5.0}};
  const ArrayXd q{{0.3, -3.0, 5.0, 0.0, 3.0, -0.4, -4.0, -12.0, 0.0, 4.0}};
  const ArrayXd slip{{0.0, 6.0, -10.0, 7.0, 0.0, 0.0, 8.0, 24.0, -2.0, 0.0}};
  const FrictionDiscs set(bound);
  const auto gap = [&](const ArrayXd& traction) { return set.gap(traction, slip); };
  EXPECT_EQ(gap(q), 0.0);
  // Each way to break it costs what theory says, s.q + mu p |s|.
  ArrayXd turned = q;
  turned[1] = 3.0;  // against s = (6, 8): 18 - 32 + 5*10
  EXPECT_DOUBLE_EQ(gap(turned), 36.0);
  ArrayXd weak = q;
  weak[2] = weak[7] = 0.0;  // no traction on a slip of 26
  EXPECT_DOUBLE_EQ(gap(weak), 13.0 * 26.0);
}

TEST(PressureGap, VanishesExactlyWhereOnlyTheClosestCellsPress) {
  const ArrayXd reachable{{1.0, 1.0, 0.0, 1.0, 1.0}};
  ArrayXd p{{2.0, 3.0, 0.0, 0.0, 0.0}};
  const ArrayXd opening{{0.5, 0.5, -9.0, 0.5, 0.75}};  // the lowest cannot be reached
  const PositivePressures set(reachable);
  EXPECT_EQ(set.gap(p, opening), 0.0);
  p[4] = 2.0;
  EXPECT_DOUBLE_EQ(set.gap(p, opening), 0.5);
}

// --- the linearised natural map ---

Matrix2d projector(const TangentSpace& space, Index cell) {
  const auto [a11, a21] = space.projected(cell, 1.0, 0.0);
  const auto [a12, a22] = space.projected(cell, 0.0, 1.0);
  return (Matrix2d() << a11, a12, a21, a22).finished();
}

/// d P(z)/dz in one cell.
Matrix2d jacobian(const FrictionDiscs& set, const ArrayXd& z, Index cell) {
  constexpr double step = 1e-6;
  Matrix2d result;
  for (const Index c : {0, 1}) {
    ArrayXd shift = ArrayXd::Zero(z.size());
    shift[cell + c * set.cells()] = step;
    const ArrayXd slope = (projected(set, ArrayXd(z + shift)) - projected(set, ArrayXd(z - shift))) / (2.0 * step);
    result.col(c) << slope[cell], slope[cell + set.cells()];
  }
  return result;
}

/// d = P'(z)(d - rho K d) on the tangent space is (K + stiffness) d with P'(z) = projector/(1 + rho stiffness).
TEST(FrictionLinearised, IsTheDerivativeOfTheProjection) {
  Random random(13);
  const ArrayXd bound = random.bounds(kCells);
  const FrictionDiscs set(bound);
  const ArrayXd z = 0.6 * random.field(2 * kCells);
  TangentSpace space(2, kCells);
  set.linearise(z, kRho, kMeans, space);
  Index slipping = 0;
  Index sticking = 0;
  for (Index i = 0; i < kCells; ++i) {
    if (bound[i] == 0.0) continue;
    const Matrix2d expected = jacobian(set, z, i) * (1.0 + kRho * space.stiffness[i]);
    EXPECT_LE((projector(space, i) - expected).cwiseAbs().maxCoeff(),
              1e-8 + kSinglePrecision * kRho * space.stiffness[i])
        << i;
    EXPECT_GE(space.stiffness[i], 0.0);
    slipping += space.stiffness[i] > 0.0;
    sticking += projector(space, i) == Matrix2d::Identity();
  }
  EXPECT_GT(slipping, 5);
  EXPECT_GT(sticking, 5);
}

/// The two terms of the preconditioner together are 1/(1/xi + stiffness) at the mean along the line and at a
/// twelfth of it.
TEST(FrictionLinearised, PreconditionerMatchesTheSymbolTwice) {
  Random random(14);
  const ArrayXd bound = random.bounds(kCells);
  TangentSpace space(2, kCells);
  FrictionDiscs(bound).linearise(2.0 * random.field(2 * kCells), kRho, kMeans, space);
  for (Index i = 0; i < kCells; ++i) {
    if (bound[i] == 0.0) continue;
    const double mean = space.f1[i] * space.f1[i] * kMeans[0] + space.f2[i] * space.f2[i] * kMeans[1];
    const double scale = space.scale[i];
    const double shift = space.shift[i];
    for (const double xi : {mean, mean / 12.0}) {
      if (!space.on_line(i)) {
        EXPECT_EQ(scale * scale * xi + shift, xi);
      } else {
        const double expected = 1.0 / (1.0 / xi + space.stiffness[i]);
        EXPECT_NEAR(scale * scale * xi + shift, expected, kSinglePrecision * expected);
      }
    }
  }
}

TEST(FrictionLinearised, CountsTheCellsThatChange) {
  const ArrayXd bound{{1.0, 1.0, 1.0, 0.0}};
  const FrictionDiscs set(bound);
  TangentSpace space(2, 4);
  ArrayXd z = ArrayXd::Zero(8);
  set.linearise(z, kRho, kMeans, space);
  EXPECT_EQ(set.linearise(z, kRho, kMeans, space), 0);
  z[0] = z[5] = 2.0;
  EXPECT_EQ(set.linearise(z, kRho, kMeans, space), 2);
  z[0] = -3.0;  // slips still
  EXPECT_EQ(set.linearise(z, kRho, kMeans, space), 0);
  z[0] = 0.5;
  z[3] = 7.0;  // without a bound there is no state to change
  EXPECT_EQ(set.linearise(z, kRho, kMeans, space), 1);
  z[3] = 0.0;
  EXPECT_EQ(set.linearise(z, kRho, kMeans, space), 0);
}

TEST(PressuresLinearised, AreFreeInContact) {
  const ArrayXd reachable{{1.0, 1.0, 1.0, 0.0}};
  ArrayXd z{{2.0, -1.0, 0.0, 3.0}};
  const PositivePressures set(reachable);
  TangentSpace space(1, 4);
  for (Index i = 0; i < 4; ++i) space.set(i, false);
  EXPECT_EQ(set.linearise(z, kRho, kMeans, space), 1);
  EXPECT_TRUE((space.f1 == (ArrayXd(4) << 1.0, 0.0, 0.0, 0.0).finished()).all());
  z << -2.0, 1.0, 0.5, 3.0;
  EXPECT_EQ(set.linearise(z, kRho, kMeans, space), 3);
  EXPECT_EQ(set.linearise(z, kRho, kMeans, space), 0);
}

/// After the jump, and nothing but it, each cell lies on the face on which z was projected: the tangent to
/// its circle at P(z); or at zero pressure. The way along the face is left to the linear problem.
TEST(Jump, PutsTractionsOnTheTangentThatTheNaturalMapChose) {
  Random random(15);
  const ArrayXd bound = random.bounds(kCells);
  const FrictionDiscs set(bound);
  const ArrayXd q = projected(set, random.field(2 * kCells));
  const ArrayXd z = 0.6 * random.field(2 * kCells);
  const ArrayXd target = projected(set, z);
  const ArrayXd before = random.field(2 * kCells);
  ArrayXd step = before;
  set.add_jump(z, q, step);
  for (Index i = 0; i < kCells; ++i) {
    const Eigen::Vector2d jump(step[i] - before[i], step[i + kCells] - before[i + kCells]);
    const Eigen::Vector2d at_z(z[i], z[i + kCells]);
    const Eigen::Vector2d from(q[i], q[i + kCells]);
    const Eigen::Vector2d to(target[i], target[i + kCells]);
    if (at_z.norm() <= bound[i]) {
      EXPECT_EQ(jump.norm(), 0.0) << "sticks: every traction is on the face";
      continue;
    }
    EXPECT_NEAR((from + jump - to).dot(at_z), 0.0, kRounding);
    EXPECT_NEAR(jump.x() * at_z.y() - jump.y() * at_z.x(), 0.0, kRounding) << "along the normal only";
  }
}

TEST(Jump, EndsPressureWhereContactEnds) {
  const ArrayXd reachable{{1.0, 1.0, 1.0, 0.0}};
  const ArrayXd p{{2.0, 3.0, 0.0, 0.0}};
  const ArrayXd z{{1.0, -1.0, -2.0, 5.0}};
  ArrayXd step = ArrayXd::Constant(4, 0.25);
  step[1] = step[2] = step[3] = 0.0;  // the linear problem does not move what is not free
  PositivePressures(reachable).add_jump(z, p, step);
  EXPECT_TRUE((p + step == (ArrayXd(4) << 2.25, 0.0, 0.0, 0.0).finished()).all());
}

}  // namespace
}  // namespace slipstick::solver
