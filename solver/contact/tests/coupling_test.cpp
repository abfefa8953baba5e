#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "solver/contact/full_coupling.hpp"
#include "solver/tests/limits.hpp"
#include "solver/tests/torsion_bench.hpp"

/// Dissimilar bodies: pressure moves the surfaces along each other, shear opens and closes the gap.
namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using std::numbers::pi;

const Material kRigid{kInfinity, 0.0};
/// G = 1/2 and nu = 0 in units of Pa: Dundurs' beta is 1/2 under a rigid body.
const Material kSpences{1.0, 0.0};

ArrayXd applied(const BlockKernel& kernel, const Model& model, const ArrayXd& traction) {
  return applied(*make_operator(OperatorKind::direct, model.grid, kernel, *model.law), traction);
}

ModelSolution solved(const Scene& scene) {
  ModelSolution solution = solve_in_model_units(scene);
  EXPECT_EQ(solution.status, Status::converged) << solution.message;
  return solution;
}

// --- kernels ---

/// Betti: the work of shear in the displacements by pressure equals the work of pressure in the displacements by shear.
TEST(ShearKernel, IsReciprocalToThePressures) {
  const SharedLaw law = half_spaces({1.0, 0.2}, {3.0, 0.35});
  for (const Grid& grid : {Grid{9, 6, 1.0, 0.7}, Grid{16, 16, 1.0, 1.0}, Grid{1, 5, 1.0, 1.0}}) {
    const ArrayXd q = random_field(2 * grid.cells(), 1);
    const ArrayXd p = random_field(grid.cells(), 2);
    for (const OperatorKind kind : {OperatorKind::dcfft, OperatorKind::direct, OperatorKind::dense}) {
      const ArrayXd along = applied(*make_operator(kind, grid, coupling_kernel(), *law), p);
      ShearOpening opening({.law = law, .kind = kind}, grid);
      const ArrayXd normal = opening(q);
      const double scale = std::sqrt(q.square().sum() * along.square().sum());
      EXPECT_NEAR((q * along).sum(), (p * normal).sum(), 1e-13 * scale);
      EXPECT_NEAR((applied(*make_operator(kind, grid, shear_kernel(), *law), q) + normal).abs().maxCoeff(), 0.0,
                  1e-13 * largest(normal));
    }
  }
}

// --- full coupling ---

/// Signorini's and Coulomb's laws, all displacements summed afresh.
TEST(FullCoupling, HoldsBothLawsAtOnce) {
  for (const double tolerance : {1e-8, 1e-12}) {
    Scene scene = paper_scene(24, 0.4);
    scene.lower.poisson_ratio = 0.1;
    scene.upper.young_modulus = kInfinity;
    scene.grid.extent = {1.2e-3, 1.2e-3};
    scene.contact.friction.coefficient = 0.3;
    scene.contact.coupling = Coupling::full;
    scene.solver.tolerance = tolerance;
    scene.steps[0].force = {30.0, 10.0};
    const ModelSolution solution = solved(scene);
    const Model& model = solution.model;
    const Index cells = model.grid.cells();
    const ArrayXd& p = solution.normal.pressure;
    const ArrayXd& q = solution.tangential.traction;

    const ArrayXd opening = applied(normal_kernel(), model, p) - applied(shear_kernel(), model, q) + model.gap;
    const double lowest = opening.minCoeff();
    const double energy = 0.5 * (p * applied(normal_kernel(), model, p)).sum();
    EXPECT_GE(p.minCoeff(), 0.0);
    const double gap = (p * (opening - lowest)).sum() / energy;
    EXPECT_LE(gap, tolerance + 1e-13);
    EXPECT_NEAR(solution.normal.complementarity, gap, 1e-3 * gap + 1e-14) << "of the returned fields";
    EXPECT_NEAR(lowest, solution.normal.approach, std::sqrt(tolerance) * lowest);
    EXPECT_NEAR(solution.normal_load / paper::kLoad, 1.0, kRounding);

    ArrayXd slip = applied(tangential_kernel(), model, q) + applied(coupling_kernel(), model, p) -
                   solution.tangential.twist * rotation_field(model.grid);
    slip.head(cells) -= solution.tangential.displacement[0];
    slip.tail(cells) -= solution.tangential.displacement[1];
    slip *= (p > 0.0).cast<double>().replicate(2, 1);
    const double area = model.grid.cell_area();
    const Certificate fresh =
        certify({q, applied(tangential_kernel(), model, q), slip}, model.friction.bound(p), rotation_field(model.grid),
                0.4 * solution.moment_limit / (area * model.moment_unit()),
                {30.0 / (area * model.force_unit()), 10.0 / (area * model.force_unit())});
    EXPECT_LE(fresh.gap, tolerance + 1e-13);
    EXPECT_LE(fresh.friction_bound, kRounding);
    EXPECT_LE(std::max(fresh.moment, fresh.force), kRounding);
    EXPECT_GT(solution.turns, 1);
    EXPECT_EQ(solution.contact_radius, solution.contact_radius_counted) << "no longer Hertz's pressure";
  }
}

/// The same loads again change nothing, and the approach holds the shear's part in the first step too.
TEST(FullCoupling, OfAFewCellsHasTheSameApproachInItsNextStep) {
  for (const auto& [load, extent] : {std::pair{1e-3, 3e-4}, {0.1, 5e-4}, {3.0, 1e-3}}) {
    Scene scene = paper_scene(16, 0.5);
    scene.grid.cells = {16, 15};
    scene.grid.extent = {extent, extent};
    scene.lower = {10e9, 0.1};
    scene.contact.friction = 0.3;
    scene.contact.coupling = Coupling::full;
    scene.solver.tolerance = 1e-12;
    scene.steps[0].normal = load;
    scene.steps.push_back(scene.steps.front());
    std::vector<double> approach;
    solve_in_model_units(scene, [&](const ModelSolution& at) { approach.push_back(at.normal.approach); });
    ASSERT_EQ(approach.size(), 2U);
    EXPECT_NEAR(approach[0] / approach[1], 1.0, 1e-11) << load;
  }
}

/// A strength bounds a cell as much as soon as it touches. Where its shear then opens it no state is left,
/// and that is said.
TEST(FullCoupling, UnderAStrengthSaysThatCellsComeAndGo) {
  Scene scene = paper_scene(24, 0.5);
  scene.lower = {10e9, 0.1};
  scene.contact.friction.kind = FrictionKind::tresca;
  scene.contact.friction.shear_strength = 1e9;
  scene.contact.coupling = Coupling::full;
  const ModelSolution solution = solve_in_model_units(scene);
  EXPECT_EQ(solution.status, Status::not_converged);
  EXPECT_THAT(solution.message, testing::HasSubstr("cells at the edge come into contact and leave it again"));
}

/// Coarse grids are coupled first, so that a fine mesh takes no more turns. Without them 256 cells take 42
/// applications and 512 cells 60.
TEST(FullCoupling, TakesFewApplicationsOnFineMeshes) {
  for (const Index cells : {64, 128, 256}) {
    Scene scene = paper_scene(cells, 0.5);
    scene.lower = {70e9, 0.33};
    scene.contact.friction.coefficient = 0.3;
    scene.contact.coupling = Coupling::full;
    const ModelSolution solution = solved(scene);
    EXPECT_LE(solution.operator_applications, 36.0) << cells;
    EXPECT_LE(solution.pressure_applications, 32.0) << cells;
  }
}

// --- Goodman, Spence ---

Scene spence(Shape shape, Coupling coupling, Index cells) {
  Scene scene;
  scene.source = "spence.toml";
  scene.surfaces[0].shape = shape;
  scene.surfaces[0].radius = shape == Shape::sphere ? 100.0 : 1.0;
  scene.lower = kSpences;
  scene.upper = kRigid;
  scene.contact.friction.coefficient = 0.2986;
  scene.contact.coupling = coupling;
  scene.grid.cells = {cells, cells};
  scene.steps[0].normal = 0.02;
  scene.steps[0].torsion = MomentRatio{0.0};
  return scene;
}

/// The scenes spence and spence_sphere: the first turn starts from coarse grids, a turn from the last one,
/// and is solved no better than it has to be. Turns in full from nothing took 410 and 1,060 applications at
/// 128 cells, and as many here.
TEST(SpenceScenes, CostFewApplications) {
  EXPECT_LE(solved(spence(Shape::flat_punch, Coupling::full, 64)).operator_applications, 45.0);
  Scene sphere = spence(Shape::sphere, Coupling::full, 64);
  sphere.steps.resize(4, sphere.steps[0]);
  for (std::size_t i = 0; i < 4; ++i) {
    sphere.steps[i].normal = *sphere.steps[3].normal * std::pow(1.5, static_cast<double>(i) - 3.0);
  }
  double applications = 0.0;
  solve_in_model_units(sphere, [&](const ModelSolution& step) { applications += step.operator_applications; });
  EXPECT_LE(applications, 200.0);
}

/// With friction enough to hold everything a punch is bonded: stiffer than without friction by ln(3 - 4 nu)
/// (1 - nu)/(1 - 2 nu), ln 3 at nu = 0 (Mossakowski 1954, Spence 1968). The mesh's error is of first order.
TEST(BondedPunch, IsStifferByTheLogarithmOfThree) {
  std::vector<double> errors;
  for (const Index cells : {20, 36}) {  // 8 and 16 cells in a radius
    Scene scene = spence(Shape::flat_punch, Coupling::full, cells);
    scene.contact.friction.coefficient = 3.0;
    const ModelSolution bonded = solved(scene);
    EXPECT_EQ(bonded.stick_cells, bonded.contact_cells);
    scene.contact.coupling = Coupling::none;
    errors.push_back(solved(scene).approach / (std::log(3.0) * bonded.approach) - 1.0);
  }
  EXPECT_LT(std::abs(errors[1]), 4e-3);
  EXPECT_NEAR(2.0 * errors[1] - errors[0], 0.0, 3e-4);
}

}  // namespace
}  // namespace slipstick::solver
