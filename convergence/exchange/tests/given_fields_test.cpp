// Pressure and tractions that another program found, described as an answer.

#include "convergence/exchange/given_fields.hpp"

#include "solver/input/input_error.hpp"
#include "solver/solve.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::convergence {
namespace {

/// The paper's sphere on cells that are no squares, with room for softer bodies.
solver::Scene scene_with(std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(), {"grid.cells=[24,20]", "grid.extent=[0.0014,0.0015]"});
  return solver::read_scene_text(solver::kShortScene, "sphere.toml", overrides);
}

GivenFields fields_of(const solver::Solution& solution) { return {solution.pressure, solution.traction}; }

class GivenFieldsOf : public testing::TestWithParam<std::vector<std::string>> {};

// Under the solve's own motion, and no other, the fields of a solve satisfy Coulomb's law.
TEST_P(GivenFieldsOf, ASolveAreThatSolve) {
  const solver::Scene scene = scene_with(GetParam());
  const solver::Solution solved = solver::solve(scene);
  const solver::Solution described = describe_given(scene, fields_of(solved));
  const double twist = std::max(std::abs(solved.twist_angle), 1e-12);
  EXPECT_NEAR(described.twist_angle, solved.twist_angle, 1e-5 * twist);
  const double size = std::hypot(solved.displacement[0], solved.displacement[1]);
  for (const std::size_t k : {0, 1}) {
    EXPECT_NEAR(described.displacement[k], solved.displacement[k],
                1e-5 * std::max(size, twist * solved.contact_radius));
  }
  EXPECT_LE(described.certificate.gap, 1e-6);
  EXPECT_LE(described.certificate.moment, 1e-7);
  EXPECT_LE(described.certificate.force, 1e-7);
  EXPECT_NEAR(described.approach, solved.approach, 1e-8 * solved.approach);
  EXPECT_LE(described.pressure_complementarity, 1e-8);
  EXPECT_NEAR(described.moment, solved.moment, 1e-12 * solved.moment_limit);
  EXPECT_NEAR(described.elastic_energy, solved.elastic_energy, 1e-9 * solved.elastic_energy);
  EXPECT_NEAR(described.dissipated, solved.dissipated, 1e-4 * solved.dissipated);
  EXPECT_EQ(described.contact_cells, solved.contact_cells);
}

INSTANTIATE_TEST_SUITE_P(
    Solved, GivenFieldsOf,
    testing::Values(std::vector<std::string>{},
                    std::vector<std::string>{"load.moment_ratio=0.7", "load.force=[40.0,20.0]"},
                    std::vector<std::string>{"load.twist=1e-3", "load.displacement=[1e-7,2e-7]"},
                    std::vector<std::string>{"lower.young_modulus=70e9", "upper.poisson_ratio=0.2"}));

// A field that is a part of the right one has as much less moment, and Coulomb's law does not hold in any
// motion.
TEST(GivenFields, ThatAreTooSmallMissTheirLoad) {
  const solver::Scene scene = scene_with({});
  GivenFields fields = fields_of(solver::solve(scene));
  fields.traction *= 0.9;
  const solver::Solution described = describe_given(scene, fields);
  EXPECT_NEAR(described.certificate.moment, 0.09, 1e-6);
  EXPECT_GE(described.certificate.gap, 1e-2);
}

TEST(GivenFields, OfAHistoryOrAnotherGridAreRefused) {
  const solver::Scene scene = scene_with({});
  EXPECT_THROW(describe_given(scene, {Eigen::ArrayXd::Ones(10), Eigen::ArrayXd::Zero(20)}),
               std::invalid_argument);
  solver::Scene history = scene;
  history.steps.push_back(history.steps.front());
  EXPECT_THROW(describe_given(history, {}), solver::InputError);
}

// E*, G and nu of a pair, by hand.
TEST(PosedScene, HasThePairsConstants) {
  const solver::Scene scene = scene_with({"lower.young_modulus=70e9", "lower.poisson_ratio=0.25"});
  const PosedScene posed = pose(scene, true);
  const double upper = 210e9 / 2.6;
  const double lower = 70e9 / 2.5;
  EXPECT_NEAR(posed.shear_modulus, 1.0 / (1.0 / upper + 1.0 / lower), 1.0);
  EXPECT_NEAR(posed.contact_modulus, 1.0 / (0.91 / 210e9 + 0.9375 / 70e9), 1.0);
  EXPECT_NEAR(posed.poisson_ratio, (0.3 / upper + 0.25 / lower) * posed.shear_modulus, 1e-12);
  EXPECT_NEAR(posed.mismatch, 0.5 / lower - 0.4 / upper, 1e-22);
  EXPECT_EQ(posed.pressure.size(), 0);
  const solver::Solution solved = solver::solve(scene);
  EXPECT_NEAR(posed.moment_limit, solved.moment_limit, 1e-9 * solved.moment_limit);
}

// Surfaces of one material on unlike bases: the pressure moves them by different amounts.
TEST(PosedScene, IsCoupledUnderALayerOnOneBody) {
  const solver::Scene scene = scene_with(
      {"lower.young_modulus=70e9", "lower.layer={thickness=1e-4,young_modulus=210e9,poisson_ratio=0.3}"});
  const PosedScene posed = pose(scene, false);
  EXPECT_EQ(posed.mismatch, 0.0);
  EXPECT_TRUE(posed.coupled);
  EXPECT_FALSE(pose(scene_with({}), false).coupled);
}

}  // namespace
}  // namespace slipstick::convergence
