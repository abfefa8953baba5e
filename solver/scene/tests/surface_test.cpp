// Shapes of the indenter, and contacts that are known from others: the same body turned, shifted, put together.

#include "solver/scene/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "solver/input/input_error.hpp"
#include "solver/scene/roughness.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/tests/limits.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using std::numbers::pi;

Surface sphere(double radius) { return {.shape = Shape::sphere, .radius = radius}; }
Surface ellipsoid(double radius_1, double radius_2, double angle) {
  return {.shape = Shape::ellipsoid, .radius_1 = radius_1, .radius_2 = radius_2, .angle = angle};
}
Surface punch(double radius, double inner_radius) {
  return {.shape = Shape::flat_punch, .radius = radius, .inner_radius = inner_radius};
}
Surface rounded_punch(double flat_radius, double corner_radius) {
  return {.shape = Shape::rounded_punch, .flat_radius = flat_radius, .corner_radius = corner_radius};
}
Surface power(double exponent, double coefficient) {
  return {.shape = Shape::power, .exponent = exponent, .coefficient = coefficient};
}
Surface moved(Surface surface, double x1, double x2) {
  surface.at = {x1, x2};
  return surface;
}

Scene scene_of(const std::vector<Surface>& surfaces, Index cells, Combine combine = Combine::sum) {
  Scene scene = paper_scene(cells, 0.5);
  scene.surfaces = surfaces;
  scene.combine = combine;
  return scene;
}

/// One cell about a point.
double gap_at(const Surface& surface, double x1, double x2) {
  return gap_field({moved(surface, surface.at[0] - x1, surface.at[1] - x2)}, Combine::sum, {1, 1, 1.0, 1.0})[0];
}

double approach(const Contact& contact) { return contact.solution.approach * contact.model.length_unit; }

// --- gaps ---

TEST(Gap, OfEachShapeIsItsFormula) {
  EXPECT_DOUBLE_EQ(gap_at(sphere(2.0), 0.3, 0.4), 0.0625);
  EXPECT_DOUBLE_EQ(gap_at({.shape = Shape::cone, .slope = 0.2}, 0.3, 0.4), 0.1);
  EXPECT_EQ(gap_at(punch(0.51, 0.49), 0.3, 0.4), 0.0);
  EXPECT_EQ(gap_at(punch(0.49, 0.0), 0.3, 0.4), HUGE_VAL);
  EXPECT_EQ(gap_at(punch(0.9, 0.51), 0.3, 0.4), HUGE_VAL);
  EXPECT_EQ(gap_at(punch(0.9, 0.0), 0.0, 0.0), 0.0);
  EXPECT_EQ(gap_at(rounded_punch(0.5, 2.0), 0.3, 0.4), 0.0);
  EXPECT_DOUBLE_EQ(gap_at(rounded_punch(0.25, 2.0), 0.3, 0.4), 0.25 * 0.25 / 4.0);
  EXPECT_DOUBLE_EQ(gap_at(power(3.0, 2.0), 0.3, 0.4), 0.25);
  EXPECT_EQ(gap_at(power(3.0, 2.0), 0.0, 0.0), 0.0);
}

/// Along the first axis, at `angle` from x1 towards x2, an ellipsoid is as curved as a sphere of radius_1.
TEST(Gap, OfATurnedEllipsoidTurnsWithIt) {
  for (const double angle : {0.0, 0.4, 2.0, -1.1}) {
    const Surface surface = moved(ellipsoid(4.0, 1.0, angle), 0.7, -0.2);
    EXPECT_NEAR(gap_at(surface, 0.7 + std::cos(angle), -0.2 + std::sin(angle)), 0.125, 10.0 * kEpsilon);
    EXPECT_NEAR(gap_at(surface, 0.7 - std::sin(angle), -0.2 + std::cos(angle)), 0.5, 10.0 * kEpsilon);
    EXPECT_EQ(gap_at(surface, 0.7, -0.2), 0.0);
  }
}

TEST(Gap, OfSeveralShapesIsTheirSumOrTheNearest) {
  const Grid grid{6, 4, 0.3, 0.2};
  const std::vector<Surface> both{moved(sphere(2.0), 0.4, 0.1), punch(0.5, 0.0)};
  const ArrayXd first = gap_field({both[0]}, Combine::sum, grid);
  const ArrayXd second = gap_field({both[1]}, Combine::sum, grid);
  EXPECT_TRUE((gap_field(both, Combine::sum, grid) == first + second).all());
  EXPECT_TRUE((gap_field(both, Combine::nearest, grid) == first.min(second)).all());
  EXPECT_GT(first.minCoeff(), 0.0) << "a body's own level is kept";
}

/// Roughness and maps have no level: the least gap of the whole is 0, off the face of a punch it is infinite.
TEST(Gap, WithRoughnessStartsAtZero) {
  const Surface rough{
      .shape = Shape::roughness,
      .roughness = {.seed = 1, .hurst = 0.8, .longest = 4.0, .shortest = 1.0, .rms_slope = 0.1, .period = 16.0}};
  const Grid grid{12, 12, 0.5, 0.5};
  const ArrayXd heights = roughness_heights(rough.roughness, grid);
  for (const auto& [face, combine] :
       {std::pair{punch(2.0, 0.0), Combine::sum}, {sphere(5.0), Combine::sum}, {sphere(5.0), Combine::nearest}}) {
    const ArrayXd gap = gap_field({face, rough}, combine, grid);
    const ArrayXd smooth = gap_field({face}, combine, grid);
    EXPECT_EQ(gap.minCoeff(), 0.0);
    EXPECT_EQ(gap.isFinite().count(), smooth.isFinite().count());
    ArrayXd expected = smooth.min(heights);
    if (combine == Combine::sum) expected = smooth + heights;
    EXPECT_TRUE((smooth.isFinite().select(gap - (expected - expected.minCoeff()), 0.0).abs() <= kEpsilon).all());
  }
}

// --- where the contact is expected ---

/// Sneddon (1965), by quadrature in r = a sin(t): W = 2 E* integral r^2 f'/sqrt(a^2 - r^2) dr, and the
/// approach = a integral f'/sqrt(a^2 - r^2) dr.
struct Indented {
  double load;
  double approach;
};
template <typename Slope>
Indented indent(double a, double modulus, const Slope& slope) {
  constexpr int points = 20000;
  Indented indented{};
  for (int i = 0; i < points; ++i) {
    const double r = a * std::sin(0.5 * pi * (i + 0.5) / points);
    indented.load += 2.0 * modulus * r * r * slope(r) * 0.5 * pi / points;
    indented.approach += a * slope(r) * 0.5 * pi / points;
  }
  return indented;
}

struct Revolved {
  Surface surface;
  std::function<double(double)> slope;
};
std::vector<Revolved> revolved() {
  const auto corner = [](double b, double radius) {
    return [b, radius](double r) { return r > b ? (r - b) / radius : 0.0; };
  };
  return {{rounded_punch(4e-4, 5e-3), corner(4e-4, 5e-3)},
          {rounded_punch(1e-4, 1e-2), corner(1e-4, 1e-2)},
          {rounded_punch(1e-6, 1.8e-2), corner(1e-6, 1.8e-2)},
          {power(4.0, 3e7), [](double r) { return 4.0 * 3e7 * r * r * r; }},
          {power(1.5, 0.5), [](double r) { return 1.5 * 0.5 * std::sqrt(r); }}};
}

TEST(ExpectedContact, OfABodyOfRevolutionCarriesTheLoad) {
  const double modulus = effective_modulus(paper_scene(1, 0.5));
  for (const Revolved& body : revolved()) {
    const auto half_sides = *expected_half_sides({body.surface}, Combine::sum, paper::kLoad, modulus);
    EXPECT_EQ(half_sides[0], half_sides[1]);
    // The midpoint rule of 20,000 points, with a kink inside.
    EXPECT_NEAR(indent(half_sides[0], modulus, body.slope).load / paper::kLoad, 1.0, 1e-7);
  }
}

TEST(ExpectedContact, OfPowersIsThatOfSphereAndCone) {
  const auto half_side = [](const Surface& surface) {
    return (*expected_half_sides({surface}, Combine::sum, 3.0, 5.0))[0];
  };
  EXPECT_NEAR(half_side(power(2.0, 0.25)) / half_side(sphere(2.0)), 1.0, 10.0 * kEpsilon);
  EXPECT_NEAR(half_side(power(1.0, 0.3)) / half_side({.shape = Shape::cone, .slope = 0.3}), 1.0, 10.0 * kEpsilon);
}

TEST(ExpectedContact, HoldsAllBodiesSideBySide) {
  const std::vector<Surface> bodies{moved(punch(1.0, 0.0), -3.0, 0.5), moved(punch(2.0, 0.0), 1.0, -2.5)};
  EXPECT_EQ(expected_half_sides(bodies, Combine::nearest, 1.0, 1.0), (std::array{4.0, 4.5}));
  EXPECT_EQ(half_sides_below(bodies, Combine::nearest, 0.1), (std::array{4.0, 4.5}));
}

/// Along the sides of the rectangle the gap of a body with two radii, turned and off the origin, is at least
/// the depth, and on the far sides it comes down to it: on its own axes, along x1 at sqrt(2 R1 depth).
TEST(GapBelowADepth, OfAnEllipsoidIsItsOwnLevelsBox) {
  const double depth = 0.02;
  for (const double angle : {0.0, 0.4, 2.0, -1.1, 0.5 * pi}) {
    const Surface surface = moved(ellipsoid(4.0, 1.0, angle), 0.7, -0.2);
    const auto [half_1, half_2] = half_sides_below({surface}, Combine::sum, depth);
    double least_1 = HUGE_VAL;
    double least_2 = HUGE_VAL;
    for (int i = -2000; i <= 2000; ++i) {
      least_1 = std::min(least_1, gap_at(surface, half_1, 1e-3 * i * half_2));
      least_2 = std::min(least_2, gap_at(surface, 1e-3 * i * half_1, -half_2));
    }
    EXPECT_NEAR(least_1 / depth, 1.0, 1e-4) << angle;
    EXPECT_NEAR(least_2 / depth, 1.0, 1e-4) << angle;
  }
  const auto own = half_sides_below({ellipsoid(4.0, 1.0, 0.0)}, Combine::sum, depth);
  EXPECT_NEAR(own[0], 0.4, 10.0 * kEpsilon);
  EXPECT_NEAR(own[1], 0.2, 10.0 * kEpsilon);
}

/// The gap of a sum is larger than either one's; the gap of the nearest is that of one.
TEST(GapBelowADepth, OfSeveralShapesIsTheNarrowestOrTheWidest) {
  const std::vector<Surface> crossed{ellipsoid(4.0, 1.0, 0.0), ellipsoid(0.25, 2.25, 0.0)};
  const auto sum = half_sides_below(crossed, Combine::sum, 0.02);
  const auto nearest = half_sides_below(crossed, Combine::nearest, 0.02);
  for (const auto& [found, along_1, along_2] : {std::tuple{sum, 0.1, 0.2}, {nearest, 0.4, 0.3}}) {
    EXPECT_NEAR(found[0], along_1, 10.0 * kEpsilon);
    EXPECT_NEAR(found[1], along_2, 10.0 * kEpsilon);
  }
}

TEST(ExpectedContact, IsNotKnownOfSumsAndRoughness) {
  EXPECT_EQ(expected_half_sides({sphere(1.0), sphere(2.0)}, Combine::sum, 1.0, 1.0), std::nullopt);
  const Surface rough{.shape = Shape::roughness};
  EXPECT_EQ(expected_half_sides({rough}, Combine::sum, 1.0, 1.0), std::nullopt);
  EXPECT_EQ(expected_half_sides({sphere(1.0), rough}, Combine::nearest, 1.0, 1.0), std::nullopt);
  EXPECT_THROW(make_model(scene_of({sphere(1.0), sphere(2.0)}, 8)), InputError);
}

// --- contacts that are known from others ---

TEST(BodiesOfRevolution, SinkInAsSneddonSays) {
  for (const Revolved& body : revolved()) {
    const Scene scene = scene_of({body.surface}, 48);
    const double modulus = effective_modulus(scene);
    const double a = (*expected_half_sides({body.surface}, Combine::sum, paper::kLoad, modulus))[0];
    // 22 cells in the radius, and second order or nearly so.
    EXPECT_NEAR(approach(press(scene)) / indent(a, modulus, body.slope).approach, 1.0, 2.0 / (22.0 * 22.0));
  }
}

TEST(ASurface, ThatNoCellCanTouchIsRefused) {
  Scene scene = scene_of({moved(punch(1e-4, 0.0), 2e-4, 0.0), moved(punch(1e-4, 0.0), -2e-4, 0.0)}, 16);
  scene.grid.extent = {1e-3, 1e-3};
  EXPECT_THROW(make_model(scene), InputError);
  scene.combine = Combine::nearest;
  EXPECT_NO_THROW(make_model(scene));
}

}  // namespace
}  // namespace slipstick::solver
