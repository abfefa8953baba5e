// Friction laws other than mu p: their limits, their agreement with Coulomb's law, maps and refusals.

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "solver/input/tests/complaint.hpp"
#include "solver/model/make_model.hpp"
#include "solver/solve.hpp"
#include "solver/tests/fields.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using namespace testing;

constexpr double kStrength = 0.4 * paper::kFriction * paper::kPeakPressure;

const std::string kBodies =
    "[upper]\nshape = \"sphere\"\nradius = 0.018\nyoung_modulus = 210e9\npoisson_ratio = 0.3\n"
    "[lower]\nyoung_modulus = 210e9\npoisson_ratio = 0.3\n[load]\nnormal = 1000\nmoment_ratio = 0.5\n"
    "[grid]\ncells = [32, 32]\n";

Scene scene_under(FrictionKind kind, double moment_ratio = 0.7) {
  Scene scene = paper_scene(32, moment_ratio);
  scene.solver.tolerance = 1e-12;
  scene.contact.friction.kind = kind;
  scene.contact.friction.shear_strength = kStrength;
  return scene;
}

Solution solved_under(const Scene& scene) {
  const Solution solution = solve(scene);
  EXPECT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_LE(solution.certificate.gap, scene.solver.tolerance);
  return solution;
}

void expect_same_tractions(const Solution& a, const Solution& b, double factor = 1.0) {
  EXPECT_LE(relative_difference(a.traction, factor * b.traction), kSame);
  EXPECT_NEAR(a.twist_angle / (factor * b.twist_angle), 1.0, kSame);
}

TEST(FrictionLaw, TrescasSlippingCellsCarryItsStrength) {
  const Solution solution = solved_under(scene_under(FrictionKind::tresca));
  const ArrayXd size = norms(solution.traction);
  EXPECT_GT(solution.stick_cells, 0);
  for (Index cell = 0; cell < size.size(); ++cell) {
    const bool slips = solution.pressure[cell] > 0.0 && solution.stick[cell] == 0.0;
    EXPECT_TRUE(solution.pressure[cell] > 0.0 || size[cell] == 0.0);
    EXPECT_TRUE(!slips || std::abs(size[cell] / kStrength - 1.0) <= 1e-9);
  }
  // The limit moment is the strength times the sum of r over the contact.
  const ArrayXd x1 = cell_x1(solution.grid);
  const ArrayXd x2 = cell_x2(solution.grid);
  const ArrayXd contact = (solution.pressure > 0.0).cast<double>();
  const double arms = (contact * (x1.square() + x2.square()).sqrt()).sum() * solution.grid.cell_area();
  EXPECT_NEAR(solution.moment_limit / (kStrength * arms), 1.0, 1e-12);
}

TEST(FrictionLaw, IsCoulombsWithTheFirstPowerAndWithAHighCap) {
  const Solution coulomb = solved_under(scene_under(FrictionKind::coulomb));
  Scene power = scene_under(FrictionKind::power);
  power.contact.friction.exponent = 1.0;
  expect_same_tractions(solved_under(power), coulomb);
  Scene capped = scene_under(FrictionKind::capped);
  capped.contact.friction.shear_strength = 1.1 * paper::kFriction * paper::kPeakPressure;
  expect_same_tractions(solved_under(capped), coulomb);
}

TEST(FrictionLaw, IsTrescasWithALowCapOrPower) {
  const Solution tresca = solved_under(scene_under(FrictionKind::tresca));
  Scene capped = scene_under(FrictionKind::capped);
  capped.contact.friction.coefficient = 1e6;
  expect_same_tractions(solved_under(capped), tresca);
  Scene power = scene_under(FrictionKind::power);
  power.contact.friction.exponent = 1e-6;
  power.contact.friction.coefficient = kStrength;
  const Solution nearly = solved_under(power);
  EXPECT_LE(relative_difference(nearly.traction, tresca.traction), 1e-4);  // p^1e-6 of 1 Pa to 2e9 Pa
}

TEST(FrictionLaw, IsTheSameOnTheWholeGrid) {
  for (const FrictionKind kind : {FrictionKind::tresca, FrictionKind::power}) {
    Scene scene = scene_under(kind, 0.5);
    scene.contact.friction.exponent = 0.6;
    scene.solver.tolerance = 1e-10;
    const Solution reference = solved_under(scene);
    scene.solver.model = ModelChoice::full;
    EXPECT_LE(relative_difference(solved_under(scene).traction, reference.traction), 1e-6);
  }
}

/// A history at constant pressure follows Masing's rule: back to the load's negative the tractions turn over.
TEST(FrictionLaw, FollowsMasingsRule) {
  Scene scene = scene_under(FrictionKind::tresca);
  scene.steps.assign(2, scene.steps.front());
  scene.steps[1].torsion = MomentRatio{-0.7};
  std::vector<Solution> steps;
  SolveOptions options;
  options.observer.step = [&](const Solution& step) { steps.push_back(step); };
  solve(scene, options);
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
    std::ofstream stream(file_);
    for (Index i = 0; i < cells[0]; ++i) {
      for (Index j = 0; j < cells[1]; ++j) stream << (j > 0 ? "," : "") << factor(i, j);
      stream << '\n';
    }
    scene.contact.friction.map = file_;
    return scene;
  }
  static void push_then_twist(Scene& scene) {
    scene.steps.assign(2, scene.steps.front());
    scene.steps[0].torsion = MomentRatio{0.0};
    scene.steps[0].force = scene.steps[1].force = {40.0, 10.0};
  }

  std::filesystem::path file_ = std::filesystem::path(testing::TempDir()) / "friction_map.csv";
};

TEST_F(FrictionMap, OfOneNumberIsACoefficient) {
  const Solution mapped = solved_under(with_map([](Index, Index) { return 2.0; }));
  Scene scene = with_map([](Index, Index) { return 2.0; });
  scene.contact.friction = 2.0 * paper::kFriction;
  expect_same_tractions(mapped, solved_under(scene));
}

TEST_F(FrictionMap, OfOnesChangesNoDigit) {
  using Change = void (*)(Scene&);
  const std::initializer_list<std::pair<const char*, Change>> changes{
      {"as it is", [](Scene&) {}},
      {"unlike bodies", [](Scene& scene) { scene.lower.young_modulus = 70e9; }},
      {"full coupling",
       [](Scene& scene) {
         scene.lower.young_modulus = 70e9;
         scene.contact.coupling = Coupling::full;
       }},
      {"all of the model", [](Scene& scene) { scene.solver.model = ModelChoice::full; }},
      {"a force and steps", push_then_twist},
      {"parts of steps",
       [](Scene& scene) {
         push_then_twist(scene);
         scene.solver.substeps = 2;
       }},
      {"an oblong grid",
       [](Scene& scene) {
         scene.grid.cells = {27, 16};
         push_then_twist(scene);
       }},
      {"off the centre",
       [](Scene& scene) {
         scene.surfaces.front().at = {1.3e-4, -0.4e-4};
         scene.grid.extent = {1.6e-3, 1.4e-3};
       }},
      {"a strength", [](Scene& scene) { scene.contact.friction.kind = FrictionKind::tresca; }},
      {"a rough sphere", [](Scene& scene) {
         scene.surfaces.push_back(scene.surfaces.front());
         scene.surfaces.back().shape = Shape::roughness;
         scene.surfaces.back().roughness = {
             .seed = 1, .hurst = 0.8, .longest = 4e-4, .shortest = 1e-4, .rms_slope = 1e-3, .period = 2e-3};
         scene.grid.extent = {1.4e-3, 1.4e-3};
       }}};
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    Scene scene = paper_scene(24, 0.6);
    scene.contact.friction.shear_strength = kStrength;
    change(scene);
    const Solution plain = solve(scene);
    const Solution mapped = solve(with_map(
        scene, [](Index, Index) { return 1; }, scene.grid.cells));
    EXPECT_EQ(plain.status, Status::converged);
    EXPECT_TRUE((mapped.traction == plain.traction).all());
    EXPECT_TRUE((mapped.slip == plain.slip).all());
    EXPECT_EQ(mapped.twist_angle, plain.twist_angle);
    EXPECT_EQ(mapped.resolution.absolute, plain.resolution.absolute);
    EXPECT_EQ(mapped.resolution.step, plain.resolution.step);
  }
}

TEST_F(FrictionMap, GivesPressureItsAsymmetryUnderFullCoupling) {
  Scene scene = paper_scene(20, 0.5);
  scene.lower.young_modulus = 70e9;
  scene.contact.coupling = Coupling::full;
  scene.solver.tolerance = 1e-12;
  scene = with_map(
      scene, [](Index i, Index j) { return 0.25 * static_cast<double>((3 * i + j) % 5); }, scene.grid.cells);
  const Solution solution = solved_under(scene);
  EXPECT_GT((solution.pressure - solution.pressure.reverse()).abs().maxCoeff(),
            1e-4 * solution.pressure.maxCoeff());
  scene.solver.model = ModelChoice::full;
  expect_same_tractions(solved_under(scene), solution);
}

/// A load that grows and shrinks again leaves tractions that have the map's symmetry, not that of the cells
/// that are left.
TEST_F(FrictionMap, IsAsAsymmetricAfterALoadThatHasBeenLarger) {
  Scene scene = paper_scene(24, 0.6);
  scene.steps.assign(3, scene.steps.front());
  scene.steps[1].normal = 0.4 * paper::kLoad;
  scene.steps[2].normal = 0.3 * paper::kLoad;
  scene.solver.tolerance = 1e-12;
  scene = with_map(
      scene, [](Index i, Index) { return i < 21 ? 1.0 : 0.2; }, scene.grid.cells);
  const Solution solution = solved_under(scene);
  scene.solver.model = ModelChoice::full;
  expect_same_tractions(solved_under(scene), solution);
}

TEST_F(FrictionMap, LeavesCellsWithoutFrictionWithoutTraction) {
  // Half the contact, no mirror of the other half: the limit's centre of sliding leaves the axis.
  Scene scene = with_map([](Index i, Index) { return i < 12 ? 0.0 : 1.0; });
  const Solution solution = solved_under(scene);
  const ArrayXd size = norms(solution.traction);
  EXPECT_EQ(size.head(12 * 24).maxCoeff(), 0.0);
  EXPECT_GT(size.maxCoeff(), 0.0);
  EXPECT_LE(std::hypot(solution.force[0], solution.force[1]), 1e-9 * solution.friction_force);
  ASSERT_TRUE(solution.limit.centre.has_value());
  EXPECT_GT((*solution.limit.centre)[0], 0.1 * solution.contact_radius);
}

/// Where nothing holds the surfaces they slip by all of their displacement less the body's motion.
TEST_F(FrictionMap, LetsCellsWithoutFrictionSlip) {
  Scene scene = paper_scene(24, 0.5);
  scene.lower = {70e9, 0.33};
  scene.steps.assign(2, scene.steps.front());
  scene.steps[1].torsion = MomentRatio{0.6};
  scene = with_map(
      scene, [](Index i, Index) { return i < 12 ? 0.0 : 1.0; }, scene.grid.cells);
  std::vector<Solution> steps;
  SolveOptions options;
  options.observer.step = [&](const Solution& step) { steps.push_back(step); };
  solve(scene, options);
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
    EXPECT_THAT(complaint([&] { solve(scene); }),
                AllOf(HasSubstr("step[1].moment_ratio"), HasSubstr("no moment")));
    scene.steps.pop_back();
    EXPECT_EQ(solve(scene).status, Status::converged);
    scene.steps[0].torsion = Twist{1e-3};
    const Solution turned = solve(scene);
    EXPECT_EQ(turned.status, Status::converged) << turned.message;
    EXPECT_EQ(turned.twist_angle, 1e-3);
    EXPECT_NEAR(turned.moment, 0.0, 1e-12);
  }
}

TEST_F(FrictionMap, TurnsWithTheScene) {
  const auto factor = [](Index i, Index j) {
    return 1.0 + 0.02 * static_cast<double>(i) + 0.01 * static_cast<double>(j);
  };
  const Solution solution = solved_under(with_map(factor));
  const Solution turned = solved_under(with_map([&](Index i, Index j) { return factor(23 - j, i); }));
  EXPECT_NEAR(turned.twist_angle / solution.twist_angle, 1.0, kSame);
  EXPECT_NEAR(turned.moment_limit / solution.moment_limit, 1.0, 1e-12);
}

TEST_F(FrictionMap, IsRefusedWithTheWrongSizeOrNumber) {
  const auto one = [](Index, Index) { return 1.0; };
  EXPECT_THAT(complaint([&] { solve(with_map(one, 23)); }),
              AllOf(HasSubstr("friction_map.csv"), HasSubstr("23 x 24"), HasSubstr("allowed: 24 x 24")));
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
  const auto said = [](const std::string& law, const std::string& numbers) {
    return complaint([&] {
      read_scene_text("[contact]\nfriction_law = \"" + law + "\"\n" + numbers + kBodies, "a.toml");
    });
  };
  EXPECT_THAT(said("tresca", "shear_strength = 1e8\nfriction = 0.1\n"),
              AllOf(HasSubstr("contact.friction = 0.1"),
                    HasSubstr("takes contact.shear_strength and no contact.friction")));
  EXPECT_THAT(said("coulomb", "shear_strength = 1e8\nfriction = 0.1\n"),
              HasSubstr("no contact.shear_strength"));
  EXPECT_THAT(said("capped", "shear_strength = 1e8\nfriction = 0.1\nfriction_exponent = 2\n"),
              HasSubstr("no contact.friction_exponent"));
  EXPECT_EQ(said("capped", "shear_strength = 1e8\nfriction = 0.1\n"), "");
}

}  // namespace
}  // namespace slipstick::solver
