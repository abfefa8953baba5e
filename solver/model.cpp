#include "solver/model.hpp"

#include <cmath>
#include <cstdint>
#include <system_error>
#include <thread>
#include <utility>

#include "solver/contact/coulomb_method.hpp"
#include "solver/elasticity/law/coated_half_spaces.hpp"
#include "solver/elasticity/law/law_kind.hpp"
#include "solver/elasticity/law/rescaled_law.hpp"
#include "solver/grid/own_rows.hpp"
#include "solver/input/input_error.hpp"
#include "solver/memory.hpp"
#include "solver/scene/last_digits.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/within_double.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Doubles a cell of the whole grid that a solve holds beside operators and workspaces. Measured, as all that
/// follow, by convergence/solve/tests/memory_test.py.
constexpr double kFieldsHeld = 3.2;
/// Doubles a cell of the part that is solved; each of several processes has its own rows of it.
constexpr double kFieldsOfPart = 2.0;
/// Doubles a cell of the whole grid before and after the solve, when operators and workspaces are gone.
constexpr double kFieldsAround = 12.0;
constexpr double kFieldsAroundPressure = 9.3;  ///< alone, on the whole grid
/// Doubles a cell of the whole grid that a pressure's solve holds beside operators and workspaces.
constexpr double kFieldsOfPressure = 1.4;
/// Doubles a cell of the part that the other methods than Coulomb's hold.
constexpr double kFieldsOfOthers = 21.0;
/// Doubles a cell of the whole grid of the step before.
constexpr double kFieldsBefore = 37.0;
/// Doubles a cell of the whole grid where pressure and tractions are solved in turn: Anderson's combination
/// and guesses. They stand in for much of the step before.
constexpr double kFieldsOfTurns = 58.0;
constexpr double kFieldsBeforeTurns = 21.0;
/// The program and its libraries, that for HDF5 included; where several processes share a grid MPI's too.
double program_bytes(const Grid& grid) { return (grid.ranks.several() ? 35.0 : 25.0) * 0x1p20; }
double field_bytes(double fields, Index cells) {
  return fields * sizeof(double) * static_cast<double>(cells);
}
double bytes_around(const Scene& scene, const Grid& grid) {
  const bool pressure = scene.friction.is_frictionless() && scene.model == ModelChoice::full;
  return field_bytes(pressure ? kFieldsAroundPressure : kFieldsAround, grid.cells());
}
/// Cells left free on each side of the expected contact where the scene does not give an extent.
constexpr double kExtentMarginCells = 2.0;
/// Largest ratio of a cell's sides. Beyond it every method crawls.
constexpr double kMaxSlender = 1000.0;

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

std::optional<double> largest_normal(const Scene& scene) {
  std::optional<double> largest;
  for (const Step& step : scene.steps) {
    if (step.normal && !(largest >= step.normal)) largest = step.normal;
  }
  return largest;
}

/// Half the sides of what is known before the solve to lie in the contact: that of one shape, and where the
/// nearest of several shapes is lowest.
std::array<double, 2> least_half_sides(const Scene& scene, const std::vector<Surface>& surfaces,
                                       const std::optional<std::array<double, 2>>& expected) {
  const bool hertz =
      scene.pressure == PressureModel::hertz || scene.pressure == PressureModel::hertz_averaged;
  if (scene.ends_at_grid_edge && !hertz) return {};
  if (surfaces.size() == 1) return expected.value_or(std::array<double, 2>{});
  const bool pressed = scene.combine == Combine::nearest && scene.pressure == PressureModel::solved;
  return pressed && expected ? half_sides_below(surfaces, Combine::nearest, 0.0) : std::array<double, 2>{};
}

/// Looks for what needs no solve; see require_contact_within_grid().
void require_extent(const Scene& scene, const std::vector<Surface>& surfaces,
                    const std::optional<std::array<double, 2>>& expected) {
  const auto least = least_half_sides(scene, surfaces, expected);
  const auto& extent = *scene.extent;
  if (extent[0] > 2.0 * least[0] && extent[1] > 2.0 * least[1]) return;
  const bool one = surfaces.size() == 1;
  throw InputError(scene.source.string(), "grid.extent", fmt::format("[{}, {}]", extent[0], extent[1]),
                   fmt::format("larger than {}, about {:.4g} x {:.4g}, or left out",
                               one ? "the contact" : "the rectangle that the contacts of all shapes may fill",
                               2.0 * (*expected)[0], 2.0 * (*expected)[1]));
}

Grid require_not_slender(const Scene& scene, const Grid& grid) {
  const double slender = grid.h1 / grid.h2;
  if (slender <= kMaxSlender && slender >= 1.0 / kMaxSlender) return grid;
  throw InputError(scene.source.string(), "grid.cells", fmt::format("[{}, {}]", grid.n1, grid.n2),
                   fmt::format("cells at most {} times as long as wide; these are {:.4g} x {:.4g}",
                               kMaxSlender, grid.h1, grid.h2));
}

Grid make_grid(const Scene& scene, const std::vector<Surface>& surfaces, double effective_modulus) {
  if (const auto grid = height_map_grid(surfaces)) {
    const std::array<Index, 2> samples{grid->n1, grid->n2};
    if (scene.cells != std::array<Index, 2>{} && scene.cells != samples) {
      throw InputError(scene.source.string(), "grid.cells",
                       fmt::format("[{}, {}]", scene.cells[0], scene.cells[1]),
                       fmt::format("[{}, {}], the samples in {}, or left out", samples[0], samples[1],
                                   find_height_map(surfaces)->file.string()));
    }
    return require_not_slender(scene, *grid);
  }
  const auto load = largest_normal(scene);
  // Where a layer is bonded to a body, the contact is not known, but a rectangle around it.
  const bool known = load && scene.layer.kind == nullptr && !(scene.extent && is_coated(scene));
  const auto expected =
      known ? expected_half_sides(surfaces, scene.combine, *load, effective_modulus) : std::nullopt;
  if (!scene.extent && !expected) {
    throw InputError(scene.source.string(), "grid.extent", "(missing)",
                     "[L1, L2] in m, since how far the contact reaches is not known before it is solved");
  }
  if (scene.extent) require_extent(scene, surfaces, expected);
  std::array<double, 2> h{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto cells = static_cast<double>(scene.cells[i]);
    const double margin = std::min(kExtentMarginCells, cells / 8.0);
    h[i] = scene.extent ? (*scene.extent)[i] / cells : 2.0 * (*expected)[i] / (cells - 2.0 * margin);
    if (scene.extent && expected && surfaces.size() == 1 && scene.cells[i] > 1 &&
        h[i] > 2.0 * (*expected)[i]) {
      throw InputError(
          scene.source.string(), "grid.extent",
          fmt::format("[{}, {}]", (*scene.extent)[0], (*scene.extent)[1]),
          fmt::format("at most {:.2g} times the contact, about {:.4g} x {:.4g}, which fills less than "
                      "one of [{}, {}] cells; or left out",
                      0.5 * cells, 2.0 * (*expected)[0], 2.0 * (*expected)[1], scene.cells[0],
                      scene.cells[1]));
    }
  }
  return require_not_slender(scene, {scene.cells[0], scene.cells[1], h[0], h[1]});
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

/// Bytes. Below this size the memory check is skipped.
constexpr double kLittleMemory = 0x1p26;

void require_memory(const Scene& scene, const Grid& grid, double bytes) {
  if (!scene.memory_limit && bytes < kLittleMemory) return;
  const double most = memory_within(scene.memory_limit);
  if (bytes < most) return;
  throw OutOfMemory(
      scene.source.string(), "grid.cells", fmt::format("[{}, {}]", grid.n1, grid.n2),
      fmt::format("what fits in memory: this needs {} with operator = \"{}\", and {} {}; {} less",
                  bytes_text(bytes), to_string(scene.op), bytes_text(most),
                  scene.memory_limit ? "are allowed (--memory-limit)" : "are there",
                  scene.op == OperatorKind::dense    ? "fewer cells and operator = \"dcfft\" take"
                  : scene.model == ModelChoice::full ? "fewer cells and model = \"auto\" take"
                                                     : "fewer cells take"));
}

/// A table's text is held as a whole while it is read.
void require_memory_for_files(const Scene& scene) {
  std::vector<std::filesystem::path> files{scene.pressure_file, scene.friction.map};
  for (const Surface& surface : scene.surfaces) files.push_back(surface.file);
  for (const std::filesystem::path& file : files) {
    std::error_code error;
    const std::uintmax_t size = file.empty() ? 0 : std::filesystem::file_size(file, error);
    const auto bytes = static_cast<double>(size);
    if (error || bytes < kLittleMemory || bytes < memory_within(scene.memory_limit)) continue;
    throw OutOfMemory(file.string(),
                      fmt::format("holds {}; allowed: what fits in memory, {}", bytes_text(bytes),
                                  bytes_text(memory_within(scene.memory_limit))));
  }
}

/// Direct and dense summation are there to be compared with: they sum over all cells.
bool reducible(const Scene& scene) {
  return scene.model != ModelChoice::full && scene.op == OperatorKind::dcfft;
}

}  // namespace

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

namespace {

/// A field with the symmetries of the friction bound: the pressure, unless a map has others. A step before
/// may have left tractions that are asymmetric like the map elsewhere.
ArrayXd carrying(const Model& model, const ArrayXd& pressure, bool is_first) {
  if (!model.friction.factors) return pressure;
  const ArrayXd bound = model.friction.bound(pressure);
  return is_first ? bound : (pressure > 0.0).select(bound, *model.friction.factors);
}

}  // namespace

bool moves_by_pressure(const Scene& scene, const Model& model) {
  return model.pressure_coupling && model.law->couples() && !scene.friction.is_frictionless();
}

bool has_translations(const Scene& scene, const Model& model, const ArrayXd& pressure, bool is_first) {
  if (scene.method != Method::coulomb) return false;
  return scene.model == ModelChoice::full || model.forces ||
         !is_half_turn_symmetric(model.grid, carrying(model, pressure, is_first));
}

Reduction traction_part(const Scene& scene, const Model& model, const Eigen::ArrayXd& pressure,
                        const Eigen::ArrayXd& before) {
  if (!reducible(scene)) return Reduction(model.grid);
  const ArrayXd occupied = before.size() > 0 ? ArrayXd(pressure.max(before)) : pressure;
  const bool mirrored = !model.pressure_coupling && !model.forces;
  if (mirrored && model.friction.factors && before.size() > 0) {
    const Reduction all(model.grid, carrying(model, pressure, false), ArrayXd::Ones(model.grid.cells()));
    return all.quadrant() ? all : Reduction(model.grid, occupied);
  }
  return mirrored ? Reduction(model.grid, carrying(model, pressure, true), occupied)
                  : Reduction(model.grid, occupied);
}

void note_omissions(Model& model, const Scene& scene, const Reduction& part, bool translations) {
  std::vector<Omission>& left_out = model.left_out;
  const Grid& grid = part.grid();
  left_out = scene.left_out;
  if (!model.pressure_coupling) {
    left_out.push_back({"K13, K23", !model.law->couples()
                                        ? "similar materials: pressure moves both surfaces alike"
                                        : "contact.coupling = \"none\""});
  } else if (!model.shear_coupling && model.law->couples()) {
    left_out.push_back(
        {"K31, K32", "shear leaves the pressure as it is, unless contact.coupling = \"full\""});
  }
  if (!translations) {
    left_out.push_back({"translations", scene.method == Method::coulomb
                                            ? "no force, and half a turn brings the contact onto itself"
                                            : "this method turns about the origin of the grid"});
  }
  if (part.trimmed()) {
    const Index mirrored = part.quadrant() ? 2 : 1;
    left_out.push_back({fmt::format("all but {} x {} of {} x {} cells", mirrored * grid.n1,
                                    mirrored * grid.n2, model.grid.n1, model.grid.n2),
                        "the rest of the grid lies outside the contact's bounding rectangle"});
  }
  if (part.quadrant()) {
    left_out.push_back(
        {"three quarters of the contact", "two mirror axes: q1 is even in x1 and odd in x2, q2 the reverse"});
  }
  if (part.diagonal()) {
    left_out.push_back({"one traction field", "the diagonal is a mirror too: q2(x1, x2) = -q1(x2, x1)"});
  }
}

Elasticity elasticity(const Scene& scene, const Model& model, const Reduction& part) {
  return {.law = model.law,
          .kind = scene.op,
          .threads = model.threads,
          .diagonal = part.diagonal() && !part.grid().ranks.several(),
          .at_edge = scene.ends_at_grid_edge,
          .rounding_seed = static_cast<std::uint64_t>(scene.rounding_seed),
          .cache = model.cache};
}

Memory predicted_memory(const Scene& scene, const Model& model, const LookedAt& parts) {
  const bool follows = scene.steps.size() > 1 || scene.cycles > 1;
  const double before = model.shear_coupling ? kFieldsBeforeTurns : kFieldsBefore;
  const double turns = model.shear_coupling ? kFieldsOfTurns : 0.0;
  const double kept = field_bytes((follows ? before : 0.0) + turns, model.grid.cells());
  const Grid& part = model.pressure_part.grid();
  const Elasticity on_part = elasticity(scene, model, model.pressure_part);
  const double normal = scene.pressure == PressureModel::solved
                            ? on_part.newton_bytes(part, normal_kernel(), parts.pressure)
                            : 0.0;
  // The pressure has the gap's mirrors, unless a file brings it; its tangential displacement has not those of
  // torsion.
  const bool whole = model.pressure_coupling || model.forces || scene.pressure == PressureModel::file;
  const Grid& grid = whole ? model.grid : part;
  const Elasticity elastic = whole ? elasticity(scene, model, Reduction(model.grid)) : on_part;
  const double coupling =
      moves_by_pressure(scene, model) ? elastic.operator_bytes(grid, coupling_kernel()) : 0.0;
  const bool newton = scene.method == Method::coulomb;
  const double tangential = !newton ? elastic.operator_bytes(grid, tangential_kernel())
                            : scene.friction.is_frictionless()
                                ? 0.0  // nothing is solved
                                : elastic.newton_bytes(grid, tangential_kernel(), parts.tractions);
  const double of_part = newton ? field_bytes(kFieldsOfPart, own_rows(grid).count() * grid.n2)
                                : field_bytes(kFieldsOfOthers, grid.cells());
  const double pressed = normal + kept + field_bytes(kFieldsOfPressure, model.grid.cells());
  const double held =
      std::max(tangential, coupling) + kept + of_part + field_bytes(kFieldsHeld, model.grid.cells());
  const double solver = std::max({normal, tangential, coupling});
  return {solver, program_bytes(grid) + std::max({pressed, held, bytes_around(scene, model.grid)}) - solver};
}

void require_memory(const Scene& scene, const Model& model, const LookedAt& parts) {
  require_memory(scene, model.grid, predicted_memory(scene, model, parts).total());
}

namespace {

/// A thread that has fewer cells waits for the others about as long as it works.
constexpr Index kCellsOfThread = Index{1} << 15;

int threads_for(const Scene& scene, const Grid& part) {
  if (scene.threads > 0) return scene.threads;
  if (part.ranks.several()) return 1;  // each process takes a processor
  const Index processors = std::max(1U, std::thread::hardware_concurrency());
  return static_cast<int>(std::clamp<Index>(part.cells() / kCellsOfThread, 1, processors));
}

/// The law of the bodies, and of layers that are bonded to them.
SharedLaw law_of_bodies(const Scene& scene, const Model& model) {
  if (!is_coated(scene)) return std::make_shared<HalfSpaces>(model.pair, scene.cell_traction);
  const auto dimensionless = [&](const Material& material) {
    CoatedBody body = coated_body(material);
    for (HalfSpace* const half : {&body.surface, &body.base})
      half->shear_modulus = to_dimensionless(half->shear_modulus, model.stress_unit);
    body.thickness = to_dimensionless(body.thickness, model.length_unit);
    return body;
  };
  return std::make_shared<CoatedHalfSpaces>(dimensionless(scene.lower), dimensionless(scene.upper),
                                            scene.cell_traction);
}

/// The bodies' law, and on top of it that of the layer between them.
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
  const bool full = scene.model == ModelChoice::full;
  model.shear_coupling = scene.coupling == Coupling::full;
  model.forces = std::any_of(scene.steps.begin(), scene.steps.end(), brings_translation);
  require_memory(scene, grid, bytes_around(scene, grid));
  model.stress_unit = pair.shear_modulus();
  const double compliance_unit = pair.shear_compliance;
  model.grid = {grid.n1, grid.n2, 1.0, to_dimensionless(grid.h2, grid.h1), false, ranks};
  model.pair = {.shear_compliance = 1.0,
                .poisson_compliance = to_dimensionless(pair.poisson_compliance, compliance_unit),
                .normal_compliance = to_dimensionless(pair.normal_compliance, compliance_unit),
                .mismatch = to_dimensionless(pair.mismatch, compliance_unit)};
  model.law = make_law(scene, model);
  const bool couples = model.law->couples();
  model.pressure_coupling = scene.coupling == Coupling::pressure || model.shear_coupling ||
                            (scene.coupling == Coupling::automatic && (full || couples));
  model.hertzian = is_hertzian(surfaces) && scene.pressure != PressureModel::file &&
                   !(model.shear_coupling && couples) && is_bare(scene) && !scene.ends_at_grid_edge;
  model.friction = with_factors(scene.friction, grid).to_dimensionless(model.stress_unit);
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
