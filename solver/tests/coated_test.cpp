// Half-spaces with a layer bonded to them: every method, every part of the grid, and limits.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "solver/elasticity/law/law_kind.hpp"
#include "solver/solve.hpp"
#include "solver/tests/fields.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

const double kRigidModulus = std::numeric_limits<double>::infinity();

/// The paper's sphere on a coated body, on a grid that holds its contact with any of them.
Scene coated_scene(Index cells, const Coating& coating, double moment_ratio = 0.6) {
  Scene scene = paper_scene(cells, moment_ratio);
  scene.extent = {{3.0 * paper::kContactRadius, 3.0 * paper::kContactRadius}};
  scene.lower.coating = coating;
  return scene;
}

Coating coating_of(double thickness_over_radius, double modulus_over_steels, double poisson_ratio = 0.3) {
  return {thickness_over_radius * paper::kContactRadius, modulus_over_steels * paper::kYoungModulus,
          poisson_ratio};
}

Solution certified(Scene scene) {
  scene.tolerance = std::min(scene.tolerance, 1e-10);
  Solution solution = solve(scene);
  EXPECT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_LE(solution.certificate.gap, scene.method == Method::paper ? 1e-3 : scene.tolerance);
  EXPECT_GE(solution.predicted_bytes, solution.bytes);
  EXPECT_GT(solution.stick_cells, 0);
  EXPECT_LT(solution.stick_cells, solution.contact_cells);
  return solution;
}

TEST(Coated, LikeItsBodyIsNoCoat) {
  Scene scene = coated_scene(32, coating_of(0.3, 1.0));
  scene.extent.reset();
  Scene plain = scene;
  plain.lower.coating.reset();
  const Solution with = certified(scene);
  const Solution without = certified(plain);
  EXPECT_EQ(with.grid.h1, without.grid.h1);
  EXPECT_LE(relative_difference(with.pressure, without.pressure), kSame);
  EXPECT_LE(relative_difference(with.traction, without.traction), kSame);
  EXPECT_NEAR(with.twist_angle / without.twist_angle, 1.0, kSame);
}

/// What is left goes like the thickness of a thin layer, and like the third power of one over that of a thick
/// one: the base answers a resultant by a translation, which changes no twist, and a moment like a dipole.
TEST(Coated, GoesFromTheBaseToTheLayer) {
  for (const double modulus : {0.4, 3.0}) {
    const auto twist = [&](double thickness) {
      Scene scene = coated_scene(32, coating_of(thickness, modulus));
      scene.coupling = Coupling::none;
      return certified(scene).twist_angle;
    };
    Scene plain = coated_scene(32, {});
    plain.lower.coating.reset();
    plain.coupling = Coupling::none;
    const double base = certified(plain).twist_angle;
    plain.lower.young_modulus *= modulus;
    const double layer = certified(plain).twist_angle;
    EXPECT_NEAR((twist(2e-3) - base) / (twist(1e-3) - base), 2.0, 0.02);
    EXPECT_NEAR((twist(100.0) - layer) / (twist(200.0) - layer), 8.0, 0.08);
    EXPECT_NEAR(twist(1e-3), base, 0.005 * base);
    EXPECT_NEAR(twist(400.0), layer, 0.005 * layer);
  }
}

TEST(Coated, IsTheSameByEveryMethodOperatorAndPartOfTheGrid) {
  for (const Coupling coupling : {Coupling::none, Coupling::pressure, Coupling::full}) {
    Scene scene = coated_scene(24, coating_of(0.4, 2.0, 0.2));
    scene.upper.coating = coating_of(0.1, 0.5);
    scene.coupling = coupling;
    scene.tolerance = 1e-12;
    const Solution reference = certified(scene);
    struct Case {
      std::string name;
      void (*change)(Scene&);
      double tolerance;
    };
    // As for layers between the bodies: the tolerances are those of layer_test.cpp.
    for (const auto& [name, change, tolerance] :
         {Case{"whole", [](Scene& s) { s.model = ModelChoice::full; }, kSame},
          Case{"direct", [](Scene& s) { s.op = OperatorKind::direct; }, kSame},
          Case{"dense", [](Scene& s) { s.op = OperatorKind::dense; }, kSame},
          Case{"threads", [](Scene& s) { s.threads = 3; }, 0.0},
          Case{"projected gradients", [](Scene& s) { s.method = Method::projected_gradient; }, 1e-5}}) {
      SCOPED_TRACE(name);
      Scene other = scene;
      change(other);
      const Solution solution = certified(other);
      EXPECT_LE(relative_difference(solution.pressure, reference.pressure), tolerance);
      EXPECT_LE(relative_difference(solution.traction, reference.traction), tolerance);
    }
  }
}

/// Swapping the bodies reverses all loads, and here nothing else.
TEST(Coated, MayBeEitherBody) {
  Scene scene = coated_scene(24, coating_of(0.4, 2.0));
  scene.lower = {0.7 * paper::kYoungModulus, 0.2, scene.lower.coating};
  const Solution lower = certified(scene);
  std::swap(scene.lower, scene.upper);
  scene.steps[0].torsion = MomentRatio{-0.6};
  const Solution upper = certified(scene);
  EXPECT_LE(relative_difference(upper.pressure, lower.pressure), kSame);
  EXPECT_NEAR(upper.twist_angle / lower.twist_angle, -1.0, kSame);
}

/// The expected contact is that of the softer of layer and base, so that the contact is within the grid; and
/// between those of bodies that are all layer and all base.
TEST(Coated, NeedsNoExtent) {
  const auto radius = [](const Scene& scene) { return certified(scene).contact_radius; };
  for (const auto& [thickness, modulus, poisson_ratio] :
       {std::array{0.02, 0.2, 0.5}, std::array{0.5, 0.1, 0.4}, std::array{0.3, 20.0, 0.0},
        std::array{1.0, 3.0, -0.5}}) {
    Scene scene = coated_scene(96, coating_of(thickness, modulus, poisson_ratio));
    scene.extent.reset();
    scene.coupling = Coupling::none;
    const double coated = radius(scene);
    Scene plain = scene;
    plain.lower.coating.reset();
    const double base = radius(plain);
    plain.lower = {scene.lower.coating->young_modulus, scene.lower.coating->poisson_ratio};
    const double layer = radius(plain);
    EXPECT_GT(coated, 0.99 * std::min(base, layer)) << thickness;
    EXPECT_LT(coated, 1.01 * std::max(base, layer)) << thickness;
  }
}

TEST(Coated, MayHaveRigidBasesAndALayerBetweenTheBodies) {
  Scene scene = coated_scene(32, coating_of(0.5, 1.0));
  scene.upper.coating = scene.lower.coating;
  scene.upper.young_modulus = scene.lower.young_modulus = kRigidModulus;
  const Solution rigid = certified(scene);
  EXPECT_LT(rigid.contact_radius, paper::kContactRadius);
  scene.coupling = Coupling::none;
  const double compliance = paper::kContactRadius / paper::kYoungModulus;
  scene.layer = {&law_kinds().front(), {compliance, compliance}};
  EXPECT_GT(certified(scene).approach, rigid.approach);
}

}  // namespace
}  // namespace slipstick::solver
