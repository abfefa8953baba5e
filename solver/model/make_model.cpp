#include "solver/model/make_model.hpp"

#include <cmath>
#include <thread>
#include <utility>

#include "solver/elasticity/law/coated_half_spaces.hpp"
#include "solver/elasticity/law/law_kind.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/model/scene_grid.hpp"
#include "solver/model/symmetry.hpp"
#include "solver/model/within_double.hpp"
#include "solver/scene/last_digits.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

HalfSpace half_space(const auto& material) {
  return {0.5 * material.young_modulus / (1.0 + material.poisson_ratio), material.poisson_ratio};
}

CoatedBody coated_body(const Material& material) {
  const HalfSpace body = half_space(material);
  if (!material.coating) return {body};
  return {half_space(*material.coating), material.coating->thickness, body};
}

/// A pair that gives way at least as far as the scene's bodies: each all of its layer or all of its base.
ElasticPair softest_pair(const CoatedBody& lower, const CoatedBody& upper) {
  const auto softer = [](const CoatedBody& body) {
    const auto normal = [](const HalfSpace& half) { return (1.0 - half.poisson_ratio) / half.shear_modulus; };
    return normal(body.base) > normal(body.surface) ? body.base : body.surface;
  };
  return elastic_pair(softer(lower), softer(upper));
}

/// Undeformed gap on the dimensionless grid.
ArrayXd make_gap(const Scene& scene, std::vector<Surface> surfaces, const Grid& grid, double unit) {
  for (Surface& surface : surfaces) surface = to_dimensionless(std::move(surface), unit);
  ArrayXd gap = gap_field(surfaces, scene.combine, grid);
  if (!gap.isFinite().any()) {
    throw InputError(scene.source.string(), "no cell's centre lies where the bodies can touch");
  }
  return gap;
}

/// A thread that has fewer cells waits for the others about as long as it works.
constexpr Index kCellsOfThread = Index{1} << 15;

int threads_for(const Scene& scene, const Grid& part) {
  if (scene.solver.threads > 0) return scene.solver.threads;
  if (part.ranks.several()) return 1;  // each process takes a processor
  const Index processors = std::max(1U, std::thread::hardware_concurrency());
  return static_cast<int>(std::clamp<Index>(part.cells() / kCellsOfThread, 1, processors));
}

/// The law of the bodies, and of layers that are bonded to them.
SharedLaw law_of_bodies(const Scene& scene, const Model& model) {
  if (!is_coated(scene)) return std::make_shared<HalfSpaces>(model.pair, scene.solver.cell_traction);
  const auto dimensionless = [&](const Material& material) {
    CoatedBody body = coated_body(material);
    for (HalfSpace* const half : {&body.surface, &body.base})
      half->shear_modulus = to_dimensionless(half->shear_modulus, model.stress_unit);
    body.thickness = to_dimensionless(body.thickness, model.length_unit);
    return body;
  };
  return std::make_shared<CoatedHalfSpaces>(dimensionless(scene.lower), dimensionless(scene.upper),
                                            scene.solver.cell_traction);
}

/// The law of the bodies and of the layer between them.
SharedLaw make_law(const Scene& scene, const Model& model) {
  const SharedLaw bodies = law_of_bodies(scene, model);
  const auto& [kind, values] = scene.layer;
  if (kind == nullptr) return bodies;
  std::vector<double> dimensionless;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double unit = std::pow(model.length_unit, kind->parameters[i].of_length) *
                        std::pow(model.stress_unit, kind->parameters[i].of_stress);
    dimensionless.push_back(to_dimensionless(values[i], unit));
  }
  return kind->make(bodies, dimensionless);
}

Model build_model(const Scene& scene, const Ranks& ranks) {
  const CoatedBody lower = coated_body(scene.lower);
  const CoatedBody upper = coated_body(scene.upper);
  ElasticPair pair = elastic_pair(lower.surface, upper.surface);
  if (!is_coated(scene) && are_alike(scene.upper, scene.lower)) pair.mismatch = 0.0;
  require_memory_for_files(scene);
  const std::vector<Surface> surfaces = with_heights(scene.surfaces);
  const Grid grid = make_grid(scene, surfaces, softest_pair(lower, upper).effective_modulus());

  Model model(grid.h1);
  const bool full = scene.solver.model == ModelChoice::full;
  model.shear_coupling = scene.contact.coupling == Coupling::full;
  model.forces = std::any_of(scene.steps.begin(), scene.steps.end(), brings_translation);
  require_memory_around(scene, grid);
  model.stress_unit = pair.shear_modulus();
  const double compliance_unit = pair.shear_compliance;
  model.grid = {grid.n1, grid.n2, 1.0, to_dimensionless(grid.h2, grid.h1), false, ranks};
  model.pair = {.shear_compliance = 1.0,
                .poisson_compliance = to_dimensionless(pair.poisson_compliance, compliance_unit),
                .normal_compliance = to_dimensionless(pair.normal_compliance, compliance_unit),
                .mismatch = to_dimensionless(pair.mismatch, compliance_unit)};
  model.law = make_law(scene, model);
  const bool couples = model.law->couples();
  model.pressure_coupling = scene.contact.coupling == Coupling::pressure || model.shear_coupling ||
                            (scene.contact.coupling == Coupling::automatic && (full || couples));
  model.hertzian = is_hertzian(surfaces) && scene.contact.pressure != PressureModel::file &&
                   !(model.shear_coupling && couples) && is_bare(scene) && !scene.ends_at_grid_edge;
  model.friction = with_factors(scene.contact.friction, grid).to_dimensionless(model.stress_unit);
  if (const auto load = largest_normal(scene)) {
    model.normal_load = to_dimensionless(*load, model.force_unit());
    if (!std::isnormal(*model.normal_load)) {
      throw InputError(scene.source.string(), "load.normal", fmt::format("{}", *load),
                       fmt::format("what a double holds over the force of a cell, {:g}", model.force_unit()));
    }
  }
  model.gap = make_gap(scene, surfaces, model.grid, model.length_unit);
  model.pressure_part = reducible(scene)
                            ? Reduction(model.grid, model.gap, model.gap.isFinite().cast<double>())
                            : Reduction(model.grid);
  model.threads = threads_for(scene, model.pressure_part.grid());

  const auto radii = hertzian_radii(surfaces);
  if (radii && model.normal_load && is_bare(scene)) {
    model.hertz =
        hertz_contact(*model.normal_load, to_dimensionless((*radii)[0], model.length_unit),
                      to_dimensionless((*radii)[1], model.length_unit), model.pair.effective_modulus());
  }
  require_memory(scene, model, {.pressure = 0.0, .tractions = 0.0});
  return model;
}

}  // namespace

Model make_model(const Scene& scene, const Ranks& ranks) {
  return within_double(scene, [&] { return build_model(scene, ranks); });
}

}  // namespace slipstick::solver
