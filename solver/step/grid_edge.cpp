#include "solver/step/grid_edge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/contact/full_coupling.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"
#include "solver/scene/roughness.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/step/pressure.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Matrix = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Bodies that run into each other by less than this part of their displacement are open: a pressure solved
/// to a complementarity gap of 1e-10 has displacements no better.
constexpr double kOpen = 1e-5;
/// Cells along the longer side in a trial solve for a sufficient extent. They give the contact's size within
/// a few hundredths.
constexpr Index kTrialCells = 64;
/// Factor of the extent that is proposed where the trials find the present one enough: they know no shear,
/// and under full coupling shear widens the contact.
constexpr double kShearReaches = 1.25;
/// Each trial doubles the extent. A contact beyond the last one is taken as unbounded.
constexpr int kTrials = 8;

bool reaches_edge(const Grid& grid, const ArrayXd& pressure) {
  const Eigen::Map<const Matrix> p(pressure.data(), grid.n1, grid.n2);
  return (p.row(0) > 0.0).any() || (p.row(grid.n1 - 1) > 0.0).any() || (p.col(0) > 0.0).any() ||
         (p.col(grid.n2 - 1) > 0.0).any();
}

/// The grid's cells and those around them where the bodies might touch under a pressure: where the undeformed
/// gap is below the approach. Roughness has no end: as many again as the grid has are looked at.
Grid surroundings(const Scene& scene, const Model& model, double approach) {
  const Grid& grid = model.grid;
  double depth = approach;
  std::vector<Surface> surfaces;
  for (const Surface& surface : scene.surfaces) {
    if (scene.combine == Combine::sum && surface.shape == Shape::roughness && scene.surfaces.size() > 1) {
      // Where the roughness is highest, the other shapes may lie lower by its range.
      const ArrayXd heights = roughness_heights(to_dimensionless(surface, model.length_unit).roughness, grid);
      depth += heights.maxCoeff() - heights.minCoeff();
    } else {
      surfaces.push_back(to_dimensionless(surface, model.length_unit));
    }
  }
  const auto half_sides = half_sides_below(surfaces, scene.combine, depth);
  const auto cells = [](Index inside, double half_side, double h) {
    const double beyond = std::ceil(half_side / h - 0.5 * static_cast<double>(inside));
    const double most = std::max(1.0, std::ceil(0.5 * static_cast<double>(inside)));
    return inside + 2 * static_cast<Index>(std::clamp(beyond, 0.0, most));
  };
  return {cells(grid.n1, half_sides[0], grid.h1),
          cells(grid.n2, half_sides[1], grid.h2),
          grid.h1,
          grid.h2,
          false,
          grid.ranks};
}

/// A grid's cells in a component of a larger one of the same cells.
auto within(const Grid& grid, const Grid& larger, double* component) {
  return Eigen::Map<Matrix>(component, larger.n1, larger.n2)
      .block((larger.n1 - grid.n1) / 2, (larger.n2 - grid.n2) / 2, grid.n1, grid.n2);
}

/// A field of one or more components on a larger grid of the same cells, zero beyond its own.
ArrayXd continued(const Grid& grid, const Grid& larger, const ArrayXd& field) {
  ArrayXd result = ArrayXd::Zero(field.size() / grid.cells() * larger.cells());
  for (Index c = 0; c < field.size() / grid.cells(); ++c) {
    within(grid, larger, result.data() + c * larger.cells()) =
        Eigen::Map<const Matrix>(field.data() + c * grid.cells(), grid.n1, grid.n2);
  }
  return result;
}

}  // namespace

ArrayXd continued_gap(const Scene& scene, const Model& model, const Grid& larger) {
  std::vector<Surface> surfaces;
  for (const Surface& surface : scene.surfaces)
    surfaces.push_back(to_dimensionless(surface, model.length_unit));
  ArrayXd gap = gap_field(surfaces, scene.combine, larger);
  Index lowest = 0;
  const double height = model.gap.minCoeff(&lowest);
  gap += height - within(model.grid, larger, gap.data())(lowest / model.grid.n2, lowest % model.grid.n2);
  return gap;
}

namespace {

/// Displacement that opens the gap on a larger grid, by the pressure and, unless it is empty, a traction.
ArrayXd opening(const Model& model, const Grid& larger, const ArrayXd& pressure, const ArrayXd& traction) {
  const Elasticity elastic{.law = model.law, .threads = model.threads};
  const auto there = [&](const ArrayXd& field) { return continued(model.grid, larger, field); };
  const bool pressed_only = traction.size() == 0;
  const Reduction part = pressed_only && model.pressure_part.quadrant()
                             ? Reduction(larger, there(pressure), ArrayXd::Ones(larger.cells()))
                             : Reduction(larger);
  const auto op = elastic.make(part.grid(), normal_kernel());
  ArrayXd u = part.restricted(there(pressure));
  op->apply(u, u);
  u = part.expanded(std::move(u), normal_symmetry());
  if (!pressed_only) u += ShearOpening(elastic, larger)(there(traction));
  return u;
}

/// Whether the bodies would run into each other beyond the grid.
bool goes_on_beyond(const Scene& scene, const Model& model, const NormalSolution& normal,
                    const ArrayXd& traction) {
  const bool at_edge = reaches_edge(model.grid, normal.pressure);
  if (find_height_map(scene.surfaces) != nullptr || scene.contact.pressure == PressureModel::file)
    return at_edge;
  if (scene.contact.pressure != PressureModel::solved) return false;  // Hertz's fits, or there is no model
  // Away from the axis of one shape the gap only grows.
  if (!at_edge && scene.surfaces.size() == 1 && !is_measured(scene.surfaces.front())) return false;
  const Grid larger = surroundings(scene, model, normal.approach);
  if (larger.cells() == model.grid.cells()) return false;
  const ArrayXd u = opening(model, larger, normal.pressure, traction);
  ArrayXd gap = continued_gap(scene, model, larger);
  gap += u - normal.approach;
  within(model.grid, larger, gap.data()) = 0.0;
  return !(gap >= -kOpen * u.maxCoeff()).all();
}

std::array<double, 2> extent_of(const Model& model) {
  return {model.length_unit * model.grid.h1 * static_cast<double>(model.grid.n1),
          model.length_unit * model.grid.h2 * static_cast<double>(model.grid.n2)};
}

/// Sides of the rectangle about the origin that holds all cells under pressure and one more on each side.
std::array<double, 2> sides_around(const Model& model, const ArrayXd& pressure) {
  const Grid& grid = model.grid;
  const ArrayXd pressed = (pressure > 0.0).cast<double>();
  return {model.length_unit * (2.0 * (pressed * cell_x1(grid).abs()).maxCoeff() + 3.0 * grid.h1),
          model.length_unit * (2.0 * (pressed * cell_x2(grid).abs()).maxCoeff() + 3.0 * grid.h2)};
}

/// An extent that holds the contact under the largest normal load, found on few cells; nothing where no trial
/// holds it.
std::optional<std::array<double, 2>> sufficient_extent(Scene scene, const Model& model, Step step) {
  step.normal = *model.normal_load * model.force_unit();
  scene.steps = {step};
  scene.contact.coupling = Coupling::none;
  scene.solver.model = ModelChoice::automatic;
  scene.solver.op = OperatorKind::dcfft;
  scene.solver.method = Method::coulomb;
  scene.contact.friction.map.clear();  // of the scene's own grid; no friction enters
  std::array<double, 2> extent = extent_of(model);
  const double longer = std::max(extent[0], extent[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    const double cells = std::ceil(0.5 * kTrialCells * extent[i] / longer);
    scene.grid.cells[i] = 2 * std::max<Index>(4, static_cast<Index>(cells));
  }
  for (int trial = 0; trial < kTrials; ++trial) {
    for (double& side : extent) side *= 2.0;
    scene.grid.extent = extent;
    const Model larger = make_model(scene);
    const NormalSolution normal = find_pressure(scene, larger, step);
    if (normal.status == Status::converged && !goes_on_beyond(scene, larger, normal, {})) {
      return sides_around(larger, normal.pressure);
    }
  }
  return std::nullopt;
}

/// The allowed values of grid.extent, in words.
std::string allowed(const Scene& scene, const Model& model, const Step& step) {
  const std::string ends = "or upper.ends_at_grid_edge = true, where the body ends there";
  if (const Surface* const map = find_height_map(scene.surfaces)) {
    return fmt::format(
        "a height map that is larger than the contact, which reaches the outermost points of {}; {}",
        map->map.file.string(), ends);
  }
  if (scene.contact.pressure == PressureModel::file) {
    return fmt::format(
        "a grid with free cells around the pressure, which reaches the outermost ones in {}; {}",
        scene.contact.pressure_file.string(), ends);
  }
  const auto extent = extent_of(model);
  const std::string cut = fmt::format("the contact extends beyond the grid's edge under {} N", *step.normal);
  if (const auto enough = sufficient_extent(scene, model, step)) {
    std::array<double, 2> sides{std::max((*enough)[0], extent[0]), std::max((*enough)[1], extent[1])};
    if (sides == extent) sides = {kShearReaches * sides[0], kShearReaches * sides[1]};
    return fmt::format("[{:.3g}, {:.3g}] m or more, since {}; {}", sides[0], sides[1], cut, ends);
  }
  return fmt::format("one that holds the contact, which {} times this does not, since {}; {}",
                     std::exp2(kTrials), cut, ends);
}

}  // namespace

void require_contact_within_grid(const Scene& scene, const Model& model, const Step& step,
                                 const NormalSolution& normal, const ArrayXd& traction) {
  if (scene.ends_at_grid_edge || normal.status != Status::converged) return;
  if (!goes_on_beyond(scene, model, normal, traction)) return;
  const auto extent = extent_of(model);
  throw InputError(scene.source.string(), "grid.extent",
                   fmt::format("[{:.6g}, {:.6g}]", extent[0], extent[1]), allowed(scene, model, step));
}

}  // namespace slipstick::solver
