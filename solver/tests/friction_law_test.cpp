// Friction laws other than mu p: their limits, their agreement with Coulomb's law, maps and refusals.

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "solver/model/make_model.hpp"
#include "solver/solve.hpp"
#include "solver/tests/fields.hpp"
#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using namespace testing;

constexpr double kStrength = 0.4 * paper::kFriction * paper::kPeakPressure;

Scene scene_under(FrictionKind kind, double moment_ratio = 0.7) {
  Scene scene = paper_scene(32, moment_ratio);
  scene.solver.tolerance = 1e-12;
  scene.contact.friction.kind = kind;
  scene.contact.friction.shear_strength = kStrength;
  return scene;
}

void expect_same_tractions(const Solution& a, const Solution& b, double factor = 1.0) {
  EXPECT_LE(relative_difference(a.traction, factor * b.traction), kSame);
  EXPECT_NEAR(a.twist_angle / (factor * b.twist_angle), 1.0, kSame);
}

/// A history at constant pressure follows Masing's rule: back to the load's negative the tractions turn over.
TEST(FrictionLaw, FollowsMasingsRule) {
  Scene scene = scene_under(FrictionKind::tresca);
  scene.steps.assign(2, scene.steps.front());
  scene.steps[1].torsion = MomentRatio{-0.7};
  const std::vector<Solution> steps = steps_of(scene);
  ASSERT_EQ(steps.size(), 2u);
  expect_same_tractions(steps[1], steps[0], -1.0);
}

class FrictionMap : public testing::Test {
 protected:
  /// A map of the paper's 24 cells by a function of row and column.
  template <typename Factor>
  Scene with_map(const Factor& factor, Index rows = 24) {
    Scene scene = paper_scene(24, 0.6);
    scene.solver.tolerance = 1e-12;
    return with_map(scene, factor, {rows, 24});
  }
  template <typename Factor>
  Scene with_map(Scene scene, const Factor& factor, const std::array<Index, 2>& cells) {
    std::ofstream(file_) << table_of(cells[0], cells[1], factor);
    scene.contact.friction.map = file_;
    return scene;
  }
  std::filesystem::path file_ = std::filesystem::path(testing::TempDir()) / "friction_map.csv";
};

/// Where nothing holds the surfaces they slip by all of their displacement less the body's motion.
TEST_F(FrictionMap, LetsCellsWithoutFrictionSlip) {
  Scene scene = paper_scene(24, 0.5);
  scene.lower = {70e9, 0.33};
  scene.steps.assign(2, scene.steps.front());
  scene.steps[1].torsion = MomentRatio{0.6};
  scene = with_map(
      scene, [](Index i, Index) { return i < 12 ? 0.0 : 1.0; }, scene.grid.cells);
  const std::vector<Solution> steps = steps_of(scene);
  ASSERT_EQ(steps.size(), 2u);
  const Model model = make_model(scene);
  const Grid grid = model.grid_in_m();
  const Index cells = grid.cells();
  const double unit = model.length_unit / model.stress_unit;
  const auto moved = [&](const BlockKernel& kernel, const ArrayXd& field) {
    ArrayXd u(2 * cells);
    elasticity(scene, model, Reduction(model.grid)).make(model.grid, kernel)->apply(field, u);
    return ArrayXd(unit * u);
  };
  const ArrayXd pressed = moved(coupling_kernel(), steps[0].pressure);
  for (std::size_t k = 0; k < 2; ++k) {
    const RigidMotion before =
        k == 0 ? RigidMotion{}
               : RigidMotion{steps[0].displacement[0], steps[0].displacement[1], steps[0].twist_angle};
    ArrayXd slip = moved(tangential_kernel(),
                         k == 0 ? steps[0].traction : ArrayXd(steps[1].traction - steps[0].traction));
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

/// A moment that nothing carries is refused, and none at all is not.
TEST_F(FrictionMap, OrALawWithoutFrictionCarriesNoMoment) {
  const auto one_cell = [](Index i, Index j) { return i == 15 && j == 10 ? 1.0 : 0.0; };
  std::vector<Scene> scenes;
  for (const FrictionKind kind : {FrictionKind::coulomb, FrictionKind::capped, FrictionKind::power}) {
    scenes.push_back(scene_under(kind));
    scenes.back().contact.friction.coefficient = 0.0;
  }
  for (int k = 0; k < 5; ++k) {
    Scene scene = k < 3   ? scenes[static_cast<std::size_t>(k)]
                  : k < 4 ? with_map([](Index, Index) { return 0.0; })
                          : with_map(one_cell);
    scene.steps.push_back(scene.steps.front());
    scene.steps[0].torsion = MomentRatio{0.0};
    scene.steps[1].key = "step[1]";
    EXPECT_THAT(complaint([&] { solve(scene); }), says("step[1].moment_ratio", "no moment"));
    scene.steps.pop_back();
    EXPECT_EQ(solve(scene).status, Status::converged);
    scene.steps[0].torsion = Twist{1e-3};
    const Solution turned = solve(scene);
    EXPECT_EQ(turned.status, Status::converged) << turned.message;
    EXPECT_EQ(turned.twist_angle, 1e-3);
    EXPECT_NEAR(turned.moment, 0.0, 1e-12);
  }
}

TEST_F(FrictionMap, IsRefusedWithTheWrongSizeOrNumber) {
  const auto one = [](Index, Index) { return 1.0; };
  EXPECT_THAT(complaint([&] { solve(with_map(one, 23)); }),
              says("friction_map.csv", "23 x 24", "allowed: 24 x 24"));
  const auto negative = [](Index i, Index j) { return i == 3 && j == 5 ? -1.0 : 1.0; };
  EXPECT_THAT(complaint([&] { solve(with_map(negative)); }), HasSubstr("row 4, column 6: -1; allowed: zero"));
}

TEST(FrictionLaw, IsRefusedWhereItIsInfinite) {
  Scene scene = scene_under(FrictionKind::power);
  scene.contact.friction.exponent = 3.0;
  scene.contact.friction.coefficient = 1e300;
  EXPECT_THAT(complaint([&] { solve(scene); }), HasSubstr("contact.friction"));
}

TEST(FrictionLaw, SaysWhichNumbersItTakes) {
  for (const auto& [numbers, said] :
       {std::pair{"friction_law = \"tresca\"\nshear_strength = 1e8\nfriction = 0.1\n",
                  "contact.friction = 0.1: allowed: left out: friction_law = \"tresca\" takes "
                  "contact.shear_strength and no contact.friction"},
        {"shear_strength = 1e8\nfriction = 0.1\n", "no contact.shear_strength"},
        {"friction_law = \"capped\"\nshear_strength = 1e8\nfriction = 0.1\nfriction_exponent = 2\n",
         "no contact.friction_exponent"},
        {"friction_law = \"capped\"\nshear_strength = 1e8\nfriction = 0.1\n", ""}}) {
    std::string text = kShortScene;
    text.replace(text.find("friction = 0.1\n"), 15, numbers);
    const std::string complained = complaint([&] { read_scene_text(text, "a.toml"); });
    EXPECT_THAT(complained, says(said));
    EXPECT_EQ(complained.empty(), std::string(said).empty());
  }
}

}  // namespace
}  // namespace slipstick::solver
