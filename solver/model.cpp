#include "solver/model.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "solver/coulomb_method.hpp"
#include "solver/field_file.hpp"
#include "solver/input_error.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Fields of one value a cell that a solve holds at once on the whole grid, temporaries included: those of
/// the solution and those that its results are worked out from.
constexpr double kFieldsHeld = 24.0;
/// Those that the paper's method holds besides.
constexpr double kPaperFields = 20.0;
/// Cells left free on each side of the expected contact where the scene does not give an extent.
constexpr double kMarginCells = 2.0;

HalfSpace half_space(const Material& material) {
  return {0.5 * material.young_modulus / (1.0 + material.poisson_ratio), material.poisson_ratio};
}

/// Radii of curvature along x1 and x2 of the shapes that are paraboloids, as spheres are in Hertz's theory.
std::optional<std::array<double, 2>> paraboloid_radii(const Surface& surface) {
  if (surface.shape == Shape::sphere) return std::array{surface.radius, surface.radius};
  if (surface.shape == Shape::ellipsoid) return std::array{surface.radius_1, surface.radius_2};
  return std::nullopt;
}

/// Half the sides of the rectangle that the contact is expected to fill, in the scene's units.
std::array<double, 2> expected_half_sides(const Surface& surface, double load, double effective_modulus) {
  switch (surface.shape) {
    case Shape::sphere:
    case Shape::ellipsoid: {
      const auto radii = *paraboloid_radii(surface);
      const HertzContact contact = hertz_contact(load, radii[0], radii[1], effective_modulus);
      return {contact.semi_axis_1, contact.semi_axis_2};
    }
    case Shape::cone: {  // Sneddon 1965: W = (pi/2) E* a^2 slope
      const double radius = std::sqrt(2.0 * load / (std::numbers::pi * effective_modulus * surface.slope));
      return {radius, radius};
    }
    case Shape::flat_punch:
      return {surface.radius, surface.radius};
    case Shape::height_map:
      break;
  }
  throw std::logic_error("a height map brings its own extent");
}

Grid make_grid(const Scene& scene, double effective_modulus, const Eigen::ArrayXXd& heights) {
  if (scene.surface.shape == Shape::height_map) {
    const std::array<Index, 2> samples{heights.rows(), heights.cols()};
    if (scene.cells != std::array<Index, 2>{} && scene.cells != samples) {
      throw InputError(scene.source.string(), "grid.cells",
                       fmt::format("[{}, {}]", scene.cells[0], scene.cells[1]),
                       fmt::format("[{}, {}], the samples in {}, or left out", samples[0], samples[1],
                                   scene.surface.file.string()));
    }
    return {samples[0], samples[1], scene.surface.spacing[0], scene.surface.spacing[1]};
  }
  const auto half_sides = scene.normal_load
                              ? expected_half_sides(scene.surface, *scene.normal_load, effective_modulus)
                              : std::array<double, 2>{};
  std::array<double, 2> h{};
  for (std::size_t i = 0; i < 2; ++i) {
    if (scene.extent && !((*scene.extent)[i] > 2.0 * half_sides[i])) {
      throw InputError(scene.source.string(), "grid.extent",
                       fmt::format("[{}, {}]", (*scene.extent)[0], (*scene.extent)[1]),
                       fmt::format("larger than the contact, about {:.4g} x {:.4g}, or left out",
                                   2.0 * half_sides[0], 2.0 * half_sides[1]));
    }
    const auto cells = static_cast<double>(scene.cells[i]);
    const double margin = std::min(kMarginCells, cells / 8.0);
    h[i] = scene.extent ? (*scene.extent)[i] / cells : 2.0 * half_sides[i] / (cells - 2.0 * margin);
  }
  return {scene.cells[0], scene.cells[1], h[0], h[1]};
}

/// Undeformed gap in length units.
ArrayXd make_gap(const Surface& surface, const Grid& grid, double unit, const Eigen::ArrayXXd& heights) {
  const ArrayXd x1 = cell_x1(grid);
  const ArrayXd x2 = cell_x2(grid);
  const ArrayXd r = (x1.square() + x2.square()).sqrt();
  switch (surface.shape) {
    case Shape::sphere:
    case Shape::ellipsoid: {
      const auto radii = *paraboloid_radii(surface);
      return x1.square() / (2.0 * over_unit(radii[0], unit)) +
             x2.square() / (2.0 * over_unit(radii[1], unit));
    }
    case Shape::cone:
      return surface.slope * r;
    case Shape::flat_punch:
      return (r <= over_unit(surface.radius, unit))
          .select(ArrayXd::Zero(r.size()),
                  ArrayXd::Constant(r.size(), std::numeric_limits<double>::infinity()));
    case Shape::height_map: {
      const Eigen::ArrayXXd by_x2 = heights.transpose();  // column-major: x2 runs fastest
      return (by_x2.reshaped() - heights.minCoeff()).unaryExpr([unit](double height) {
        return over_unit(height, unit);
      });
    }
  }
  throw std::logic_error("unknown shape");
}

double physical_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

void require_memory(const Scene& scene, const Grid& grid, double bytes) {
  if (bytes < physical_memory()) return;
  throw InputError(
      scene.source.string(), "grid.cells", fmt::format("[{}, {}]", grid.n1, grid.n2),
      fmt::format("what fits in memory: this needs {:.3g} GiB with operator = \"{}\", the machine has {:.3g}",
                  bytes / 0x1p30, to_string(scene.op), physical_memory() / 0x1p30));
}

}  // namespace

double over_unit(double value, double unit) {
  constexpr int bits = 40;
  int exponent = 0;
  const double mantissa = std::frexp(value / unit, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(mantissa, bits)), exponent - bits);
}

namespace {

/// Direct and dense summation are there to be compared with: they sum over all cells.
bool reducible(const Scene& scene) {
  return scene.model != ModelChoice::full && scene.op == OperatorKind::dcfft;
}

}  // namespace

Reduction traction_part(const Scene& scene, Model& model, const Eigen::ArrayXd& pressure) {
  if (!reducible(scene)) return Reduction(model.grid);
  const Reduction part =
      model.pressure_coupling ? Reduction(model.grid, pressure) : Reduction(model.grid, pressure, pressure);
  const Grid& grid = part.grid();
  if (part.trimmed()) {
    const Index mirrored = part.quadrant() ? 2 : 1;
    model.left_out.push_back({fmt::format("all but {} x {} of {} x {} cells", mirrored * grid.n1,
                                          mirrored * grid.n2, model.grid.n1, model.grid.n2),
                              "the rest of the grid lies outside the contact's bounding rectangle"});
  }
  if (part.quadrant()) {
    model.left_out.push_back(
        {"three quarters of the contact", "two mirror axes: q1 is even in x1 and odd in x2, q2 the reverse"});
  }
  if (part.diagonal()) {
    model.left_out.push_back(
        {"one traction field", "the diagonal is a mirror too: q2(x1, x2) = -q1(x2, x1)"});
  }
  return part;
}

Elasticity elasticity(const Scene& scene, const Model& model, const Reduction& part) {
  return {.pair = model.pair,
          .kind = scene.op,
          .threads = scene.threads,
          .precision = scene.precision,
          .diagonal = part.diagonal()};
}

Memory predicted_memory(const Scene& scene, const Model& model) {
  const double fields = kFieldsHeld * sizeof(double) * static_cast<double>(model.grid.cells());
  const Grid& part = model.pressure_part.grid();
  const Elasticity on_part = elasticity(scene, model, model.pressure_part);
  const double normal = scene.pressure == PressureModel::solved ? predicted_normal_bytes(on_part, part) : 0.0;
  // The pressure has the gap's mirrors, unless a file brings it; its tangential displacement has not those of
  // torsion.
  const bool whole = model.pressure_coupling || scene.pressure == PressureModel::file;
  const Grid& grid = whole ? model.grid : part;
  const Elasticity elastic = whole ? elasticity(scene, model, Reduction(model.grid)) : on_part;
  const double coupling = model.pressure_coupling
                              ? predicted_bytes(scene.op, grid, coupling_kernel(), {.threads = scene.threads})
                              : 0.0;
  if (scene.method == Method::paper) {
    const double op = predicted_bytes(scene.op, grid, tangential_kernel(),
                                      {.threads = scene.threads, .diagonal = elastic.diagonal});
    return {std::max({normal, op, coupling}),
            fields + kPaperFields * sizeof(double) * static_cast<double>(grid.cells())};
  }
  return {std::max({normal, predicted_coulomb_bytes(elastic, grid), coupling}), fields};
}

Model make_model(const Scene& scene) {
  const ElasticPair pair = elastic_pair(half_space(scene.lower), half_space(scene.upper));
  const Eigen::ArrayXXd heights =
      scene.surface.shape == Shape::height_map ? read_height_map(scene.surface.file) : Eigen::ArrayXXd();
  const Grid grid = make_grid(scene, pair.effective_modulus(), heights);

  Model model{};
  const bool full = scene.model == ModelChoice::full;
  model.pressure_coupling = scene.coupling == Coupling::pressure ||
                            (scene.coupling == Coupling::automatic && (full || pair.mismatch != 0.0));
  require_memory(scene, grid, kFieldsHeld * sizeof(double) * static_cast<double>(grid.cells()));
  model.length_unit = grid.h1;
  model.stress_unit = pair.shear_modulus();
  const double compliance_unit = pair.shear_compliance;
  model.grid = {grid.n1, grid.n2, 1.0, over_unit(grid.h2, grid.h1)};
  model.pair = {.shear_compliance = 1.0,
                .poisson_compliance = over_unit(pair.poisson_compliance, compliance_unit),
                .normal_compliance = over_unit(pair.normal_compliance, compliance_unit),
                .mismatch = over_unit(pair.mismatch, compliance_unit)};
  model.friction = scene.friction;
  if (scene.normal_load) model.normal_load = over_unit(*scene.normal_load, model.force_unit());
  model.gap = make_gap(scene.surface, model.grid, model.length_unit, heights);
  model.pressure_part = reducible(scene)
                            ? Reduction(model.grid, model.gap, model.gap.isFinite().cast<double>())
                            : Reduction(model.grid);

  if (const auto radii = paraboloid_radii(scene.surface); radii && model.normal_load) {
    model.hertz = hertz_contact(*model.normal_load, over_unit((*radii)[0], model.length_unit),
                                over_unit((*radii)[1], model.length_unit), model.pair.effective_modulus());
  }
  if (!model.pressure_coupling) {
    model.left_out.push_back({"K13, K23", pair.mismatch == 0.0
                                              ? "similar materials: pressure moves both surfaces alike"
                                              : "contact.coupling = \"none\""});
  }
  model.left_out.push_back({"translations", "torsion about the origin of the grid"});
  require_memory(scene, grid, predicted_memory(scene, model).total());
  return model;
}

}  // namespace slipstick::solver
