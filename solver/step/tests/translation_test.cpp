#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "solver/tests/model_units.hpp"
#include "solver/tests/press.hpp"
#include "solver/tests/scene_file.hpp"
#include "solver/tests/torsion_bench.hpp"

/// Contacts that are pushed as well as turned, or turn about another point than the origin.
namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using testing::HasSubstr;
using Pair = std::array<double, 2>;

/// The paper's sphere over ten cells of contact radius, with its axis at a given point.
Scene sphere(const Pair& at_cells, Index cells = 40) {
  const double h = paper::kContactRadius / 10.0;
  Scene scene = paper_scene(cells, 0.6);
  scene.grid.extent = {h * static_cast<double>(cells), h * static_cast<double>(cells)};
  scene.surfaces[0].at = {at_cells[0] * h, at_cells[1] * h};
  scene.solver.tolerance = kGap;
  return scene;
}

double cell_size(const Scene& scene) {
  return (*scene.grid.extent)[0] / static_cast<double>(scene.grid.cells[0]);
}

ModelSolution solved(const Scene& scene) {
  ModelSolution solution = solve_in_model_units(scene);
  EXPECT_EQ(solution.status, Status::converged) << solution.message;
  return solution;
}

/// q_k at the images of all cells: image(i, j) is the image of cell (i, j) on an n x n grid.
template <typename Image>
ArrayXd moved(const ArrayXd& field, Index n, const Image& image) {
  ArrayXd result = ArrayXd::Zero(field.size());
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const auto [k, l] = image(i, j);
      if (k >= 0 && k < n && l >= 0 && l < n) result[k * n + l] = field[i * n + j];
    }
  }
  return result;
}
template <typename Image>
ArrayXd moved_vectors(const ArrayXd& field, Index n, const Image& image) {
  ArrayXd result(field.size());
  result << moved(field.head(n * n), n, image), moved(field.tail(n * n), n, image);
  return result;
}

// --- off-centre contacts ---

/// A body free to move turns about where it touches.
TEST(OffCentreSphere, TurnsAsTheCentredOneAboutItsOwnAxis) {
  const ModelSolution centred = solved(sphere({0.0, 0.0}));
  const Index n = 40;
  for (const std::array<Index, 2>& cells : {std::array<Index, 2>{5, -7}, {-8, 0}, {1, 9}}) {
    const Scene scene = sphere({static_cast<double>(cells[0]), static_cast<double>(cells[1])});
    const ModelSolution off = solved(scene);
    const ArrayXd expected = moved_vectors(centred.tangential.traction, n, [&](Index i, Index j) {
      return std::array{i + cells[0], j + cells[1]};
    });
    const Pair& centre = scene.surfaces[0].at;
    const double length = paper::kContactRadius;
    EXPECT_NEAR(off.twist_angle / centred.twist_angle, 1.0, kSame);
    EXPECT_NEAR(off.moment_limit / centred.moment_limit, 1.0, kSame);
    EXPECT_LE(relative_difference(off.tangential.traction, expected), kSame);
    EXPECT_NEAR(off.displacement[0], off.twist_angle * centre[1], kSame * off.twist_angle * length);
    EXPECT_NEAR(off.displacement[1], -off.twist_angle * centre[0], kSame * off.twist_angle * length);
    ASSERT_TRUE(off.limit.centre);
    EXPECT_NEAR((*off.limit.centre)[0], centre[0], 1e-6 * length);
    EXPECT_NEAR((*off.limit.centre)[1], centre[1], 1e-6 * length);
  }
}

// --- symmetries ---

/// Half of the limit force along the angle, with or without a moment.
Scene pushed(double force_ratio, double angle, double moment_ratio, Index cells = 28) {
  Scene scene = sphere({0.0, 0.0}, cells);
  const double force = force_ratio * paper::kFriction * paper::kLoad;
  scene.steps[0].force = {force * std::cos(angle), force * std::sin(angle)};
  scene.steps[0].torsion = MomentRatio{moment_ratio};
  return scene;
}

TEST(Force, AlongEitherAxisGivesTheSame) {
  constexpr double kHalfPi = 0.5 * std::numbers::pi;
  const ModelSolution along_1 = solved(pushed(0.5, 0.0, 0.0));
  const ModelSolution along_2 = solved(pushed(0.5, kHalfPi, 0.0));
  const ModelSolution back = solved(pushed(0.5, 2.0 * kHalfPi, 0.0));
  const Index cells = along_1.model.grid.cells();
  ArrayXd exchanged(2 * cells);
  const auto diagonal = [](Index i, Index j) { return std::array{j, i}; };
  exchanged << moved(along_1.tangential.traction.tail(cells), 28, diagonal),
      moved(along_1.tangential.traction.head(cells), 28, diagonal);
  EXPECT_LE(relative_difference(along_2.tangential.traction, exchanged), kSame);
  EXPECT_LE(relative_difference(back.tangential.traction, -along_1.tangential.traction), kSame);
  EXPECT_NEAR(along_2.displacement[1] / along_1.displacement[0], 1.0, kSame);
  EXPECT_NEAR(back.displacement[0] / along_1.displacement[0], -1.0, kSame);
  EXPECT_LE(std::abs(along_1.displacement[1]), kSame * along_1.displacement[0]);
  EXPECT_LE(std::abs(along_1.twist_angle * paper::kContactRadius), kSame * along_1.displacement[0]);
}

TEST(ForceAndMoment, TurnWithTheGrid) {
  const double angle = 0.4;
  const ModelSolution one = solved(pushed(0.5, angle, 0.5));
  const ModelSolution turned = solved(pushed(0.5, angle + 0.5 * std::numbers::pi, 0.5));
  const Index n = 28;
  const auto quarter = [](Index i, Index j) { return std::array{n - 1 - j, i}; };
  const ArrayXd& q = one.tangential.traction;
  ArrayXd expected(q.size());
  expected << -moved(q.tail(n * n), n, quarter), moved(q.head(n * n), n, quarter);
  EXPECT_LE(relative_difference(turned.tangential.traction, expected), kSame);
  EXPECT_NEAR(turned.twist_angle / one.twist_angle, 1.0, kSame);
  const double size = std::hypot(one.displacement[0], one.displacement[1]);
  EXPECT_NEAR(turned.displacement[0], -one.displacement[1], kSame * size);
  EXPECT_NEAR(turned.displacement[1], one.displacement[0], kSame * size);
}

/// Loads and motions are each other's answers, in every mixture.
TEST(Motion, GivesTheLoadsThatItCameFrom) {
  const Scene scene = pushed(0.5, 0.4, 0.5);
  const ModelSolution loaded = solved(scene);
  for (const bool by_displacement : {false, true}) {
    for (const bool by_twist : {false, true}) {
      Scene imposed = scene;
      Step& step = imposed.steps[0];
      if (by_displacement) {
        step.displacement = loaded.displacement;
        step.force = {};
      }
      if (by_twist) step.torsion = Twist{loaded.twist_angle};
      const ModelSolution moved = solved(imposed);
      EXPECT_LE(relative_difference(moved.tangential.traction, loaded.tangential.traction), kSame);
      EXPECT_NEAR(moved.moment / loaded.moment, 1.0, kSame);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(moved.force[k] / loaded.force[k], 1.0, kSame);
        EXPECT_NEAR(moved.displacement[k] / loaded.displacement[k], 1.0, kSame);
      }
      EXPECT_NEAR(moved.twist_angle / loaded.twist_angle, 1.0, kSame);
    }
  }
}

// --- Cattaneo, Mindlin, Ciavarella, Jaeger ---

std::vector<Surface> smooth_sphere() { return sphere({0.0, 0.0}).surfaces; }
std::vector<Surface> turned_ellipsoid() {
  Surface surface;
  surface.shape = Shape::ellipsoid;
  surface.radius_1 = 2.0 * paper::kRadius;
  surface.radius_2 = 0.6 * paper::kRadius;
  surface.angle = 0.5;
  return {surface};
}
std::vector<Surface> rough_sphere() {
  std::vector<Surface> surfaces = smooth_sphere();
  Surface& rough = surfaces.emplace_back();
  rough.shape = Shape::roughness;
  rough.roughness = {.seed = 3, .hurst = 0.8, .rms_slope = 0.01};
  const double h = paper::kContactRadius / 10.0;
  rough.roughness.longest = 16.0 * h;
  rough.roughness.shortest = 4.0 * h;
  rough.roughness.period = 32.0 * h;
  return surfaces;
}

class Mindlin : public testing::TestWithParam<std::vector<Surface>> {};
INSTANTIATE_TEST_SUITE_P(Surfaces, Mindlin,
                         testing::Values(smooth_sphere(), turned_ellipsoid(), rough_sphere()),
                         [](const auto& tested) { return to_string(tested.param.back().shape); });

/// Bodies with nu = 0 have K11 = K22 = K33 and K12 = 0, on the mesh too: under a force f mu W that does not
/// turn the body any contact carries q = mu (p(W) - p((1 - f) W)) along it, and moves by mu times what the
/// approach is less (Ciavarella 1998, Jaeger 1998). Where p((1 - f) W) > 0 the difference of K p is that of
/// the approaches; elsewhere K p + h exceeds the approach, and slip is opposed to q.
TEST_P(Mindlin, IsTheDifferenceOfTwoPressures) {
  const double part = 0.6;
  const Pair along{0.6, 0.8};
  Scene scene = sphere({0.0, 0.0}, 32);
  scene.surfaces = GetParam();
  scene.upper.poisson_ratio = scene.lower.poisson_ratio = 0.0;
  const Contact whole = press(scene);
  scene.steps[0].normal = (1.0 - part) * paper::kLoad;
  const Contact less = press(scene);
  scene.steps[0].normal = paper::kLoad;
  const ArrayXd expected = paper::kFriction * (whole.solution.pressure - less.solution.pressure);
  ASSERT_GE(expected.minCoeff(), 0.0) << "pressure grows with load everywhere";

  const double force = paper::kFriction * part * paper::kLoad;
  scene.steps[0].force = {force * along[0], force * along[1]};
  scene.steps[0].torsion = Twist{0.0};
  const ModelSolution solution = solved(scene);
  const Index cells = expected.size();
  const ArrayXd& q = solution.tangential.traction;
  const double largest_q = expected.maxCoeff();
  const double error =
      std::max(largest(q.head(cells) - along[0] * expected), largest(q.tail(cells) - along[1] * expected)) /
      largest_q;
  EXPECT_LE(error, kSame);
  const double moved =
      paper::kFriction * (whole.solution.approach - less.solution.approach) * solution.model.length_unit;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(solution.displacement[k] / (along[k] * moved), 1.0, kSame);
  }
  EXPECT_EQ(solution.stick_cells, (less.solution.pressure > 0.0).count());
}

/// A force moves it, and nothing turns it.
TEST(OneCell, MovesByItsOwnCoefficient) {
  Scene scene = paper_scene(3, 0.0);
  scene.grid.extent = {2.9e-3, 2.9e-3};  // a cell is hardly smaller than the contact
  scene.steps[0].force = {30.0, -10.0};
  const ModelSolution solution = solved(scene);
  EXPECT_EQ(solution.contact_cells, 1);
  const HalfSpace steel{0.5 * paper::kYoungModulus / (1.0 + paper::kPoissonRatio), paper::kPoissonRatio};
  const double area = cell_size(scene) * cell_size(scene);
  const HalfSpaces law(elastic_pair(steel, steel));
  const double compliance =
      law.influence_coefficients(Component::k11, {1, 1, cell_size(scene), cell_size(scene)})[0] / area;
  EXPECT_NEAR(solution.displacement[0] / (30.0 * compliance), 1.0, kSame);
  EXPECT_NEAR(solution.displacement[1] / (-10.0 * compliance), 1.0, kSame);
  EXPECT_EQ(solution.twist_angle, 0.0);
}

// --- limits ---

TEST(MomentRatio, IsOfTheLimitWithoutForce) {
  const ModelSolution alone = solved(pushed(0.0, 0.0, 0.5));
  const ModelSolution with_force = solved(pushed(0.6, 0.4, 0.5));
  EXPECT_NEAR(with_force.moment_limit / alone.moment_limit, 1.0, kSame);
  EXPECT_NEAR(with_force.moment / (0.5 * with_force.moment_limit), 1.0, kRounding);
  EXPECT_GT(with_force.limit.factor, 1.0);
  EXPECT_LT(with_force.limit.factor, alone.limit.factor);
}

TEST(Limit, RefusesMoreThanTheContactCanCarry) {
  const auto complaint_of = [](const Scene& scene) {
    return complaint([&] { solve_in_model_units(scene); });
  };
  const std::string slides = complaint_of(pushed(1.25, 0.0, 0.0));
  EXPECT_THAT(slides, HasSubstr("load.force"));
  EXPECT_THAT(slides, HasSubstr("[125, 0] N"));
  EXPECT_THAT(slides, HasSubstr("0.8 times these"));
  EXPECT_THAT(slides, HasSubstr("along (1, "));

  const std::string both = complaint_of(pushed(0.9, 0.0, 0.9));
  EXPECT_THAT(both, HasSubstr("load.force"));
  EXPECT_THAT(both, HasSubstr("turning about ("));

  Scene scene = sphere({5.0, -7.0});
  scene.steps[0].torsion = Moment{1.1 * paper::kMomentLimit};
  const std::string turns = complaint_of(scene);
  EXPECT_THAT(turns, HasSubstr("load.moment = "));
  EXPECT_THAT(turns, HasSubstr("turning about (0.0002445, -0.0003424) m"));

  // No force in one direction is too large where the other motion is imposed.
  scene = pushed(0.99, 0.0, 0.0);
  scene.steps[0].torsion = Twist{1e-3};
  EXPECT_NEAR(solved(scene).force[0], 0.99 * paper::kFriction * paper::kLoad, 1e-9);
}

}  // namespace
}  // namespace slipstick::solver
