// Scenes that a program built: whatever a file may not say, they may not hold.

#include <gmock/gmock.h>

#include "solver/elasticity/law/law_kind.hpp"
#include "solver/input/tests/complaint.hpp"
#include "solver/tests/limits.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

using testing::HasSubstr;

struct Mistake {
  const char* key;
  std::function<void(Scene&)> make;
};

const double kInfinite = std::numeric_limits<double>::infinity();

const Surface kShortPeriod{
    .shape = Shape::roughness,
    .roughness = {.seed = 1, .hurst = 0.8, .longest = 1e-4, .shortest = 2e-5, .rms_slope = 0.1, .period = 9e-5}};

/// A layer of the first kind, whose parameters are two compliances.
template <typename... Values>
Layer layer_of(Values... values) {
  return {&law_kinds()[0], {values...}};
}

Coating coat(double h, double modulus, double poisson_ratio) { return {h, modulus, poisson_ratio}; }

void press_a_layer_by_hertz(Scene& s) {
  s.layer = layer_of(1e-12, 1e-12);
  s.contact.pressure = PressureModel::hertz;
}

void couple_hertz_fully(Scene& s) {
  s.contact.coupling = Coupling::full;
  s.contact.pressure = PressureModel::hertz;
}

void push_and_displace(Scene& s) {
  s.steps[0].force = {1.0, 0.0};
  s.steps[0].displacement = {1e-6, 0.0};
}

void push_by_the_papers_method(Scene& s) {
  s.solver.method = Method::paper;
  s.steps[0].force = {1.0, 0.0};
}

const std::vector<Mistake> kWrongBodies{
    {"upper.shape", [](Scene& s) { s.surfaces.clear(); }},
    {"upper.radius", [](Scene& s) { s.surfaces[0].radius = 0.0; }},
    {"upper.angle", [](Scene& s) { s.surfaces[0].angle = kNaN; }},
    {"upper.at", [](Scene& s) { s.surfaces[0].at[0] = kInfinite; }},
    {"upper.shape[1].slope", [](Scene& s) { s.surfaces.push_back({.shape = Shape::cone}); }},
    {"upper.inner_radius",
     [](Scene& s) { s.surfaces[0] = {.shape = Shape::flat_punch, .radius = 1e-3, .inner_radius = 1e-3}; }},
    {"upper.exponent", [](Scene& s) { s.surfaces[0] = {.shape = Shape::power, .exponent = 0.5}; }},
    {"upper.hurst", [](Scene& s) { s.surfaces[0] = {.shape = Shape::roughness}; }},
    {"upper.period", [](Scene& s) { s.surfaces[0] = kShortPeriod; }},
    {"upper.young_modulus", [](Scene& s) { s.upper.young_modulus = -1.0; }},
    {"lower.poisson_ratio", [](Scene& s) { s.lower.poisson_ratio = 0.6; }},
    {"lower.rigid", [](Scene& s) { s.upper.young_modulus = s.lower.young_modulus = kInfinite; }},
    {"layer.kind", [](Scene& s) { s.layer = layer_of(1e-12); }},
    {"layer.normal_compliance", [](Scene& s) { s.layer = layer_of(-1e-12, 1e-12); }},
    {"layer.tangential_compliance", [](Scene& s) { s.layer = layer_of(1e-12, kNaN); }},
    {"lower.layer.thickness", [](Scene& s) { s.lower.coating = coat(kInfinite, 1e9, 0.3); }},
    {"upper.layer.young_modulus", [](Scene& s) { s.upper.coating = coat(1e-4, kInfinite, 0.3); }},
    {"upper.layer.poisson_ratio", [](Scene& s) { s.upper.coating = coat(1e-4, 1e9, kNaN); }},
    {"contact.pressure", press_a_layer_by_hertz},
    {"contact.friction", [](Scene& s) { s.contact.friction.coefficient = kNaN; }},
    {"contact.shear_strength", [](Scene& s) { s.contact.friction.kind = FrictionKind::tresca; }},
    {"contact.friction_exponent", [](Scene& s) { s.contact.friction.exponent = 0.0; }},
    {"contact.coupling", couple_hertz_fully},
};

void expect_named(const std::vector<Mistake>& mistakes) {
  for (const auto& [key, make] : mistakes) {
    Scene scene = paper_scene(16, 0.5);
    scene.source.clear();
    EXPECT_EQ(complaint([&] { validate(scene); }), "") << key;
    make(scene);
    EXPECT_THAT(complaint([&] { solve(scene); }), HasSubstr(std::string("scene: ") + key + " = "));
  }
}

TEST(Validate, NamesTheKeyOfAWrongBody) { expect_named(kWrongBodies); }

const std::vector<Mistake> kWrongLoadsAndGrids{
    {"step", [](Scene& s) { s.steps.clear(); }},
    {"load.normal", [](Scene& s) { s.steps[0].normal.reset(); }},
    {"load.moment_ratio", [](Scene& s) { s.steps[0].torsion = MomentRatio{1.0}; }},
    {"load.moment", [](Scene& s) { s.steps[0].torsion = Moment{kNaN}; }},
    {"load.twist", [](Scene& s) { s.steps[0].torsion = Twist{kInfinite}; }},
    {"load.force", [](Scene& s) { s.steps[0].force[0] = kNaN; }},
    {"load.displacement", push_and_displace},
    {"cycles", [](Scene& s) { s.cycles = 0; }},
    {"grid.cells", [](Scene& s) { s.grid.cells = {}; }},
    {"grid.extent", [](Scene& s) { s.grid.extent.emplace(); }},
    {"solver.tolerance", [](Scene& s) { s.solver.tolerance = 0.0; }},
    {"solver.max_iterations", [](Scene& s) { s.solver.max_iterations = 0; }},
    {"solver.threads", [](Scene& s) { s.solver.threads = -1; }},
    {"solver.rounding_seed", [](Scene& s) { s.solver.rounding_seed = -1; }},
    {"solver.method", push_by_the_papers_method},
};

TEST(Validate, NamesTheKeyOfWrongLoadsAndGrids) { expect_named(kWrongLoadsAndGrids); }

TEST(Validate, ASceneAsItIsConstructedLacksItsShape) {
  EXPECT_THAT(complaint([] { validate(Scene()); }), HasSubstr("upper.radius = 0: allowed: positive"));
}

}  // namespace
}  // namespace slipstick::solver
