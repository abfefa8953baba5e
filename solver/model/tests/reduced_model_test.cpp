#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <sstream>

#include "solver/model/make_model.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/tests/fields.hpp"
#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

/// Whole scenes, solved on the part of the grid that the model leaves and on all of it: the answers agree.
namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using namespace testing;

constexpr const char* kCoupling = "K13, K23";
constexpr const char* kShearCoupling = "K31, K32";
constexpr const char* kTranslations = "translations";
constexpr const char* kQuadrant = "three quarters of the contact";
constexpr const char* kDiagonal = "one traction field";

std::vector<std::string> left_out(const ModelSolution& solution) {
  std::vector<std::string> names;
  for (const Omission& omission : solution.left_out) {
    names.push_back(omission.what);
    EXPECT_FALSE(omission.why.empty()) << omission.what;
  }
  return names;
}

ModelSolution solve_full(Scene scene) {
  scene.solver.model = ModelChoice::full;
  return solve_in_model_units(scene);
}

/// Counts of the smallest rectangle about the origin that holds the contact.
std::array<Index, 2> contact_sides(const ModelSolution& solution) {
  const Grid& grid = solution.model.grid;
  std::array<Index, 2> sides{};
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) {
      if (!(solution.normal.pressure[i * grid.n2 + j] > 0.0)) continue;
      sides[0] = std::max({sides[0], 2 * i + 2 - grid.n1, grid.n1 - 2 * i});
      sides[1] = std::max({sides[1], 2 * j + 2 - grid.n2, grid.n2 - 2 * j});
    }
  }
  return sides;
}

std::string trimming(const ModelSolution& solution) {
  const auto [n1, n2] = contact_sides(solution);
  const Grid& grid = solution.model.grid;
  std::ostringstream text;
  text << "all but " << n1 << " x " << n2 << " of " << grid.n1 << " x " << grid.n2 << " cells";
  return text.str();
}

/// Computed from the tractions, the pressure and the twist, on the whole grid.
Certificate recomputed(const Scene& scene, const ModelSolution& solution, OperatorKind kind) {
  const Model& model = solution.model;
  const ArrayXd& pressure = solution.normal.pressure;
  const ArrayXd& q = solution.tangential.traction;
  const ArrayXd rotation = rotation_field(model.grid);
  ArrayXd u(q.size());
  make_operator(kind, model.grid, tangential_kernel(), *model.law)->apply(q, u);
  ArrayXd slip = u - solution.tangential.twist * rotation;
  if (model.pressure_coupling) {
    ArrayXd by_pressure(q.size());
    make_operator(kind, model.grid, coupling_kernel(), *model.law)->apply(pressure, by_pressure);
    slip += by_pressure;
  }
  slip *= (pressure > 0.0).cast<double>().replicate(2, 1);
  const ArrayXd bound = model.friction.bound(pressure);
  const double moment = value_if<MomentRatio>(scene.steps[0].torsion)
                            ? *value_if<MomentRatio>(scene.steps[0].torsion) * moment_limit(model.grid, bound)
                            : (q * rotation).sum();
  return certify({q, u, slip}, bound, rotation, moment);
}

void expect_certificate(const Certificate& certificate, double tolerance) {
  // The sums round by about 1e-15 of the energy.
  EXPECT_LE(certificate.gap, tolerance * (1.0 + 1e-6) + 1e-14);
  EXPECT_LE(certificate.moment, 1e-12);
  EXPECT_LE(certificate.friction_bound, 1e-12);
}

struct Case {
  std::string name;
  Scene scene;
  bool quadrant = false;
  bool diagonal = false;
  bool trimmed = true;
};
void PrintTo(const Case& tested, std::ostream* stream) { *stream << tested.name; }

Scene with(Scene scene, const std::function<void(Scene&)>& change) {
  change(scene);
  return scene;
}

Scene with_cells(Scene scene, Index n1, Index n2) {
  scene.grid.cells = {n1, n2};
  return scene;
}

Scene with_extent(Scene scene, double side) {
  scene.grid.extent = {side, side};
  return scene;
}

/// By default two cells on each side of the contact stay empty.
std::vector<Case> cases() {
  const Scene sphere = paper_scene(32, 0.5);
  const Scene ellipsoid = ellipsoid_scene(32, 0.036, 0.018, 0.5);
  const auto imposed_twist = [](Scene& scene) { scene.steps[0].torsion = Twist{1e-3}; };
  const auto hertz_averaged = [](Scene& scene) { scene.contact.pressure = PressureModel::hertz_averaged; };
  // Slips from its rim where the moment is above 0.85 of the limit.
  Scene punch = paper_scene(32, 0.95);
  punch.surfaces.front().shape = Shape::flat_punch;
  punch.surfaces.front().radius = 1e-3;
  std::vector<Case> list{
      {"sphere", sphere, true, true},
      {"sphere_nearly_slipping", paper_scene(24, 0.97), true, true},
      {"sphere_under_twist", with(sphere, imposed_twist), true, true},
      {"sphere_oblong_cells", with_cells(sphere, 32, 24), true, false},
      {"sphere_wide", with_extent(sphere, 2e-3), true, true},
      {"sphere_filling", with_extent(sphere, 0.99e-3), true, true, false},
      {"sphere_odd", with_cells(sphere, 31, 31)},
      {"sphere_odd_along_x2", with_cells(sphere, 32, 27)},
      {"sphere_dissimilar", with(sphere, [](Scene& scene) { scene.lower.young_modulus = 70e9; })},
      {"sphere_dissimilar_uncoupled",
       with(sphere,
            [](Scene& scene) {
              scene.lower.young_modulus = 70e9;
              scene.contact.coupling = Coupling::none;
            }),
       true, true},
      {"ellipsoid_oblong_cells", ellipsoid, true, false},
      {"ellipsoid_square_cells", with_extent(ellipsoid, 1.5e-3), true, false},
      {"ellipsoid_under_twist", with(ellipsoid, imposed_twist), true, false},
      {"hertz_averaged", with(sphere, hertz_averaged), true, true},
      {"ellipsoid_hertz_averaged", with(ellipsoid, hertz_averaged), true, false},
      {"hertz_at_centres", with(sphere, [](Scene& scene) { scene.contact.pressure = PressureModel::hertz; }),
       true, true},
      {"smooth_cells", with(sphere, [](Scene& scene) { scene.solver.cell_traction = CellTraction::smooth; }),
       true, true},
      {"punch", punch, true, true}};
  for (Case& each : list) each.scene.solver.tolerance = 1e-12;
  return list;
}

class ReducedModel : public testing::TestWithParam<Case> {
 protected:
  static bool coupled() { return GetParam().name == "sphere_dissimilar"; }
};
INSTANTIATE_TEST_SUITE_P(Scenes, ReducedModel, testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

/// Newton's last step leaves less than the gap that it is stopped on: the fields agree far better than its
/// root.
TEST_P(ReducedModel, GivesTheFullModelsAnswer) {
  const Scene& scene = GetParam().scene;
  const ModelSolution full = solve_full(scene);
  const ModelSolution reduced = solve_in_model_units(scene);
  ASSERT_EQ(full.status, Status::converged) << full.message;
  ASSERT_EQ(reduced.status, Status::converged) << reduced.message;
  constexpr double same = 1e-10;
  EXPECT_LE(relative_difference(reduced.normal.pressure, full.normal.pressure), same);
  EXPECT_LE(relative_difference(reduced.tangential.traction, full.tangential.traction), same);
  EXPECT_LE(relative_difference(reduced.tangential.slip, full.tangential.slip), same);
  const ArrayXd contact = (full.normal.pressure > 0.0).cast<double>().replicate(2, 1);
  EXPECT_LE(relative_difference(contact * reduced.tangential.elastic_displacement,
                                contact * full.tangential.elastic_displacement),
            same);
  EXPECT_TRUE((reduced.tangential.stick == full.tangential.stick).all());
  EXPECT_EQ(reduced.stick_cells, full.stick_cells);
  EXPECT_EQ(reduced.contact_cells, full.contact_cells);
  EXPECT_NEAR(reduced.twist_angle / full.twist_angle, 1.0, same);
  EXPECT_NEAR(reduced.moment / full.moment, 1.0, same);
  EXPECT_NEAR(reduced.moment_limit / full.moment_limit, 1.0, same);
  EXPECT_NEAR(reduced.normal_load / full.normal_load, 1.0, same);
  EXPECT_NEAR(reduced.approach, full.approach, same * std::abs(full.approach));
  EXPECT_GT(full.stick_cells, 0);
  EXPECT_LT(full.stick_cells, full.contact_cells) << "both states must occur";
}

TEST_P(ReducedModel, NamesWhatItLeavesOut) {
  const Case& tested = GetParam();
  const ModelSolution reduced = solve_in_model_units(tested.scene);
  std::vector<std::string> expected;
  expected.emplace_back(coupled() ? kShearCoupling : kCoupling);
  expected.emplace_back(kTranslations);
  if (tested.trimmed) expected.push_back(trimming(reduced));
  if (tested.quadrant) expected.emplace_back(kQuadrant);
  if (tested.diagonal) expected.emplace_back(kDiagonal);
  EXPECT_EQ(left_out(reduced), expected);
  EXPECT_EQ(reduced.model.pressure_part.quadrant(),
            tested.scene.grid.cells[0] % 2 + tested.scene.grid.cells[1] % 2 == 0);
  // The solve took the part that is named.
  const auto [n1, n2] = contact_sides(reduced);
  const Index images = tested.quadrant ? 2 : 1;
  EXPECT_EQ(reduced.tangential.grids.back().n1, n1 / images);
  EXPECT_EQ(reduced.tangential.grids.back().n2, n2 / images);
}

TEST_P(ReducedModel, FullLeavesOutNothingThatTheSceneAllows) {
  const Scene& scene = GetParam().scene;
  const ModelSolution full = solve_full(scene);
  std::vector<std::string> expected;
  if (scene.contact.coupling == Coupling::none) {
    expected.emplace_back(kCoupling);
  } else if (coupled()) {
    expected.emplace_back(kShearCoupling);
  }
  EXPECT_EQ(left_out(full), expected);
  EXPECT_EQ(full.tangential.grids.back().n1, scene.grid.cells[0]);
  EXPECT_EQ(full.tangential.grids.back().n2, scene.grid.cells[1]);
}

TEST_P(ReducedModel, HoldsItsCertificateOnTheWholeGrid) {
  const Scene& scene = GetParam().scene;
  const ModelSolution reduced = solve_in_model_units(scene);
  expect_certificate(reduced.certificate, scene.solver.tolerance);
  expect_certificate(recomputed(scene, reduced, OperatorKind::dcfft), scene.solver.tolerance);
}

/// Whatever part of the grid was solved, the result is held to the same tolerance, by plain sums.
TEST(ReducedModelCertificate, HoldsByPlainSums) {
  for (const bool full : {false, true}) {
    Scene scene = ellipsoid_scene(28, 0.03, 0.015, 0.6);
    scene.solver.model = full ? ModelChoice::full : ModelChoice::automatic;
    scene.solver.tolerance = 1e-10;
    const ModelSolution solution = solve_in_model_units(scene);
    ASSERT_EQ(solution.status, Status::converged) << solution.message;
    expect_certificate(recomputed(scene, solution, OperatorKind::direct), 1e-10);

    const Model& model = solution.model;
    const ArrayXd& p = solution.normal.pressure;
    ArrayXd u(p.size());
    make_operator(OperatorKind::direct, model.grid, normal_kernel(), *model.law)->apply(p, u);
    const ArrayXd opening = u + model.gap;
    EXPECT_LE((p * (opening - opening.minCoeff())).sum(), 1.0001e-10 * 0.5 * (p * u).sum());
    EXPECT_NEAR(solution.normal_load / paper::kLoad, 1.0, 1e-11);
  }
}

/// The paper's method stops on change, and a slipping cell keeps the direction of its first slip: the two
/// runs may stop an iteration apart, and rounding enters the directions. They agree to some of their
/// tolerances, and break Coulomb's law alike.
TEST(PapersMethod, AgreesToItsTolerance) {
  for (Scene scene : {paper_scene(32, 0.5), ellipsoid_scene(32, 0.036, 0.018, 0.5), paper_scene(27, 0.7)}) {
    scene.solver.method = Method::paper;
    scene.solver.tolerance = 1e-10;
    const ModelSolution full = solve_full(scene);
    const ModelSolution reduced = solve_in_model_units(scene);
    ASSERT_TRUE(full.status == Status::converged && reduced.status == Status::converged);
    EXPECT_LE(relative_difference(reduced.tangential.traction, full.tangential.traction),
              100.0 * scene.solver.tolerance);
    EXPECT_NEAR(reduced.twist_angle / full.twist_angle, 1.0, 100.0 * scene.solver.tolerance);
    EXPECT_NEAR(reduced.certificate.gap / full.certificate.gap, 1.0, 1e-3);
    EXPECT_TRUE((reduced.tangential.stick == full.tangential.stick).all());
    EXPECT_THAT(left_out(full), ElementsAre(kTranslations));
    EXPECT_THAT(left_out(reduced), Contains(trimming(reduced)));
  }
}

/// Direct and dense sums are the reference of the other operators.
TEST(DirectAndDense, LeaveNoCellsOut) {
  for (const OperatorKind kind : {OperatorKind::direct, OperatorKind::dense}) {
    Scene scene = paper_scene(12, 0.5);
    scene.solver.op = kind;
    const ModelSolution solution = solve_in_model_units(scene);
    EXPECT_THAT(left_out(solution), ElementsAre(kCoupling, kTranslations));
    EXPECT_EQ(solution.tangential.grids.back().n1, 12);
  }
}

// --- height maps ---

class HeightMapSymmetry : public SceneFile {
 protected:
  /// A bowl with ripples, in mirror image about both axes; one height may be changed.
  ModelSolution solved(double change = 0.0) const {
    constexpr Index n1 = 20;
    constexpr Index n2 = 24;
    std::ostringstream text;
    text.precision(17);
    for (Index i = 0; i < n1; ++i) {
      for (Index j = 0; j < n2; ++j) {
        const auto x1 = static_cast<double>(std::abs(2 * i + 1 - n1));
        const auto x2 = static_cast<double>(std::abs(2 * j + 1 - n2));
        double height = 3e-8 * (x1 * x1 + x2 * x2) + 1e-7 * std::cos(0.9 * x1) * std::cos(1.1 * x2);
        if (i == 11 && j == 13) height += change;
        text << (j == 0 ? "" : ",") << height;
      }
      text << '\n';
    }
    Scene scene = paper_scene(0, 0.5);
    scene.grid.cells = {n1, n2};
    scene.surfaces.front() = {.shape = Shape::height_map,
                              .map = {.file = write("heights.csv", text.str()), .spacing = {5e-5, 5e-5}}};
    scene.solver.tolerance = 1e-12;
    const ModelSolution reduced = solve_in_model_units(scene);
    const ModelSolution full = solve_full(scene);
    EXPECT_EQ(reduced.status, Status::converged) << reduced.message;
    EXPECT_LE(relative_difference(reduced.normal.pressure, full.normal.pressure), 1e-10);
    EXPECT_LE(relative_difference(reduced.tangential.traction, full.tangential.traction), 1e-10);
    EXPECT_NEAR(reduced.twist_angle / full.twist_angle, 1.0, 1e-10);
    return reduced;
  }
};

TEST_F(HeightMapSymmetry, IsFoundInTheData) {
  const ModelSolution symmetric = solved();
  EXPECT_TRUE(symmetric.model.pressure_part.quadrant());
  EXPECT_THAT(left_out(symmetric), Contains(kQuadrant));
}

/// A nanometre in one cell: the pressure is no mirror image any more, and nor is the traction.
TEST_F(HeightMapSymmetry, IsNotMadeUp) {
  const ModelSolution bumpy = solved(1e-9);
  EXPECT_FALSE(bumpy.model.pressure_part.quadrant());
  EXPECT_THAT(left_out(bumpy), Not(Contains(kQuadrant)));
  EXPECT_THAT(left_out(bumpy), Not(Contains(kDiagonal)));
}

/// A ring on an odd number of cells has no quadrant. No force acts on it, and rounding leaves none, in a
/// history of many parts neither.
TEST_F(HeightMapSymmetry, LeavesNoForceWithoutTranslations) {
  constexpr Index n1 = 52;
  constexpr Index n2 = 53;
  for (const double ring : {0.45, 0.75, 0.9}) {
    std::ostringstream text;
    text.precision(17);
    for (Index i = 0; i < n1; ++i) {
      for (Index j = 0; j < n2; ++j) {
        const double radius =
            std::hypot(static_cast<double>(2 * i + 1 - n1), static_cast<double>(2 * j + 1 - n2));
        const double off = 0.5 * radius / static_cast<double>(n1) - 0.5 * ring;
        text << (j == 0 ? "" : ",") << 1.5e-5 * off * off;
      }
      text << '\n';
    }
    Scene scene = paper_scene(0, 0.5);
    scene.grid.cells = {0, 0};
    scene.surfaces.front() = {.shape = Shape::height_map,
                              .map = {.file = write("ring.csv", text.str()), .spacing = {1e-5, 1e-5}}};
    scene.lower = {6.8e9, 0.3};
    scene.steps[0].normal = 0.1;
    for (const double ratio : {-0.5, 0.7, 0.9}) {
      for (const int parts : {1, 8}) {
        scene.steps[0].torsion = MomentRatio{ratio};
        scene.solver.substeps = parts;
        const ModelSolution solution = solve_in_model_units(scene);
        EXPECT_EQ(solution.status, Status::converged) << solution.message;
        EXPECT_THAT(left_out(solution), AllOf(Contains(kTranslations), Not(Contains(kQuadrant))));
        EXPECT_LE(solution.certificate.force, 1e-15) << ring << ' ' << ratio << ' ' << parts;
      }
    }
  }
}

class PressureFromAFile : public SceneFile {};

/// A file's pressure need not have the mirrors of the surface that is said to cause it.
TEST_F(PressureFromAFile, NeedsTheWholeGrid) {
  std::ostringstream text;
  text << "x1,x2,pressure\n";
  constexpr double h = 1e-3 / 16.0;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j)
      text << (i - 7.5) * h << ',' << (j - 7.5) * h << ',' << 1e9 + 1e7 * i << '\n';
  }
  Scene scene = paper_scene(16, 0.5);
  scene.grid.extent = std::array{1e-3, 1e-3};
  scene.ends_at_grid_edge = true;  // every cell is pressed
  scene.steps[0].normal.reset();
  scene.contact.pressure = PressureModel::file;
  scene.contact.pressure_file = write("pressure.csv", text.str());
  const ModelSolution solution = solve_in_model_units(scene);
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_THAT(left_out(solution), ElementsAre(kCoupling));  // it turns about a centre of its own
  Scene full = scene;
  full.solver.model = ModelChoice::full;
  EXPECT_EQ(predicted_memory(scene, make_model(scene)).solver,
            predicted_memory(full, make_model(full)).solver);
}

}  // namespace
}  // namespace slipstick::solver
