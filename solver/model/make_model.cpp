#include "solver/model/make_model.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <thread>
#include <utility>

#include "solver/elasticity/law/coated_half_spaces.hpp"
#include "solver/elasticity/law/law_kind.hpp"
#include "solver/elasticity/law/rescaled_law.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/units.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/model/symmetry.hpp"
#include "solver/model/within_double.hpp"
#include "solver/scene/last_digits.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Cells left free on each side of the expected contact where the scene does not give an extent.
constexpr double kExtentMarginCells = 2.0;
/// Largest ratio of a cell's sides. Beyond it every method crawls.
constexpr double kMaxSlender = 1000.0;

/// Half the sides of a rectangle that lies in the contact for certain, before it is solved: the contact of a
/// single shape, or the lowest points of several shapes of which the nearest counts.
std::array<double, 2> least_half_sides(const Scene& scene, const std::vector<Surface>& surfaces,
                                       const std::optional<std::array<double, 2>>& expected) {
  const bool hertz =
      scene.contact.pressure == PressureModel::hertz || scene.contact.pressure == PressureModel::hertz_averaged;
  if (scene.ends_at_grid_edge && !hertz) return {};
  if (surfaces.size() == 1) return expected.value_or(std::array<double, 2>{});
  const bool pressed = scene.combine == Combine::nearest && scene.contact.pressure == PressureModel::solved;
  return pressed && expected ? half_sides_below(surfaces, Combine::nearest, 0.0) : std::array<double, 2>{};
}

/// Refuses extents that are too small for certain; require_contact_within_grid() refuses the others.
void require_extent(const Scene& scene, const std::vector<Surface>& surfaces,
                    const std::optional<std::array<double, 2>>& expected) {
  const auto least = least_half_sides(scene, surfaces, expected);
  const auto& extent = *scene.grid.extent;
  if (extent[0] > 2.0 * least[0] && extent[1] > 2.0 * least[1]) return;
  const bool one = surfaces.size() == 1;
  const Units units(scene.units);
  throw InputError(scene.source.string(), "grid.extent", units.pair_text("m", extent),
                   fmt::format("larger than {}, about {}, or left out",
                               one ? "the contact" : "the rectangle that the contacts of all shapes may fill",
                               units.pair_text("m", {2.0 * (*expected)[0], 2.0 * (*expected)[1]})));
}

Grid require_not_slender(const Scene& scene, const Grid& grid) {
  const double slender = grid.h1 / grid.h2;
  if (slender <= kMaxSlender && slender >= 1.0 / kMaxSlender) return grid;
  throw InputError(
      scene.source.string(), "grid.cells", fmt::format("[{}, {}]", grid.n1, grid.n2),
      fmt::format("cells at most {} times as long as wide; these are {:.4g} x {:.4g}", kMaxSlender, grid.h1, grid.h2));
}

/// The largest normal load of a scene's steps, N.
std::optional<double> largest_normal(const Scene& scene) {
  std::optional<double> largest;
  for (const Step& step : scene.steps) {
    if (step.normal && !(largest >= step.normal)) largest = step.normal;
  }
  return largest;
}

/// The scene's grid, in m. Throws InputError for an extent that is missing or too small, for cells that do not match a
/// height map, and for slender ones. effective_modulus: of a pair at least as soft as the bodies, Pa.
Grid make_grid(const Scene& scene, const std::vector<Surface>& surfaces, double effective_modulus) {
  if (const auto grid = height_map_grid(surfaces)) {
    const std::array<Index, 2> samples{grid->n1, grid->n2};
    if (scene.grid.cells != std::array<Index, 2>{} && scene.grid.cells != samples) {
      throw InputError(scene.source.string(), "grid.cells",
                       fmt::format("[{}, {}]", scene.grid.cells[0], scene.grid.cells[1]),
                       fmt::format("[{}, {}], the samples in {}, or left out", samples[0], samples[1],
                                   find_height_map(surfaces)->map.file.string()));
    }
    return require_not_slender(scene, *grid);
  }
  const auto load = largest_normal(scene);
  // Where a layer is bonded to a body, the contact is not known, but a rectangle around it.
  const bool known = load && scene.layer.kind == nullptr && !(scene.grid.extent && is_coated(scene));
  const auto expected = known ? expected_half_sides(surfaces, scene.combine, *load, effective_modulus) : std::nullopt;
  if (!scene.grid.extent && !expected) {
    throw InputError(scene.source.string(), "grid.extent", "(missing)",
                     "[L1, L2], two lengths, as [\"1 mm\", \"1 mm\"], since how far the contact reaches is "
                     "not known before it is solved");
  }
  if (scene.grid.extent) require_extent(scene, surfaces, expected);
  std::array<double, 2> h{};
  const Units units(scene.units);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto cells = static_cast<double>(scene.grid.cells[i]);
    const double margin = std::min(kExtentMarginCells, cells / 8.0);
    h[i] = scene.grid.extent ? (*scene.grid.extent)[i] / cells : 2.0 * (*expected)[i] / (cells - 2.0 * margin);
    if (scene.grid.extent && expected && surfaces.size() == 1 && scene.grid.cells[i] > 1 &&
        h[i] > 2.0 * (*expected)[i]) {
      throw InputError(scene.source.string(), "grid.extent", units.pair_text("m", *scene.grid.extent),
                       fmt::format("at most {:.2g} times the contact, about {}, which fills less than "
                                   "one of [{}, {}] cells; or left out",
                                   0.5 * cells, units.pair_text("m", {2.0 * (*expected)[0], 2.0 * (*expected)[1]}),
                                   scene.grid.cells[0], scene.grid.cells[1]));
    }
  }
  return require_not_slender(scene, {scene.grid.cells[0], scene.grid.cells[1], h[0], h[1]});
}

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
  model.pressure_part =
      reducible(scene) ? Reduction(model.grid, model.gap, model.gap.isFinite().cast<double>()) : Reduction(model.grid);
  model.threads = threads_for(scene, model.pressure_part.grid());

  const auto radii = hertzian_radii(surfaces);
  if (radii && model.normal_load && is_bare(scene)) {
    model.hertz = hertz_contact(*model.normal_load, to_dimensionless((*radii)[0], model.length_unit),
                                to_dimensionless((*radii)[1], model.length_unit), model.pair.effective_modulus());
  }
  require_memory(scene, model, {.pressure = 0.0, .tractions = 0.0});
  return model;
}

}  // namespace

Model make_model(const Scene& scene, const Ranks& ranks) {
  return within_double(scene, [&] { return build_model(scene, ranks); });
}

Dimensionless Dimensionless::on_grid(const Grid& in_m, const std::array<double, 2>& centre) const {
  Dimensionless there(in_m.h1);
  there.stress_unit = stress_unit;
  there.grid = {in_m.n1, in_m.n2, 1.0, to_dimensionless(in_m.h2, in_m.h1), in_m.quadrant, in_m.ranks};
  there.pair = pair;
  there.law = std::make_shared<RescaledLaw>(law, there.length_unit / length_unit);
  there.friction = resampled(friction, grid_in_m(), in_m, centre);
  there.hertzian = hertzian;
  there.pressure_coupling = pressure_coupling;
  return there;
}

Elasticity elasticity(const Scene& scene, const Model& model, const Reduction& part) {
  return {.law = model.law,
          .kind = scene.solver.op,
          .threads = model.threads,
          .diagonal = part.diagonal() && !part.grid().ranks.several(),
          .at_edge = scene.ends_at_grid_edge,
          .rounding_seed = static_cast<std::uint64_t>(scene.solver.rounding_seed),
          .cache = model.cache};
}

}  // namespace slipstick::solver
