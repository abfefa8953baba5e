#include <gtest/gtest.h>

#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

TEST(LoadParts, TheNormalLoadComesFirstWhileTheOthersStay) {
  Scene scene;
  scene.solver.substeps = 4;
  const Step before{.name = {}, .normal = 1000.0, .displacement = {}};
  Step step = before;
  step.normal = 800.0;
  step.torsion = Twist{2e-4};
  const LoadNumbers end{.twist_angle = 1e-4, .force = {3.0, 4.0}, .limit = {}};
  const std::vector<Step> parts = parts_of(scene, step, &before, end);
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_EQ(parts[0].normal, 900.0);
  EXPECT_EQ(parts[1].normal, 800.0);
  for (const std::size_t k : {0, 1}) {
    EXPECT_EQ(std::get<Twist>(parts[k].torsion).value, 1e-4);
    EXPECT_EQ(parts[k].force, end.force);
  }
  EXPECT_NEAR(std::get<Twist>(parts[2].torsion).value, 1.5e-4, 1e-19);
  EXPECT_EQ(parts[2].normal, 800.0);
}

/// The answers of resumed histories are tested with the program.
TEST_F(SceneFile, AStateOfAnotherSceneIsRefused) {
  const std::string steps = "[[step]]\nforce = [50, 0]\n[[step]]\nmoment_ratio = 0.5\n";
  const Scene scene = read(kShortScene + steps, {"load.moment_ratio=0"});
  std::shared_ptr<HistoryState> left;
  solve(scene, {.observer = {.state = [&](const HistoryState& at) { left = std::make_shared<HistoryState>(at); }}});
  const Scene other = read(kShortScene + steps, {"load.moment_ratio=0", "grid.cells=[12,12]"});
  EXPECT_THROW(solve(other, {.resumed = left}), std::invalid_argument);
  for (const std::size_t finished : {0U, 2U, 3U}) {
    left->finished = finished;
    EXPECT_THROW(solve(scene, {.resumed = left}), std::invalid_argument) << finished;
  }
}

/// The solutions at the ends of four steps, in which forces and moments come and go.
std::vector<ModelSolution> shaken() {
  Scene scene = paper_scene(20, 0.0);
  scene.solver.tolerance = kGap;
  scene.steps.clear();
  for (const auto& [ratio, force1, force2] : {std::array{0.6, 20.0, 30.0}, std::array{-0.2, 60.0, -10.0},
                                              std::array{0.5, -30.0, -30.0}, std::array{0.0, 10.0, 0.0}}) {
    Step& step = scene.steps.emplace_back();
    step.normal = paper::kLoad;
    step.torsion = MomentRatio{ratio};
    step.force = {force1, force2};
  }
  std::vector<ModelSolution> steps;
  solve_in_model_units(scene, [&](const ModelSolution& solution) { steps.push_back(solution); });
  return steps;
}

double in_energy_norm(const ModelSolution& solution, const Eigen::ArrayXd& q) {
  const Model& model = solution.model;
  const auto op = make_operator(OperatorKind::direct, model.grid, tangential_kernel(), *model.law);
  return (q * op->applied(q)).sum() * model.grid.cell_area() * model.moment_unit();
}

/// In each step: dissipated + stored + |change of q|_K^2/2 is the work of the loads at its end. This follows
/// from Coulomb's law of the step, s.q = -mu p |s|, with s = K (change of q) less the rigid motion.
TEST(Energy, GoesIntoHeatAndElasticity) {
  const auto steps = shaken();
  ASSERT_EQ(steps.size(), 4U);
  Eigen::ArrayXd before = Eigen::ArrayXd::Zero(steps[0].tangential.traction.size());
  double stored = 0.0;
  double twist = 0.0;
  std::array<double, 2> at{};
  for (const ModelSolution& step : steps) {
    const Eigen::ArrayXd change = step.tangential.traction - before;
    const double loads = step.moment * (step.twist_angle - twist) + step.force[0] * (step.displacement[0] - at[0]) +
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
