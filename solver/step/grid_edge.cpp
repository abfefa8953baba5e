#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "solver/input/input_error.hpp"
#include "solver/input/units.hpp"
#include "solver/scene/roughness.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/step/pressure.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Bodies that run into each other by less than this part of their displacement are open: a pressure solved
/// to a complementarity gap of 1e-10 has displacements no better.
constexpr double kOpen = 1e-5;

bool reaches_edge(const Grid& grid, const ArrayXd& pressure) {
  const auto p = pressure.reshaped(grid.n2, grid.n1);  // a column for each x1
  return (p.row(0) > 0.0).any() || (p.row(grid.n2 - 1) > 0.0).any() || (p.col(0) > 0.0).any() ||
         (p.col(grid.n1 - 1) > 0.0).any();
}

std::vector<Surface> dimensionless_surfaces(const Scene& scene, const Model& model) {
  std::vector<Surface> surfaces;
  for (const Surface& surface : scene.surfaces) surfaces.push_back(to_dimensionless(surface, model.length_unit));
  return surfaces;
}

/// The grid's cells and those around them where the bodies might touch under a pressure: where the undeformed
/// gap is below the approach. Roughness has no end: as many again as the grid has are looked at.
Grid surroundings(const Scene& scene, const Model& model, double approach) {
  const Grid& grid = model.grid;
  double depth = approach;
  std::vector<Surface> surfaces = dimensionless_surfaces(scene, model);
  if (scene.combine == Combine::sum && surfaces.size() > 1) {
    // Where the roughness is highest, the other shapes may lie lower by its range.
    std::erase_if(surfaces, [&](const Surface& surface) {
      if (surface.shape != Shape::roughness) return false;
      const ArrayXd heights = roughness_heights(surface.roughness, grid);
      depth += heights.maxCoeff() - heights.minCoeff();
      return true;
    });
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

/// The undeformed gap on a larger grid of the same cells, at the level that it has on the model's.
ArrayXd continued_gap(const Scene& scene, const Model& model, const Grid& larger) {
  ArrayXd gap = gap_field(dimensionless_surfaces(scene, model), scene.combine, larger);
  Index lowest = 0;
  const double height = model.gap.minCoeff(&lowest);
  gap += height - Reduction(larger, model.grid).restricted(gap)[lowest];
  return gap;
}

/// Displacement that opens the gap on a larger grid, by the pressure and, unless it is empty, a traction.
ArrayXd opening(const Model& model, const Grid& larger, const ArrayXd& pressure, const ArrayXd& traction) {
  const Elasticity elastic{.law = model.law, .threads = model.threads};
  const Reduction inside(larger, model.grid);
  const auto there = [&](const ArrayXd& field) { return inside.expanded(field, normal_symmetry()); };
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

/// Sides, in cells' lengths, of a rectangle about the origin that holds the grid, the cells beyond it where
/// the bodies would run into each other, and one more on each side; nothing where they do not.
std::optional<std::array<double, 2>> sides_of_overlap(const Scene& scene, const Model& model,
                                                      const NormalSolution& normal, const ArrayXd& traction) {
  const Grid& grid = model.grid;
  // Away from the axis of one shape the gap only grows.
  if (scene.surfaces.size() == 1 && !is_measured(scene.surfaces.front()) && !reaches_edge(grid, normal.pressure))
    return std::nullopt;
  const Grid larger = surroundings(scene, model, normal.approach);
  if (larger.cells() == grid.cells()) return std::nullopt;
  const ArrayXd u = opening(model, larger, normal.pressure, traction);
  const ArrayXd gap = continued_gap(scene, model, larger);
  const double open = -kOpen * u.maxCoeff();
  std::array<double, 2> sides{static_cast<double>(grid.n1) * grid.h1, static_cast<double>(grid.n2) * grid.h2};
  const auto whole = sides;
  for (Index cell = 0; cell < larger.cells(); ++cell) {
    if (gap[cell] + (u[cell] - normal.approach) >= open) continue;
    const double x1 = std::abs(larger.x1(cell / larger.n2)), x2 = std::abs(larger.x2(cell % larger.n2));
    if (2.0 * x1 < whole[0] && 2.0 * x2 < whole[1]) continue;  // within the grid
    sides = {std::max(sides[0], 2.0 * x1 + 3.0 * grid.h1), std::max(sides[1], 2.0 * x2 + 3.0 * grid.h2)};
  }
  return sides == whole ? std::nullopt : std::optional(sides);
}

}  // namespace

void require_contact_within_grid(const Scene& scene, const Model& model, const Step& step, const NormalSolution& normal,
                                 const ArrayXd& traction) {
  if (scene.ends_at_grid_edge || normal.status != Status::converged) return;
  const Units units(scene.units);
  const auto refuse = [&](const std::string& allowed) {
    const Grid grid = model.grid_in_m();
    throw InputError(
        scene.source.string(), "grid.extent",
        units.pair_text("m", {grid.h1 * static_cast<double>(grid.n1), grid.h2 * static_cast<double>(grid.n2)}),
        allowed + "; or upper.ends_at_grid_edge = true, where the body ends there");
  };
  const bool at_edge = reaches_edge(model.grid, normal.pressure);
  if (const Surface* const map = find_height_map(scene.surfaces)) {
    if (at_edge)
      refuse("a height map that is larger than the contact, which reaches the outermost points of " +
             map->map.file.string());
  } else if (scene.contact.pressure == PressureModel::file) {
    if (at_edge)
      refuse("a grid with free cells around the pressure, which reaches the outermost ones in " +
             scene.contact.pressure_file.string());
  } else if (scene.contact.pressure == PressureModel::solved) {  // Hertz's fits, or there is no model
    if (const auto sides = sides_of_overlap(scene, model, normal, traction))
      refuse(fmt::format("{} or more, since the contact extends beyond the grid's edge under {} N",
                         units.pair_text("m", {(*sides)[0] * model.length_unit, (*sides)[1] * model.length_unit}),
                         *step.normal));
  }
}

}  // namespace slipstick::solver
