#include <gmock/gmock.h>

#include <cmath>

#include "solver/tests/model_units.hpp"
#include "solver/tests/press.hpp"
#include "solver/tests/scene_file.hpp"
#include "solver/tests/torsion_bench.hpp"

/// Steps of a scene, one after the other.
namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using testing::HasSubstr;

/// The solution at the end of each step.
std::vector<ModelSolution> history(const Scene& scene) {
  std::vector<ModelSolution> steps;
  const ModelSolution last =
      solve_in_model_units(scene, [&](const ModelSolution& solution) { steps.push_back(solution); });
  EXPECT_EQ(last.status, Status::converged) << last.message;
  steps.resize(scene.steps.size(), last);
  return steps;
}

// --- along a line, without Poisson's effect: exact on the mesh ---

/// Two bodies with nu = 0 in an ellipse's contact at an angle to the grid, pushed along (0.6, 0.8) and not
/// turned. Then K11 = K22 = K33 and K12 = 0, and a history is a sum of pressures p(W) under loads W. Where
/// p(W) > 0, K p(W) + h is the approach; elsewhere it exceeds it, the less so the larger W is. Slip thus has
/// one line throughout, and one sense where a formula below names a step.
class Pushed : public testing::Test {
 protected:
  struct Part {
    double normal;
    double force;
  };

  Pushed() {
    Surface& surface = scene_.surfaces[0];
    surface.shape = Shape::ellipsoid;
    surface.radius_1 = 1.6 * paper::kRadius;
    surface.radius_2 = 0.7 * paper::kRadius;
    surface.angle = 0.5;
    scene_.upper.poisson_ratio = scene_.lower.poisson_ratio = 0.0;
    scene_.grid.extent = {1.8e-3, 1.8e-3};
    scene_.solver.tolerance = kGap;
  }

  /// Steps to parts of the load W and of the force mu W.
  void take_steps(const std::vector<Part>& parts) {
    scene_.steps.clear();
    for (const Part& part : parts) {
      const double size = part.force * scene_.contact.friction.coefficient * paper::kLoad;
      Step& step = scene_.steps.emplace_back();
      step.name = step.key = "step " + std::to_string(scene_.steps.size());
      step.normal = part.normal * paper::kLoad;
      step.torsion = Twist{0.0};
      step.force = {0.6 * size, 0.8 * size};
    }
  }

  /// mu p under a part of W, along the force.
  ArrayXd carried(double normal) const {
    const Index cells = scene_.grid.cells[0] * scene_.grid.cells[1];
    if (normal == 0.0) return ArrayXd::Zero(2 * cells);
    Scene scene = scene_;
    scene.steps = {Step{}};
    scene.steps[0].normal = normal * paper::kLoad;
    const ArrayXd bound = scene.contact.friction.coefficient * press(scene).solution.pressure;
    ArrayXd q(2 * cells);
    q << 0.6 * bound, 0.8 * bound;
    return q;
  }
  /// First loading by a force under a constant load (Cattaneo, Mindlin).
  ArrayXd loaded(double normal, double force) const { return carried(normal) - carried(normal - force); }

  void expect_traction(const ModelSolution& step, const ArrayXd& expected) const {
    EXPECT_LE(largest(step.tangential.traction - expected), kSame * largest(carried(1.0))) << step.loads.name;
  }

  Scene scene_ = paper_scene(24, 0.0);
};

TEST_F(Pushed, InTwoStepsAsInOne) {
  take_steps({{1.0, 0.4}, {1.0, 0.7}});
  const auto steps = history(scene_);
  expect_traction(steps[0], loaded(1.0, 0.4));
  expect_traction(steps[1], loaded(1.0, 0.7));
}

/// Masing's rule: slip starts again at the edge, against twice the friction.
TEST_F(Pushed, ReversesByMasingsRule) {
  take_steps({{1.0, 0.8}, {1.0, 0.3}, {1.0, -0.5}, {1.0, -0.8}, {1.0, 0.1}, {1.0, 0.8}});
  const auto steps = history(scene_);
  const ArrayXd peak = loaded(1.0, 0.8);
  expect_traction(steps[1], peak - 2.0 * loaded(1.0, 0.25));
  expect_traction(steps[2], peak - 2.0 * loaded(1.0, 0.65));
  expect_traction(steps[3], -peak);
  expect_traction(steps[4], -peak + 2.0 * loaded(1.0, 0.45));
  expect_traction(steps[5], peak);
  EXPECT_NEAR(steps[5].displacement[0] / steps[0].displacement[0], 1.0, kSame);
  EXPECT_NEAR(steps[3].displacement[1] / steps[0].displacement[1], -1.0, kSame);
}

TEST_F(Pushed, ForgetsSmallCyclesInAGreaterOne) {
  take_steps({{1.0, 0.7}, {1.0, 0.2}, {1.0, 0.5}, {1.0, 0.3}, {1.0, 0.7}, {1.0, -0.1}, {1.0, -0.7}});
  const auto steps = history(scene_);
  expect_traction(steps[2], loaded(1.0, 0.7) - 2.0 * loaded(1.0, 0.25) + 2.0 * loaded(1.0, 0.15));
  expect_traction(steps[4], loaded(1.0, 0.7));
  expect_traction(steps[5], loaded(1.0, 0.7) - 2.0 * loaded(1.0, 0.4));
  expect_traction(steps[6], -loaded(1.0, 0.7));
}

/// More pressure under the same force: the tractions that were there balance it, and nothing moves. A later
/// push slips at the new edge first, over what had stuck, until it has made up for the added load (Mindlin
/// and Deresiewicz 1953).
TEST_F(Pushed, KeepsItsTractionsWhileTheLoadRises) {
  take_steps({{0.6, 0.4}, {1.0, 0.4}, {1.0, 0.55}, {1.0, 0.9}});
  const auto steps = history(scene_);
  expect_traction(steps[1], loaded(0.6, 0.4));
  EXPECT_LE(std::abs(steps[1].dissipated), kSame * steps[0].dissipated);
  EXPECT_NEAR(steps[1].displacement[0] / steps[0].displacement[0], 1.0, kSame);
  expect_traction(steps[2], loaded(0.6, 0.4) + carried(1.0) - carried(0.85));
  expect_traction(steps[3], loaded(1.0, 0.9));
}

/// Under the same force a smaller load slips forward: only where it ends counts.
TEST_F(Pushed, SlipsOnWhileTheLoadFalls) {
  take_steps({{1.0, 0.4}, {0.7, 0.4}, {0.45, 0.4}});
  const auto steps = history(scene_);
  expect_traction(steps[1], loaded(0.7, 0.4));
  expect_traction(steps[2], loaded(0.45, 0.4));
  EXPECT_LT(steps[2].contact_cells, steps[0].contact_cells - 20);
  const ArrayXd outside = (steps[2].normal.pressure == 0.0).cast<double>().replicate(2, 1);
  EXPECT_TRUE((outside * steps[2].tangential.traction == 0.0).all());
}

TEST_F(Pushed, SlidesWhenTheLoadHasFallenTooFar) {
  take_steps({{1.0, 0.5}, {0.6, 0.5}, {0.45, 0.5}});
  const std::string refused = complaint([&] { solve_in_model_units(scene_); });
  EXPECT_THAT(refused, HasSubstr("step 3.force"));
  EXPECT_THAT(refused, HasSubstr("0.9 times these"));
  EXPECT_THAT(refused, HasSubstr("along (0.6, 0.8)"));
}

// --- torsion: exact but for the mesh ---

/// Cells across the contact; ends of the steps over the limit moment.
Scene twisted(Index cells, const std::vector<double>& moment_ratios) {
  Scene scene = paper_scene(cells, 0.0);
  scene.solver.tolerance = kGap;
  scene.steps.clear();
  for (const double ratio : moment_ratios) {
    Step& step = scene.steps.emplace_back();
    step.normal = paper::kLoad;
    step.torsion = MomentRatio{ratio};
  }
  return scene;
}

TEST(Step, ThatChangesNothingChangesNothing) {
  for (const bool with_force : {false, true}) {
    Scene scene = twisted(24, {0.6, 0.6});
    if (with_force) {
      for (Step& step : scene.steps) step.force = {30.0, -20.0};
    }
    const auto steps = history(scene);
    EXPECT_LE(relative_difference(steps[1].tangential.traction, steps[0].tangential.traction), kSame);
    EXPECT_LE(largest(steps[1].tangential.slip), kSame * largest(steps[0].tangential.slip));
    EXPECT_NEAR(steps[1].twist_angle / steps[0].twist_angle, 1.0, kSame);
    EXPECT_LE(std::abs(steps[1].dissipated), kSame * steps[0].dissipated);
  }
}

/// The part of the grid that a step is solved on follows its pressure and the one before.
TEST(Step, IsTheSameOnTheReducedGrid) {
  Scene scene = twisted(28, {0.5, 0.3, -0.6, 0.2});
  const std::array<double, 4> loads{0.5, 1.0, 0.4, 0.8};
  for (std::size_t k = 0; k < loads.size(); ++k) *scene.steps[k].normal *= loads[k];
  const auto reduced = history(scene);
  scene.solver.model = ModelChoice::full;
  const auto full = history(scene);
  for (std::size_t k = 0; k < loads.size(); ++k) {
    const ModelSolution& other = full[k];
    EXPECT_LE(relative_difference(other.tangential.traction, reduced[k].tangential.traction), 1e-7);
    EXPECT_NEAR(other.twist_angle / reduced[k].twist_angle, 1.0, 1e-7);
    EXPECT_NEAR(other.dissipated / reduced[k].dissipated, 1.0, 1e-7);
  }
}

/// However many steps have led there.
TEST(StickRadius, IsThatOfThePath) {
  const auto ends_at = [](int count, bool reversed) {
    std::vector<double> moments;
    for (int i = 1; i <= count; ++i) moments.push_back(0.8 * i / count);
    for (int i = 1; reversed && i <= count; ++i) moments.push_back(0.8 - 1.6 * i / count);
    return history(twisted(64, moments)).back();
  };
  const ModelSolution once = ends_at(1, false);
  const double cell = 2.0 * once.contact_radius / 60.0;
  double worst = 0.0;
  for (const bool reversed : {false, true}) {
    for (const int count : {2, 4, 16}) {
      worst = std::max(worst, std::abs(ends_at(count, reversed).stick_radius - once.stick_radius) / cell);
    }
  }
  EXPECT_LE(worst, 0.05);
}

TEST(Torsion, ReturnsToTheSameLoopAThousandTimes) {
  Scene scene = twisted(14, {0.8, -0.8});
  scene.cycles = 500;
  scene.solver.tolerance = 1e-10;
  std::vector<std::array<double, 2>> twists;
  std::vector<double> dissipated;
  const ModelSolution last = solve_in_model_units(scene, [&](const ModelSolution& step) {
    if (step.moment > 0.0) {
      twists.push_back({step.twist_angle, 0.0});
      dissipated.push_back(step.dissipated);
    } else {
      twists.back()[1] = step.twist_angle;
      dissipated.back() += step.dissipated;
    }
  });
  ASSERT_EQ(last.status, Status::converged) << last.message;
  ASSERT_EQ(twists.size(), 500U);
  EXPECT_EQ(last.cycle, 500);
  double twist_drift = 0.0;
  double energy_drift = 0.0;
  for (std::size_t k = 2; k < twists.size(); ++k) {
    for (const std::size_t end : {0U, 1U}) {
      twist_drift = std::max(twist_drift, std::abs(twists[k][end] / twists[1][end] - 1.0));
    }
    energy_drift = std::max(energy_drift, std::abs(dissipated[k] / dissipated[1] - 1.0));
  }
  EXPECT_NEAR(twists.back()[0] / twists.back()[1], -1.0, 1e-3);
  EXPECT_LE(twist_drift, kSame);
  EXPECT_LE(energy_drift, kSame);
}

// --- motions ---

/// Forces and moments that come and go in four steps.
Scene shaken() {
  Scene scene = twisted(20, {0.6, -0.2, 0.5, 0.0});
  const std::vector<std::array<double, 2>> forces{{20.0, 30.0}, {60.0, -10.0}, {-30.0, -30.0}, {10.0, 0.0}};
  for (std::size_t k = 0; k < forces.size(); ++k) scene.steps[k].force = forces[k];
  return scene;
}

/// Imposed motions are those since the first step began, as the ones that are found.
TEST(Motion, TakesTheSamePathAsItsLoads) {
  Scene scene = shaken();
  const auto loaded = history(scene);
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    Step& step = scene.steps[k];
    step.torsion = Twist{loaded[k].twist_angle};
    step.force = {};
    step.displacement = loaded[k].displacement;
  }
  const auto moved = history(scene);
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    EXPECT_LE(relative_difference(moved[k].tangential.traction, loaded[k].tangential.traction), kSame);
    EXPECT_NEAR(moved[k].dissipated / loaded[k].dissipated, 1.0, kSame);
    EXPECT_NEAR(moved[k].displacement[0] / loaded[k].displacement[0], 1.0, kRounding);
    EXPECT_NEAR(moved[k].displacement[1] / loaded[k].displacement[1], 1.0, kRounding);
  }
}

// --- energy ---

double in_energy_norm(const ModelSolution& solution, const ArrayXd& q) {
  const Model& model = solution.model;
  const auto op = make_operator(OperatorKind::direct, model.grid, tangential_kernel(), *model.law);
  ArrayXd u(q.size());
  op->apply(q, u);
  return (q * u).sum() * model.grid.cell_area() * model.moment_unit();
}

/// In each step: dissipated + stored + |change of q|_K^2/2 is what the loads at its end do. That is Coulomb's
/// law of the step, s.q = -mu p |s|, with s = K (change of q) less the rigid motion.
TEST(Energy, GoesIntoHeatAndElasticity) {
  const auto steps = history(shaken());
  ArrayXd before = ArrayXd::Zero(steps[0].tangential.traction.size());
  double stored = 0.0;
  double twist = 0.0;
  std::array<double, 2> at{};
  for (const ModelSolution& step : steps) {
    const ArrayXd change = step.tangential.traction - before;
    const double loads = step.moment * (step.twist_angle - twist) +
                         step.force[0] * (step.displacement[0] - at[0]) +
                         step.force[1] * (step.displacement[1] - at[1]);
    const double scale = step.dissipated + step.elastic_energy;
    EXPECT_NEAR(step.dissipated + step.elastic_energy - stored + 0.5 * in_energy_norm(step, change), loads,
                1e-11 * scale);
    EXPECT_NEAR(step.dissipated - step.work, step.certificate.gap * step.elastic_energy, 1e-13 * scale);
    EXPECT_LE(step.certificate.gap, kGap);
    EXPECT_GE(step.dissipated, 0.0);
    before = step.tangential.traction;
    stored = step.elastic_energy;
    twist = step.twist_angle;
    at = step.displacement;
  }
}

}  // namespace
}  // namespace slipstick::solver
