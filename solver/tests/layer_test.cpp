// Half-spaces under a layer that gives way as Winkler's, or with layers bonded to them: limits.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "solver/contact/certificate.hpp"
#include "solver/elasticity/law/law_kind.hpp"
#include "solver/input/tests/complaint.hpp"
#include "solver/solve.hpp"
#include "solver/tests/fields.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Compliance of the half-spaces below the contact, taken for the layer too, in m/Pa.
const double kLikeBodies = paper::kContactRadius * 4.0 * (1.0 + paper::kPoissonRatio) / paper::kYoungModulus;

const LawKind& winkler() { return law_kinds().front(); }

/// The paper's sphere on a grid that holds the contact under any layer here.
Scene layered_scene(Index cells, double normal, double tangential, double moment_ratio = 0.6) {
  Scene scene = paper_scene(cells, moment_ratio);
  scene.grid.extent = {{4.0 * paper::kContactRadius, 4.0 * paper::kContactRadius}};
  scene.layer = {&winkler(), {normal, tangential}};
  return scene;
}

Solution solved_scene(const Scene& scene) {
  const Solution solution = solve(scene);
  EXPECT_EQ(solution.status, Status::converged) << solution.message;
  return solution;
}

TEST(Layer, NeedsAnExtent) {
  Scene scene = layered_scene(16, kLikeBodies, kLikeBodies);
  scene.grid.extent.reset();
  EXPECT_THAT(complaint([&] { solve(scene); }), testing::HasSubstr("grid.extent = (missing)"));
}

/// So compliant a layer leaves the half-spaces' part of the displacements below this.
constexpr double kBodiesPart = 1e-4;

/// Winkler's foundation: p = (approach - gap)/c, and each cell turns by itself up to its friction.
TEST(Layer, ThatIsVeryCompliantIsWinklersFoundation) {
  const double compliance = 1e6 * kLikeBodies;
  Scene scene = paper_scene(32, 0.0);
  const double reach = 0.1 * paper::kRadius;
  scene.grid.extent = {{2.4 * reach, 2.4 * reach}};
  scene.layer = {&winkler(), {compliance, compliance}};
  // W = pi R delta^2/c where a^2 = 2 R delta.
  const double approach = reach * reach / (2.0 * paper::kRadius);
  scene.steps[0].normal = M_PI * paper::kRadius * approach * approach / compliance;
  scene.steps[0].torsion = Twist{0.5 * scene.contact.friction.coefficient * approach / reach};
  const Solution solution = solved_scene(scene);
  const Grid& grid = solution.grid;
  const ArrayXd square = cell_x1(grid).square() + cell_x2(grid).square();
  const ArrayXd penetration = solution.approach - square / (2.0 * paper::kRadius);
  const ArrayXd pressure = penetration.max(0.0) / compliance;
  EXPECT_NEAR(solution.approach / approach, 1.0, 0.01);  // cells of the edge
  EXPECT_LE(relative_difference(solution.pressure, pressure), kBodiesPart);
  const ArrayXd sticking = solution.twist_angle * square.sqrt() / compliance;
  const ArrayXd expected = sticking.min(scene.contact.friction.coefficient * pressure);
  EXPECT_LE(relative_difference(norms(solution.traction), expected), kBodiesPart);
  EXPECT_GT(solution.stick_cells, 0);
  EXPECT_LT(solution.stick_cells, solution.contact_cells);
  const ArrayXd across = solution.traction.head(grid.cells()) * cell_x1(grid) +
                         solution.traction.tail(grid.cells()) * cell_x2(grid);
  EXPECT_LE(across.abs().maxCoeff(), kBodiesPart * norms(solution.traction).maxCoeff() * reach);
}

/// The paper's sphere on steel with a bonded layer, its thickness over the contact radius, its modulus over
/// steel's.
Scene coated_scene(double thickness, double modulus, double poisson_ratio = 0.3) {
  Scene scene = layered_scene(32, 0.0, 0.0);
  scene.layer = {};
  scene.contact.coupling = Coupling::none;
  scene.solver.tolerance = 1e-11;
  scene.lower.coating = {thickness * paper::kContactRadius, modulus * paper::kYoungModulus, poisson_ratio};
  return scene;
}
/// The same all of its base, or all of its layer.
Scene homogeneous(Scene scene, bool layer) {
  const Coating coat = *std::exchange(scene.lower.coating, std::nullopt);
  if (layer) scene.lower = {coat.young_modulus, coat.poisson_ratio};
  return scene;
}

/// The grid fits the softer of layer and base; the contact's size lies between the sizes on either of them.
TEST(BondedLayer, NeedsNoExtent) {
  for (const auto& [thickness, modulus, poisson_ratio] :
       {std::array{0.02, 0.2, 0.5}, std::array{0.5, 0.1, 0.4}, std::array{0.3, 20.0, 0.0},
        std::array{1.0, 3.0, -0.5}}) {
    Scene scene = coated_scene(thickness, modulus, poisson_ratio);
    scene.grid.extent.reset();
    scene.grid.cells = {96, 96};
    const auto radius = [](const Scene& solved) { return solved_scene(solved).contact_radius; };
    const auto [least, most] =
        std::minmax({radius(homogeneous(scene, false)), radius(homogeneous(scene, true))});
    EXPECT_TRUE(0.99 * least < radius(scene) && radius(scene) < 1.01 * most);
  }
}

TEST(BondedLayer, MayLieOnRigidBasesAndUnderALayerBetweenTheBodies) {
  Scene scene = coated_scene(0.5, 1.0);
  scene.lower.young_modulus = std::numeric_limits<double>::infinity();
  scene.upper = scene.lower;
  const Solution rigid = solved_scene(scene);
  EXPECT_LT(rigid.contact_radius, paper::kContactRadius);
  scene.layer = {&winkler(), {kLikeBodies, kLikeBodies}};
  EXPECT_GT(solved_scene(scene).approach, rigid.approach);
}

}  // namespace
}  // namespace slipstick::solver
