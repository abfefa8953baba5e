#include "solver/contact/stick_front.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include "solver/tests/limits.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using namespace testing;

/// An ellipse of stick, and of contact `ring` times as large about the same centre, where the slip is
/// d^(3/2) (1 + d/2) in directions that turn, d = sqrt((x/a)^2 + (y/b)^2) - 1.
struct MadeUp {
  double a = 0.5;
  double b = 0.5;
  double turned = 0.0;
  double x0 = 0.0;
  double y0 = 0.0;
  double ring = 1.6;

  double radius() const { return std::sqrt(a * b); }
  /// 1 on the ellipse.
  double level(double x1, double x2) const {
    const double c = std::cos(turned);
    const double s = std::sin(turned);
    return std::hypot((c * (x1 - x0) + s * (x2 - y0)) / a, (c * (x2 - y0) - s * (x1 - x0)) / b);
  }
};

struct Fields {
  Grid grid;
  ArrayXd bound, slip, stick;
  StickFront front() const { return find_stick_front(grid, bound, slip, stick); }
};

/// Cell centres of n x n cells (of sides 1 to `aspect`) over |x1| < 1, |x2| < 1.
Fields sample(const MadeUp& made_up, Index n, Index n2 = 0) {
  if (n2 == 0) n2 = n;
  const Grid grid{n, n2, 2.0 / static_cast<double>(n), 2.0 / static_cast<double>(n2)};
  Fields fields{grid, ArrayXd::Zero(grid.cells()), ArrayXd::Zero(2 * grid.cells()), ArrayXd::Zero(grid.cells())};
  const ArrayXd x1 = cell_x1(grid);
  const ArrayXd x2 = cell_x2(grid);
  for (Index i = 0; i < grid.cells(); ++i) {
    const double d = made_up.level(x1[i], x2[i]) - 1.0;
    if (1.0 + d > made_up.ring) continue;
    fields.bound[i] = 1.0;
    if (d <= 0.0) {
      fields.stick[i] = 1.0;
      continue;
    }
    const double direction = 2.0 * x1[i] - x2[i];
    const double size = std::pow(d, 1.5) * (1.0 + 0.5 * d);
    fields.slip[i] = size * std::cos(direction);
    fields.slip[i + grid.cells()] = size * std::sin(direction);
  }
  return fields;
}

/// The worst of some positions of the front between the cells, relative; each is found all round.
struct Errors {
  double fitted = 0.0;
  double counted = 0.0;
};
Errors worst(const MadeUp& made_up, Index n, Index n2 = 0) {
  Errors errors;
  const double h = 2.0 / static_cast<double>(n);
  for (const double shift : {0.0, 0.21, 0.5, 0.83}) {
    MadeUp shifted = made_up;
    shifted.x0 += shift * h;
    shifted.y0 += 0.6 * shift * h;
    shifted.a *= 1.0 + 0.2 * shift * h;
    const StickFront front = sample(shifted, n, n2).front();
    errors.fitted = std::max(errors.fitted, std::abs(front.radius / shifted.radius() - 1.0));
    errors.counted = std::max(errors.counted, std::abs(front.counted_radius / shifted.radius() - 1.0));
  }
  return errors;
}

struct MadeUpShape {
  const char* name;
  MadeUp made_up;
  double at_128;  ///< relative errors allowed
  double at_256;
};
inline void PrintTo(const MadeUpShape& shape, std::ostream* stream) { *stream << shape.name; }
const MadeUpShape kShapes[] = {{"Circle", {}, 3e-5, 5e-6},
                               {"OffCentre", {.x0 = 0.13, .y0 = -0.11}, 3e-5, 5e-6},
                               {"Ellipse", {.a = 0.6, .b = 0.4}, 6e-5, 2e-5},
                               {"TurnedEllipse", {.a = 0.6, .b = 0.4, .turned = 0.5, .x0 = 0.02}, 6e-5, 2e-5},
                               {"SlenderEllipse", {.a = 0.7, .b = 0.25, .turned = 1.0, .ring = 1.35}, 3e-4, 7e-5}};

class MadeUpFront : public testing::TestWithParam<MadeUpShape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, MadeUpFront, testing::ValuesIn(kShapes),
                         [](const auto& shape) { return std::string(shape.param.name); });

/// The order is 2.6 at least while the window, in cells, covers less and less of the ring; then jitter is left.
TEST_P(MadeUpFront, IsFoundAtAHighOrder) {
  const MadeUpShape& shape = GetParam();
  const Errors coarse = worst(shape.made_up, 64);
  const Errors fine = worst(shape.made_up, 128);
  const Errors finest = worst(shape.made_up, 256);
  EXPECT_LE(fine.fitted, coarse.fitted / 6.0);
  EXPECT_LE(finest.fitted, fine.fitted / 2.0);
  EXPECT_LE(fine.fitted, shape.at_128);
  EXPECT_LE(finest.fitted, shape.at_256);
  EXPECT_LE(10.0 * finest.fitted, finest.counted);
}

TEST_P(MadeUpFront, IsFoundOnCellsThatAreNoSquares) {
  const Errors errors = worst(GetParam().made_up, 128, 96);
  EXPECT_LE(errors.fitted, 4.0 * GetParam().at_128 + 2e-4);
  EXPECT_LE(2.0 * errors.fitted, errors.counted);
}

TEST(StickFront, InNarrowRingsBeatsCounting) {
  for (const double ring : {1.1, 1.15, 1.2, 1.3}) {
    for (const Index n : {64, 128, 256}) {
      const Errors errors = worst({.ring = ring}, n);
      const double width = (ring - 1.0) * 0.25 * static_cast<double>(n);  // in cells
      EXPECT_LE(errors.fitted, errors.counted) << ring << ' ' << n;
      EXPECT_LE(errors.fitted, width >= 6.0 ? 1.5e-4 : 1.0) << ring << ' ' << n;
    }
  }
}

/// The jump of the angle on one of the axes does not matter either.
TEST_P(MadeUpFront, TurnsWithTheContact) {
  constexpr Index n = 64;
  const Fields fields = sample(GetParam().made_up, n);
  Fields turned = fields;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const Index from = i * n + j;
      const Index to = (n - 1 - j) * n + i;  // (x1, x2) -> (-x2, x1)
      turned.bound[to] = fields.bound[from];
      turned.stick[to] = fields.stick[from];
      turned.slip[to] = -fields.slip[from + n * n];
      turned.slip[to + n * n] = fields.slip[from];
    }
  }
  EXPECT_NEAR(turned.front().radius / fields.front().radius, 1.0, 1e-12);
}

// --- where it is counted ---

/// Slip of a square grid's first quarter, and the same to the last bit in its images.
Fields mirror_images(Fields fields) {
  const Index n = fields.grid.n1;
  for (Index i = 0; i < n * n; ++i) {
    const Index image = std::min(i / n, n - 1 - i / n) * n + std::min(i % n, n - 1 - i % n);
    for (const Index component : {Index{0}, n * n}) fields.slip[i + component] = fields.slip[image + component];
  }
  return fields;
}

/// Where fields have two mirror axes, a quarter of the rays is fitted: one last bit of one cell, and all are.
TEST(StickFront, OfAQuarterOfTheRaysIsThatOfAll) {
  for (const Index n : {96, 97}) {
    for (const double ring : {1.6, 1.3, 1.12}) {
      const Fields mirrored = mirror_images(sample({.a = 0.6, .b = 0.45, .ring = ring}, n));
      Fields nearly = mirrored;
      Index slipping = 0;
      while (nearly.slip[slipping] == 0.0) ++slipping;
      nearly.slip[slipping] *= 1.0 + 1e-15;
      const StickFront quarter = mirrored.front();
      const StickFront whole = nearly.front();
      EXPECT_NEAR(quarter.radius / whole.radius, 1.0, 1e-12) << n << ' ' << ring;
      EXPECT_EQ(quarter.fitted, whole.fitted);
      EXPECT_EQ(quarter.why_counted, whole.why_counted);
    }
  }
}

/// Slip that began within the stick area: the law's root lies there, and is believed up to half a cell.
TEST(StickFront, IsNoFurtherFromTheCountedOneThanHalfACell) {
  constexpr Index n = 128;
  for (const double cells : {0.4, 0.6}) {
    const double inward = cells * 2.0 / n;
    Fields law = sample({.a = 0.5 - inward, .b = 0.5 - inward, .ring = 0.8 / (0.5 - inward)}, n);
    law.stick = sample({}, n).stick;
    const StickFront front = law.front();
    EXPECT_EQ(front.radius == front.counted_radius, cells > 0.5);
    if (cells < 0.5) {
      EXPECT_NEAR(front.radius, 0.5 - inward, 0.02 * inward / cells);
    }
  }
}

void expect_counted(const Fields& fields, const char* why) {
  const StickFront front = fields.front();
  EXPECT_THAT(front.why_counted, HasSubstr(why));
  EXPECT_EQ(front.fitted, 0.0);
  EXPECT_EQ(front.radius, front.counted_radius);
  EXPECT_DOUBLE_EQ(front.counted_radius, std::sqrt(fields.stick.sum() * fields.grid.cell_area() / std::numbers::pi));
}

TEST(StickFront, IsCountedWhereItCannotBeFitted) {
  // A ring of 0.8 cells; slip that jumps at the front.
  expect_counted(sample({.ring = 1.05}, 64), "slip ring too narrow, or no root near by, on 104 of 104 rays");
  Fields jump = sample({}, 128);
  jump.slip = ((jump.stick == 0.0).cast<double>() * jump.bound).replicate(2, 1);
  expect_counted(jump, "");
  Fields fields = sample({}, 32);
  fields.stick = (fields.bound > 0.0).cast<double>();
  expect_counted(fields, "everything sticks");
  fields.stick.setZero();
  expect_counted(fields, "nothing sticks");
  fields.stick[16 * 32 + 16] = 1.0;
  expect_counted(fields, "only 1 cells stick");
  // Rays from the centroid cannot describe a hole, two halves, a ring, an island.
  const Fields whole = sample({.a = 0.5, .b = 0.5, .ring = 1.8}, 64);
  const ArrayXd x1 = cell_x1(whole.grid);
  const ArrayXd r2 = x1.square() + cell_x2(whole.grid).square();
  const ArrayXd hole = ((x1 - 0.2).square() + cell_x2(whole.grid).square() < 0.01).cast<double>();
  const ArrayXd island = ((x1 - 0.75).square() + cell_x2(whole.grid).square() < 0.005).cast<double>();
  for (const ArrayXd& stick :
       {ArrayXd(whole.stick * (1.0 - hole)), ArrayXd((x1.abs() < 0.15).select(0.0, whole.stick)),
        ArrayXd((r2 < 0.04).select(0.0, whole.stick)), ArrayXd(whole.stick.max(island * whole.bound))}) {
    Fields parts = whole;
    parts.stick = stick;
    expect_counted(parts, "not one patch");
  }
}

/// Contact on one side only a cell away from the front.
TEST(StickFront, IsCountedOnThoseRaysAlone) {
  Fields fields = sample({}, 128);
  const ArrayXd x1 = cell_x1(fields.grid);
  fields.bound = (x1 < 0.45).select(fields.bound, 0.0);
  fields.stick = (x1 < 0.45).select(fields.stick, 0.0);
  const StickFront front = fields.front();
  EXPECT_GT(front.fitted, 0.6);
  EXPECT_LT(front.fitted, 0.9);
  EXPECT_THAT(front.why_counted, HasSubstr("too narrow"));
  // The part x1 > 0.45 of a disc of radius 1/2, up to the staircase of the straight edge.
  const double area = 0.25 * (std::numbers::pi - std::acos(0.9)) + 0.45 * std::sqrt(0.25 - 0.45 * 0.45);
  EXPECT_NEAR(front.radius / std::sqrt(area / std::numbers::pi), 1.0, 2e-3);
}

TEST(StickFront, IsNoNumberWhereTheFieldsAreNone) {
  const Fields good = sample({}, 64);
  const Index slipping = 32 * 64 + 32 + 20;
  ASSERT_EQ(good.stick[slipping], 0.0);
  ASSERT_GT(good.bound[slipping], 0.0);
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    Fields fields = good;
    fields.slip[slipping + fields.grid.cells()] = bad;
    EXPECT_TRUE(std::isnan(fields.front().radius));
    EXPECT_THAT(fields.front().why_counted, HasSubstr("not finite"));
    fields = good;
    fields.bound[slipping] = bad;
    EXPECT_TRUE(std::isnan(fields.front().radius));
    fields = good;
    fields.stick[slipping] = bad;
    EXPECT_TRUE(std::isnan(fields.front().radius));
  }
  Fields outside = good;
  outside.slip[0] = kNaN;  // no contact there
  EXPECT_EQ(outside.front().radius, good.front().radius);
}

TEST(StickFront, RefusesFieldsOfAnotherSizeAndQuadrants) {
  Fields fields = sample({}, 16);
  fields.slip.conservativeResize(fields.grid.cells());
  EXPECT_THROW(fields.front(), std::invalid_argument);
  fields = sample({}, 16);
  fields.grid.quadrant = true;
  EXPECT_THROW(fields.front(), std::invalid_argument);
}

}  // namespace
}  // namespace slipstick::solver
