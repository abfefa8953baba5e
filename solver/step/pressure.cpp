#include "solver/step/pressure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/memory_plan.hpp"

namespace slipstick::solver {
namespace {

/// A pressure file's load may differ by this part from load.normal; more is taken for a mistake in units.
constexpr double kLoadTolerance = 1e-2;
/// Complementarity gap of the pressure. A smaller tolerance of the scene, for the certificate of the
/// tractions, holds for the pressure too.
constexpr double kPressureTolerance = 1e-10;

Eigen::ArrayXd pressure_from_file(const Scene& scene, const Model& model) {
  const std::string file = scene.contact.pressure_file.string();
  const auto columns = read_columns(scene.contact.pressure_file, {"x1", "x2", "pressure"});
  const Grid& grid = model.grid;
  const std::vector<Index> cells = cells_of_rows(scene.contact.pressure_file, model.grid_in_m(), columns);
  Eigen::ArrayXd pressure = Eigen::ArrayXd::Zero(grid.cells());
  for (std::size_t row = 0; row < cells.size(); ++row) {
    const double value = columns[2].values[static_cast<Index>(row)];
    if (!(value >= 0.0)) {
      throw InputError(file, fmt::format("row {}: pressure = {}: allowed: zero or positive", row + 1, value));
    }
    pressure[cells[row]] = to_dimensionless(value, model.stress_unit);
  }
  if (!(pressure.sum() > 0.0)) throw InputError(file, "pressure is zero everywhere");
  const double load = pressure.sum() * grid.cell_area();
  if (model.normal_load && std::abs(load / *model.normal_load - 1.0) > kLoadTolerance) {
    throw InputError(scene.source.string(), "load.normal", fmt::format("{} N", *scene.steps[0].normal),
                     fmt::format("left out, or {:.6g} N within 1 %, which the pressure in {} carries",
                                 load * model.force_unit(), file));
  }
  return pressure;
}

NormalSolution given(Eigen::ArrayXd pressure) {
  return {.status = Status::converged, .message = {}, .pressure = std::move(pressure)};
}

/// On the part of the grid that the model leaves; the answer is on the whole one.
NormalSolution solved_pressure(const Scene& scene, const Model& model, double normal_load,
                               const Eigen::ArrayXd& opening, const StaggeredTarget& goal, const Progress& progress) {
  // The opening by shear has none of the symmetries of the gap.
  const Reduction part = opening.size() > 0 ? Reduction(model.grid) : model.pressure_part;
  const double images = part.quadrant() ? 4.0 : 1.0;
  Eigen::ArrayXd gap;  // where it is not the model's
  if (opening.size() > 0) gap = model.gap + opening;
  if (part.trimmed() || part.quadrant()) gap = part.restricted(model.gap);
  NormalSolution solution =
      solve_normal_contact(elasticity(scene, model, part), part.grid(),
                           {.gap = gap.size() > 0 ? gap : model.gap,
                            .total_pressure = normal_load / model.grid.cell_area() / images,
                            .guess = part.restricted(goal.guess)},
                           {.tolerance = std::max(std::min(kPressureTolerance, scene.solver.tolerance), goal.gap),
                            .refine_approach = goal.gap == 0.0,
                            .progress = progress,
                            .on_cells_known = [&](double of_cells) {
                              require_memory(scene, model, {.pressure = of_cells, .tractions = 0.0});
                            }});
  if (part.diagonal()) solution.pressure = symmetrised(part.grid(), solution.pressure);
  solution.pressure = part.expanded(std::move(solution.pressure), normal_symmetry());
  // Shear opens the gap with the symmetry of its friction.
  const bool shear_turns =
      opening.size() == 0 || !model.friction.factors || is_half_turn_symmetric(model.grid, *model.friction.factors);
  if (scene.solver.model != ModelChoice::full && !model.forces && shear_turns &&
      is_half_turn_symmetric(model.grid, model.gap)) {
    solution.pressure = half_turn_symmetrised(solution.pressure);
  }
  return solution;
}

/// Hertz's contact grows like the cube root of its load.
HertzContact under_part_of_load(const HertzContact& contact, double part) {
  const double scale = std::cbrt(part);
  return {scale * contact.semi_axis_1, scale * contact.semi_axis_2, scale * contact.peak_pressure};
}

}  // namespace

NormalSolution find_pressure(const Scene& scene, const Model& model, const Step& step, const Eigen::ArrayXd& opening,
                             const StaggeredTarget& goal, const Progress& progress) {
  if (scene.contact.pressure == PressureModel::file) return given(pressure_from_file(scene, model));
  const double load = to_dimensionless(*step.normal, model.force_unit());
  if (scene.contact.pressure == PressureModel::solved)
    return solved_pressure(scene, model, load, opening, goal, progress);
  const HertzContact hertz = under_part_of_load(*model.hertz, load / *model.normal_load);
  return given(scene.contact.pressure == PressureModel::hertz ? hertz_at_centres(hertz, model.grid)
                                                              : hertz_cell_averages(hertz, model.grid));
}

}  // namespace slipstick::solver
