#include "convergence/results/solution_fields.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "convergence/oracle/errors.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {

std::vector<solver::FieldColumn> solution_columns(const solver::Solution& solution, const OracleAnswer& exact) {
  using solver::Index;
  const solver::Grid grid = solution.grid;
  const Index cells = grid.cells();
  std::vector<solver::FieldColumn> columns;
  const auto add = [&](const char* name, const auto& value) {
    columns.push_back({name, [value](Index first, Index last, double* values) {
                         for (Index cell = first; cell < last; ++cell) *values++ = value(cell);
                       }});
  };
  const auto add_kept = [&](const char* name, const Eigen::ArrayXd& field, Index start) {
    add(name, [&field, start](Index cell) { return field[start + cell]; });
  };
  add("x1", [grid](Index cell) { return grid.x1(cell / grid.n2); });
  add("x2", [grid](Index cell) { return grid.x2(cell % grid.n2); });
  add_kept("pressure", solution.pressure, 0);
  add_kept("q1", solution.traction, 0);
  add_kept("q2", solution.traction, cells);
  add_kept("slip1", solution.slip, 0);
  add_kept("slip2", solution.slip, cells);
  add_kept("stick", solution.stick, 0);
  add("dissipated", [&solution, cells](Index cell) {
    const double s1 = solution.slip[cell];
    const double s2 = solution.slip[cell + cells];
    return solution.friction.bound(solution.pressure, cell) * std::sqrt(s1 * s1 + s2 * s2);
  });
  if (solution.gap_density.size() > 0) add_kept("gap_density", solution.gap_density, 0);
  // Worked out for the first of their columns that is asked for.
  const auto sharp =
      [&solution, kept = std::make_shared<std::optional<std::vector<SharpenedCell>>>() ]() -> const auto& {
    if (!*kept) *kept = sharpened(solution).cells;
    return **kept;
  };
  const auto add_sharp = [&](const char* name, const Eigen::ArrayXd& solved, Index start, const auto& of) {
    add(name, [sharp, &solved, start, of](Index cell) {
      const auto found = std::ranges::lower_bound(sharp(), cell, {}, &SharpenedCell::cell);
      return found != sharp().end() && found->cell == cell ? of(*found) : solved[start + cell];
    });
  };
  add_sharp("pressure_sharpened", solution.pressure, 0, [](const SharpenedCell& c) { return c.pressure; });
  add_sharp("q1_sharpened", solution.traction, 0, [](const SharpenedCell& c) { return c.traction[0]; });
  add_sharp("q2_sharpened", solution.traction, cells, [](const SharpenedCell& c) { return c.traction[1]; });
  if (exact.oracle && exact.oracle->shear) {
    const auto fields = std::make_shared<const ExactFields>(exact_fields(*exact.oracle, grid));
    add("q1_exact", [fields](Index cell) { return fields->traction[cell]; });
    add("q2_exact", [fields, cells](Index cell) { return fields->traction[cells + cell]; });
  }
  return columns;
}

void write_solution_fields(const std::filesystem::path& file, const solver::Solution& solution,
                           const OracleAnswer& exact) {
  solver::write_fields(file, solution.grid, solution_columns(solution, exact), solution.pressure);
}

std::vector<ProfilePoint> make_profile(const solver::Solution& solution, const OracleAnswer& answer) {
  std::vector<ProfilePoint> points;
  if (!answer.oracle || !answer.oracle->shear) return points;
  const Oracle& oracle = *answer.oracle;
  const ExactFields exact = exact_fields(oracle, solution.grid);
  const double unit = 1.0 / oracle.friction.reference_bound;
  const Eigen::ArrayXd value = unit * solver::norms(solution.traction);
  const Eigen::ArrayXd exact_value = unit * solver::norms(exact.traction);
  const solver::Grid& grid = solution.grid;
  const auto add = [&](solver::Index i, solver::Index j) {
    const solver::Index cell = i * grid.n2 + j;
    const double radius = std::hypot(grid.x1(i), grid.x2(j)) / oracle.contact_radius;
    if (radius > 1.0) return;
    points.push_back({radius, value[cell], exact_value[cell], value[cell] - exact_value[cell]});
  };
  for (solver::Index i = grid.n1 / 2; i < grid.n1; ++i) add(i, grid.n2 / 2);
  for (solver::Index i = grid.n1 / 2 + 1; i < grid.n1; ++i) add(i, i);
  return points;
}

GridColumns exact_columns(const solver::Scene& scene, const Oracle& oracle, const solver::Ranks& ranks) {
  if (!oracle.shear) {
    throw solver::InputError(scene.source.string(), "solver.model", "\"exact\"",
                             "auto, full with --fields (the exact solution has the stick ratio only)");
  }
  solver::Scene sampled = scene;
  sampled.solver.op =
      solver::OperatorKind::dcfft;  // no operator is made, so none of the larger ones need fit in memory
  const solver::Grid grid = solver::make_model(sampled, ranks).grid_in_m();
  const solver::Index cells = grid.cells();
  const ExactFields fields = exact_fields(oracle, grid);
  std::vector<solver::Column> columns{
      {"x1", solver::cell_x1(grid)},       {"x2", solver::cell_x2(grid)},
      {"pressure", fields.pressure},       {"q1", fields.traction.head(cells)},
      {"q2", fields.traction.tail(cells)}, {"stick", (fields.radius < oracle.stick_radius).cast<double>()},
  };
  return {.grid = grid, .columns = std::move(columns), .pressure = fields.pressure};
}

void write_exact_fields(const std::filesystem::path& file, const solver::Scene& scene, const Oracle& oracle,
                        const solver::Ranks& ranks) {
  const GridColumns fields = exact_columns(scene, oracle, ranks);
  solver::write_fields(file, fields.grid, fields.columns, fields.pressure);
}

}  // namespace slipstick::convergence
