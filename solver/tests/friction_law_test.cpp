// Slip under a map of friction. Other laws and maps: same_answer_test.py, known_history_test.py, bad_scene_test.py.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "solver/input/tests/scratch_folder.hpp"
#include "solver/tests/fields.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Where nothing holds the surfaces they slip by all of their displacement less the body's motion.
TEST(FrictionMap, LetsCellsWithoutFrictionSlip) {
  Scene scene = paper_scene(24, 0.5);
  scene.lower = {70e9, 0.33};
  scene.steps.assign(2, scene.steps.front());
  scene.steps[1].torsion = MomentRatio{0.6};
  const auto file = std::filesystem::path(testing::TempDir()) / "friction_map.csv";
  std::ofstream(file) << table_of(24, 24, [](Index i, Index) { return i < 12 ? 0.0 : 1.0; });
  scene.contact.friction.map = file;
  const std::vector<Solution> steps = steps_of(scene);
  ASSERT_EQ(steps.size(), 2u);
  const Model model = make_model(scene);
  const Grid grid = model.grid_in_m();
  const Index cells = grid.cells();
  const double unit = model.length_unit / model.stress_unit;
  const auto moved = [&](const BlockKernel& kernel, const ArrayXd& field) {
    return ArrayXd(unit * elasticity(scene, model, Reduction(model.grid)).make(model.grid, kernel)->applied(field));
  };
  const ArrayXd pressed = moved(coupling_kernel(), steps[0].pressure);
  for (std::size_t k = 0; k < 2; ++k) {
    const RigidMotion before =
        k == 0 ? RigidMotion{} : RigidMotion{steps[0].displacement[0], steps[0].displacement[1], steps[0].twist_angle};
    ArrayXd slip =
        moved(tangential_kernel(), k == 0 ? steps[0].traction : ArrayXd(steps[1].traction - steps[0].traction));
    if (k == 0) slip += pressed;
    slip.head(cells) -= steps[k].displacement[0] - before.delta1;
    slip.tail(cells) -= steps[k].displacement[1] - before.delta2;
    slip -= (steps[k].twist_angle - before.twist) * rotation_field(grid);
    const ArrayXd contact = (steps[k].pressure > 0.0).cast<double>().replicate(2, 1);
    EXPECT_LE((contact * (steps[k].slip - slip)).abs().maxCoeff(), 1e-10 * slip.abs().maxCoeff());
    EXPECT_TRUE(((1.0 - contact) * steps[k].slip == 0.0).all());
    EXPECT_GT(norms(steps[k].slip).head(12 * 24).maxCoeff(), norms(steps[k].slip).tail(12 * 24).maxCoeff());
  }
}

}  // namespace
}  // namespace slipstick::solver
