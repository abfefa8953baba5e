// Contacts that the grid's edge cuts off are refused; all others are the same on every larger
// grid of the same cells.

#include <gmock/gmock.h>

#include <numbers>
#include <optional>
#include <regex>
#include <utility>

#include "solver/scene/hertz_pressure.hpp"
#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

using namespace testing;

Surface sphere(double radius, std::array<double, 2> at = {}) {
  return {.shape = Shape::sphere, .radius = radius, .at = at};
}
Surface flat_punch(double radius, double inner_radius = 0.0, std::array<double, 2> at = {}) {
  return {.shape = Shape::flat_punch, .radius = radius, .inner_radius = inner_radius, .at = at};
}
Surface roughness(std::uint64_t seed = 1) {
  return {
      .shape = Shape::roughness,
      .roughness = {.seed = seed, .hurst = 0.8, .longest = 2e-4, .shortest = 5e-5, .rms_slope = 0.03, .period = 8e-4}};
}

Scene scene_of(const std::vector<Surface>& surfaces, std::array<Index, 2> cells, double cell_size,
               Combine combine = Combine::sum) {
  Scene scene = paper_scene(0, 0.5);
  scene.surfaces = surfaces;
  scene.combine = combine;
  scene.grid.cells = cells;
  scene.grid.extent = {cell_size * static_cast<double>(cells[0]), cell_size * static_cast<double>(cells[1])};
  return scene;
}

std::string refusal(const Scene& scene) {
  return complaint([&] { solve_in_model_units(scene); });
}

/// Solves the scene on the extents that refusals name, one after the other; returns the last message.
std::string follow_refusals(Scene scene) {
  const std::regex named(R"#(allowed: \["([0-9.e+-]+) m", "([0-9.e+-]+) m"\] or more)#");
  std::string message = refusal(scene);
  EXPECT_THAT(message, HasSubstr("grid.extent"));
  for (int round = 0; round < 3 && !message.empty(); ++round) {
    std::smatch match;
    if (!std::regex_search(message, match, named)) break;
    scene.grid.extent = {std::stod(match[1]), std::stod(match[2])};
    message = refusal(scene);
  }
  return message;
}

Scene two_spheres_side_by_side(double extent) {
  return scene_of({sphere(0.018, {-4e-4, 0.0}), sphere(0.018, {4e-4, 0.0})}, {64, 64}, extent / 64.0, Combine::nearest);
}
Scene two_spheres_summed(double extent) { return scene_of({sphere(0.036), sphere(0.036)}, {64, 64}, extent / 64.0); }

/// Two long bodies that add up to one with a contact some six times as long as wide, on a grid that is too
/// short for it and wide enough.
TEST(CutOffContact, OfALongBodyIsRefusedAlongEitherAxis) {
  for (const bool along_x2 : {false, true}) {
    const double angle = along_x2 ? 0.5 * std::numbers::pi : 0.0;
    const Surface half{.shape = Shape::ellipsoid, .radius_1 = 0.32, .radius_2 = 0.02, .angle = angle};
    Scene scene = scene_of({half, half}, {32, 32}, 1.0);
    const HertzContact contact = hertz_contact(paper::kLoad, 0.16, 0.01, effective_modulus(scene));
    scene.grid.extent = {1.4 * contact.semi_axis_1, 6.0 * contact.semi_axis_2};
    if (along_x2) std::swap((*scene.grid.extent)[0], (*scene.grid.extent)[1]);
    EXPECT_THAT(refusal(scene), HasSubstr("beyond the grid's edge")) << along_x2;
  }
}

TEST(CutOffContact, IsRefusedWithAnExtentThatLeadsToAnAnswer) {
  for (const Scene& scene : {two_spheres_side_by_side(0.81e-3), two_spheres_side_by_side(0.9e-3),
                             two_spheres_summed(0.3e-3), two_spheres_summed(0.81e-3)})
    EXPECT_EQ(follow_refusals(scene), "");
}

// --- every extent from generous to far too small ---

struct Body {
  std::string name;
  std::vector<Surface> surfaces;
  Combine combine;
  double cell_size;  // m
};
void PrintTo(const Body& body, std::ostream* stream) { *stream << body.name; }

std::vector<Body> bodies() {
  const Combine sum = Combine::sum;
  const Combine nearest = Combine::nearest;
  return {
      {"sphere", {sphere(0.018)}, sum, 3e-5},
      {"off_centre", {sphere(0.018, {1.3e-4, 2.1e-4})}, sum, 3e-5},
      {"turned_ellipse", {{.shape = Shape::ellipsoid, .radius_1 = 0.018, .radius_2 = 0.0063, .angle = 0.5}}, sum, 3e-5},
      {"cone", {{.shape = Shape::cone, .slope = 0.02}}, sum, 3e-5},
      {"power", {{.shape = Shape::power, .exponent = 4.0, .coefficient = 3e7}}, sum, 4e-5},
      {"rounded_punch", {{.shape = Shape::rounded_punch, .flat_radius = 4e-4, .corner_radius = 5e-3}}, sum, 3e-5},
      {"flat_punch", {flat_punch(5e-4)}, sum, 3e-5},
      {"annulus", {flat_punch(5e-4, 3e-4, {1e-4, 0.0})}, sum, 3e-5},
      {"summed_spheres", {sphere(0.036), sphere(0.036, {2e-4, 1e-4})}, sum, 3e-5},
      {"sphere_and_punch", {sphere(0.036), flat_punch(5e-4)}, sum, 3e-5},
      {"patches", {sphere(0.018, {-5e-4, 0.0}), sphere(0.018, {5e-4, 0.0})}, nearest, 4e-5},
      {"unequal_patches", {sphere(0.018, {-4e-4, 0.0}), sphere(0.006, {4e-4, 2e-4})}, nearest, 3e-5},
      {"patch_and_punch", {sphere(0.018, {-6e-4, 0.0}), flat_punch(2e-4, 1e-4, {5e-4, 2e-4})}, nearest, 4e-5},
      {"rough_sphere", {sphere(0.018), roughness()}, sum, 2.5e-5},
  };
}

class ShrinkingGrid : public testing::TestWithParam<Body> {};

/// The cells stay where they are: an answer that is not refused is the generous one's, up to the tolerance.
/// Refusals begin where the contact's own cells are left out, not earlier. The grids are square or not.
TEST_P(ShrinkingGrid, HoldsTheContactOrIsRefused) {
  const Body& body = GetParam();
  constexpr Index kGenerous = 80;
  const auto on = [&](Index n1, Index n2) { return scene_of(body.surfaces, {n1, n2}, body.cell_size, body.combine); };
  const ModelSolution generous = solve_in_model_units(on(kGenerous, kGenerous));
  ASSERT_EQ(generous.status, Status::converged) << generous.message;
  const Grid& grid = generous.model.grid;
  const Eigen::ArrayXd pressed = (generous.normal.pressure > 0.0).cast<double>();
  const std::array needed{2.0 * (pressed * cell_x1(grid).abs()).maxCoeff() + 1.0,
                          2.0 * (pressed * cell_x2(grid).abs()).maxCoeff() + 1.0};
  int held = 0;
  int refused = 0;
  for (const bool both : {true, false}) {
    for (Index n = kGenerous - 8; n >= 6; n -= n > 24 ? 4 : 6) {
      const Scene scene = both ? on(n, n) : on(kGenerous, n);
      // Before the solve the contact is known by theory: within a cell of where it is on this mesh.
      const auto fits = [&](double spare) {
        const double side = static_cast<double>(n) - spare;
        return needed[1] <= side && (!both || needed[0] <= side);
      };
      std::optional<ModelSolution> found;
      const std::string message = complaint([&] { found = solve_in_model_units(scene); });
      if (!found) {
        EXPECT_THAT(message, HasSubstr("grid.extent"));
        EXPECT_FALSE(fits(1.0)) << n << " cells are enough: " << message;
        ++refused;
        continue;
      }
      EXPECT_TRUE(fits(0.0)) << n << " cells are not enough";
      EXPECT_EQ(found->status, Status::converged) << found->message;
      EXPECT_NEAR(found->twist_angle / generous.twist_angle, 1.0, 1e-6) << n;
      EXPECT_NEAR(found->peak_pressure / generous.peak_pressure, 1.0, 1e-5) << n;
      ++held;
    }
  }
  EXPECT_GE(held, 4);
  EXPECT_GE(refused, 4);
}

INSTANTIATE_TEST_SUITE_P(OfManyShapes, ShrinkingGrid, testing::ValuesIn(bodies()),
                         [](const auto& info) { return info.param.name; });

// --- bodies that end, and bodies whose surface beyond the grid is unknown ---

TEST(GridEdge, MustHoldAllBodiesSideBySide) {
  const std::vector<Surface> apart{sphere(0.018), sphere(0.018, {5e-3, 0.0})};
  EXPECT_THAT(refusal(scene_of(apart, {32, 32}, 5e-5, Combine::nearest)), says("grid.extent", "all shapes"));
  const std::vector<Surface> punches{sphere(0.018), flat_punch(3e-4, 0.0, {1e-3, 0.0})};
  EXPECT_THAT(refusal(scene_of(punches, {48, 24}, 5e-5, Combine::nearest)), HasSubstr("grid.extent"));
}

/// A rough plane has no end: none of its contacts is whole, unless the scene says where it ends.
TEST(GridEdge, MayBeTheBodysWhereTheSceneSaysSo) {
  Scene one = scene_of({sphere(0.018)}, {32, 32}, 2e-5);
  for (auto [scene, extent, why] :
       {std::tuple{two_spheres_side_by_side(1.1e-3), R"(["0.0011 m", "0.0011 m"])",
                   "beyond the grid's edge under 1000 N"},
        {scene_of({roughness()}, {32, 32}, 2.5e-5), R"(["0.0008 m", "0.0008 m"])", "upper.ends_at_grid_edge = true"},
        {one, R"(["0.00064 m", "0.00064 m"])", "larger than the contact"}}) {
    EXPECT_THAT(refusal(scene), says("grid.extent = " + std::string(extent), why));
    scene.ends_at_grid_edge = true;
    EXPECT_EQ(solve_in_model_units(scene).status, Status::converged);
  }
  for (const PressureModel hertz : {PressureModel::hertz, PressureModel::hertz_averaged}) {
    for (const bool ends : {false, true}) {  // Hertz's bodies do not end
      one.contact.pressure = hertz;
      one.ends_at_grid_edge = ends;
      EXPECT_THAT(refusal(one), HasSubstr("larger than the contact"));
    }
  }
}

/// Few peaks touch: those beyond the grid count from the same level, also where they are higher.
TEST(GridEdge, OfARoughPlaneUnderLittleLoadIsSeen) {
  for (const std::uint64_t seed : {1, 2, 3, 5, 6}) {  // of the fourth one cell touches, the highest
    Scene scene = scene_of({roughness(seed)}, {16, 12}, 2.5e-5);
    scene.steps[0].normal = 0.1;
    EXPECT_THAT(refusal(scene), HasSubstr("beyond the grid's edge")) << seed;
  }
}

TEST(GridEdge, HoldsAHistorysLargestLoad) {
  Scene scene = two_spheres_summed(1.1e-3);
  scene.steps.assign(3, scene.steps.front());
  scene.steps[0].normal = 200.0;
  scene.steps[1].normal = 4000.0;
  int steps = 0;
  EXPECT_THAT(complaint([&] { solve_in_model_units(scene, [&](const ModelSolution&) { ++steps; }); }),
              says("grid.extent", "under 4000 N"));
  EXPECT_EQ(steps, 1) << "the first step fits";
}

TEST(GridEdge, IsLookedAtUnderFullCoupling) {
  Scene scene = two_spheres_summed(0.7e-3);
  scene.grid.cells = {24, 24};
  scene.lower = {3e9, 0.0};
  scene.upper.young_modulus = HUGE_VAL;
  scene.contact.coupling = Coupling::full;
  scene.contact.friction.coefficient = 0.3;
  scene.steps[0].normal = 20.0;
  EXPECT_EQ(follow_refusals(scene), "");
}

TEST_F(SceneFile, OfAMappedSphereHoldsTheContactOrIsRefused) {
  const auto mapped_sphere = [&](Index cells, const std::vector<std::string>& overrides = {}) {
    const auto height = [&](Index i, Index j) {
      const double x1 = 1.5e-5 * static_cast<double>(2 * i + 1 - cells);
      const double x2 = 1.5e-5 * static_cast<double>(2 * j + 1 - cells);
      return (x1 * x1 + x2 * x2) / 0.036;
    };
    return mapped(table_of(cells, cells, height), "[3e-5, 3e-5]", overrides);
  };
  const ModelSolution generous = solve_in_model_units(mapped_sphere(48));
  // 0.978 mm of contact over 30 um a cell.
  EXPECT_NEAR(solve_in_model_units(mapped_sphere(34)).twist_angle / generous.twist_angle, 1.0, 1e-6);
  EXPECT_THAT(refusal(mapped_sphere(32)), says("grid.extent", "heights.csv", "outermost"));
  EXPECT_EQ(solve_in_model_units(mapped_sphere(16, {"upper.ends_at_grid_edge=true"})).status, Status::converged);
}

TEST_F(SceneFile, TheEdgeOfAPressureFileHasToBeTheBodys) {
  const std::string inside =
      "x1,x2,pressure\n0.000125,0.000125,1e9\n-0.000125,-0.000125,1e9\n0.000125,-0.000125,1e9\n-0.000125,0."
      "000125,1e9\n";
  const std::string at_edge = inside + "0.000375,0.000125,1e9\n-0.000375,-0.000125,1e9\n";
  EXPECT_EQ(refusal(pressed(inside)), "");
  EXPECT_THAT(refusal(pressed(at_edge)), says(R"(grid.extent = ["0.001 m", "0.001 m"])", "p.csv", "outermost"));
  EXPECT_EQ(refusal(pressed(at_edge, {"upper.ends_at_grid_edge=true"})), "");
  for (const char* one :
       {"0.000375,0.000125,1e9\n", "-0.000375,0.000125,1e9\n", "0.000125,0.000375,1e9\n", "0.000125,-0.000375,1e9\n"}) {
    EXPECT_THAT(refusal(pressed(inside + one)), HasSubstr("outermost")) << one;
  }
}

}  // namespace
}  // namespace slipstick::solver
