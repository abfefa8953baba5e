#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "solver/elasticity/law/law_kind.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/roughness.hpp"
#include "solver/scene/scene_keys.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::solver {
namespace {

class Validation {
 public:
  Validation(const Scene& scene, const SceneReader* reader) : scene_(scene), reader_(reader) {}

  void check() const {
    check_surfaces();
    check_material("upper", scene_.upper);
    check_material("lower", scene_.lower);
    check_layer();
    check_friction();
    check_steps();
    check_grid();
    require("solver.tolerance", scene_.solver.tolerance, kTolerance);
    require("solver.max_iterations", scene_.solver.max_iterations, kIterations);
    require("solver.substeps", scene_.solver.substeps, kSubsteps);
    require("solver.threads", scene_.solver.threads, kThreads);
    require("solver.rounding_seed", static_cast<double>(scene_.solver.rounding_seed), kRoundingSeeds);
    check_consistency();
  }

 private:
  [[noreturn]] void refuse(const std::string& key, const std::string& value, const std::string& allowed) const {
    if (reader_ != nullptr) reader_->fail(key, value, allowed);
    throw InputError(scene_.source.empty() ? "scene" : scene_.source.string(), key, value, allowed);
  }

  void require(const std::string& key, double value, const Range& range) const {
    if (!range.contains(value)) refuse(key, fmt::format("{}", value), range.words);
  }

  void check_surfaces() const {
    const auto& surfaces = scene_.surfaces;
    if (surfaces.empty() || surfaces.size() > kMaxShapes) {
      refuse("upper.shape", fmt::format("{} shapes", surfaces.size()), fmt::format("from 1 to {}", kMaxShapes));
    }
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      const std::string made = surfaces.size() == 1 ? "upper" : fmt::format("upper.shape[{}]", i);
      check_surface(surfaces[i].key.empty() ? made : surfaces[i].key, surfaces[i]);
    }
  }

  void check_surface(const std::string& table, const Surface& surface) const {
    for (const ShapeNumber& number : shape_numbers()) {
      if (number.belongs_to(surface.shape)) require(table + "." + number.name, number.of(surface), number.allowed);
    }
    if (surface.shape == Shape::flat_punch) {
      require(table + ".inner_radius", surface.inner_radius, inner_radius_below(surface.radius));
    } else if (surface.shape == Shape::roughness) {
      const Roughness& roughness = surface.roughness;
      require(table + ".period", roughness.period, period_for(roughness.longest));
      require(table + ".shortest", roughness.shortest, shortest_for(roughness.longest, roughness.period));
    } else if (surface.shape == Shape::height_map) {
      for (const double spacing : surface.map.spacing) require(table + ".spacing", spacing, kPositive);
      require(table + ".unit", surface.map.unit, kPositive);
    }
    for (const double at : surface.at) require(table + ".at", at, kFinite);
    require(table + ".angle", surface.angle, kFinite);
  }

  /// A rigid body has an infinite modulus.
  void check_material(const std::string& body, const Material& material) const {
    if (!(material.young_modulus > 0.0)) {
      refuse(body + ".young_modulus", fmt::format("{}", material.young_modulus), "positive");
    }
    require(body + ".poisson_ratio", material.poisson_ratio, kPoisson);
    if (material.yield_stress) require(body + ".yield_stress", *material.yield_stress, kPositive);
    if (!material.coating) return;
    require(body + ".layer.thickness", material.coating->thickness, kPositive);
    require(body + ".layer.young_modulus", material.coating->young_modulus, kPositive);
    require(body + ".layer.poisson_ratio", material.coating->poisson_ratio, kPoisson);
  }

  void check_friction() const {
    const FrictionLaw& law = scene_.contact.friction;
    require("contact.friction", law.coefficient, kNotNegative);
    if (law.kind == FrictionKind::tresca || law.kind == FrictionKind::capped)
      require("contact.shear_strength", law.shear_strength, kPositive);
    require("contact.friction_exponent", law.exponent, kFrictionExponent);
  }

  void check_layer() const {
    const auto& [kind, values] = scene_.layer;
    const std::size_t count = kind == nullptr ? 0 : kind->parameters.size();
    if (values.size() != count) {
      refuse("layer.kind", fmt::format("{} numbers", values.size()), fmt::format("{}", count));
    }
    for (std::size_t i = 0; i < count; ++i) {
      require("layer." + kind->parameters[i].key, values[i], kNotNegative);
    }
  }

  void check_steps() const {
    if (scene_.steps.empty() || scene_.steps.size() > kMaxSteps) {
      refuse("step", fmt::format("{} steps", scene_.steps.size()), fmt::format("from 1 to {}", kMaxSteps));
    }
    require("cycles", scene_.cycles, cycles_of(scene_.steps.size()));
    for (const Step& step : scene_.steps) {
      if (step.normal) require(step.key + ".normal", *step.normal, kPositive);
      if (!step.normal && scene_.contact.pressure != PressureModel::file) {
        refuse(step.key + ".normal", "(missing)", kPositive.words);
      }
      if (const auto ratio = value_if<MomentRatio>(step.torsion)) {
        require(step.key + ".moment_ratio", *ratio, kRatio);
      } else if (const auto moment = value_if<Moment>(step.torsion)) {
        require(step.key + ".moment", *moment, kFinite);
      } else {
        require(step.key + ".twist", std::get<Twist>(step.torsion).value, kFinite);
      }
      for (const double force : step.force) require(step.key + ".force", force, kFinite);
      if (!step.displacement) continue;
      for (const double displacement : *step.displacement) require(step.key + ".displacement", displacement, kFinite);
      if (step.force != std::array<double, 2>{}) {
        refuse(step.key + ".displacement", "(together with a force)", "one of force, displacement");
      }
    }
  }

  void check_grid() const {
    const bool as_samples = find_height_map(scene_.surfaces) != nullptr && scene_.grid.cells == std::array<Index, 2>{};
    for (const Index cells : scene_.grid.cells) {
      if (!as_samples) require("grid.cells", static_cast<double>(cells), kCells);
    }
    if (!scene_.grid.extent) return;
    for (const double extent : *scene_.grid.extent) require("grid.extent", extent, kPositive);
  }

  /// The paper's method solves only torsion about the origin.
  void check_method() const {
    if (scene_.solver.method == Method::coulomb) return;
    const Step& step = scene_.steps.front();
    if (scene_.steps.size() > 1 || scene_.cycles > 1 || scene_.solver.substeps > 1 || brings_translation(step)) {
      refuse("solver.method", fmt::format("\"{}\"", to_string(scene_.solver.method)),
             "coulomb (this method knows one step of torsion about the origin)");
    }
  }

  void check_consistency() const {
    check_method();
    if (scene_.contact.coupling == Coupling::full && scene_.contact.pressure != PressureModel::solved) {
      refuse("contact.coupling", "\"full\"",
             "auto, none, pressure (shear changes a pressure only where that is solved: "
             "contact.pressure = \"solved\")");
    }
    const auto is_rigid = [](const Material& body) { return std::isinf(body.young_modulus) && !body.coating; };
    if (is_rigid(scene_.upper) && is_rigid(scene_.lower)) {
      refuse("lower.rigid", "true", "false, since the upper body is rigid");
    }
    const bool asks_hertz =
        scene_.contact.pressure == PressureModel::hertz || scene_.contact.pressure == PressureModel::hertz_averaged;
    if (asks_hertz && !(is_bare(scene_) && hertzian_radii(scene_.surfaces))) {
      refuse("contact.pressure", fmt::format("\"{}\"", to_string(scene_.contact.pressure)),
             is_bare(scene_)
                 ? "solved, file (Hertz's pressure belongs to one sphere or ellipsoid at the origin, its axes "
                   "along the grid's)"
                 : "solved, file (Hertz's pressure belongs to half-spaces without a layer)");
    }
    if (find_height_map(scene_.surfaces) != nullptr && scene_.grid.extent) {
      refuse("grid.extent", "(given)", "left out for a height map: upper.spacing says it");
    }
    if (scene_.contact.pressure == PressureModel::file && !scene_.grid.extent) {
      refuse("grid.extent", "(missing)",
             "[L1, L2], two lengths, as [\"1 mm\", \"1 mm\"], since the pressure's cells come from a file");
    }
  }

  const Scene& scene_;
  const SceneReader* reader_;
};

}  // namespace

void validate(const Scene& scene, const SceneReader* reader) { Validation(scene, reader).check(); }

void validate(const Scene& scene) { validate(scene, nullptr); }

Range inner_radius_below(double radius) {
  return {"zero or positive, below the radius", [radius](double x) { return x >= 0.0 && x < radius; }};
}

Range period_for(double longest) {
  return {fmt::format("at least longest = {:g}, finite", longest),
          [longest](double x) { return x >= longest && std::isfinite(x); }};
}

Range shortest_for(double longest, double period) {
  const double least = period / kMaxWaves;
  return {fmt::format("from a {:g}th of the period, {:g}, to half of longest, {:g}", kMaxWaves, least, 0.5 * longest),
          [longest, least](double x) { return x >= least && x <= 0.5 * longest; }};
}

Range cycles_of(std::size_t steps) {
  Range cycles = whole(1, static_cast<double>(kMaxSteps / std::max<std::size_t>(steps, 1)));
  cycles.words += fmt::format(", {} steps in all", kMaxSteps);
  return cycles;
}

}  // namespace slipstick::solver
