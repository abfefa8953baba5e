#include "solver/model_solution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "solver/contact/stick_front.hpp"
#include "solver/resolution.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

double equal_area_radius(const Grid& grid, Index cells) {
  return std::sqrt(static_cast<double>(cells) * grid.cell_area() / std::numbers::pi);
}

/// The pressure and the contact under it.
void describe_contact(ModelSolution& solution) {
  const Model& model = solution.model;
  const Grid& grid = model.grid;
  const ArrayXd& pressure = solution.normal.pressure;
  solution.normal_load = pressure.sum() * grid.cell_area() * model.force_unit();
  solution.peak_pressure = pressure.maxCoeff() * model.stress_unit;
  solution.approach = solution.normal.approach * model.length_unit;
  solution.contact_cells = (pressure > 0.0).count();
  solution.contact_radius = measure_contact_radius(model, pressure) * model.length_unit;
  solution.contact_radius_counted = equal_area_radius(grid, solution.contact_cells) * model.length_unit;
}

/// Stick area, loads and their limits, certificate. slip: see ContactState.
void describe_tractions(ModelSolution& solution, const LoadStep& loads, const ArrayXd& slip) {
  const Model& model = solution.model;
  const Grid& grid = model.grid;
  const TangentialProblem& problem = loads.problem;
  const TangentialSolution& tangential = solution.tangential;
  const Index cells = grid.cells();
  solution.stick_cells = (tangential.stick > 0.0).count();
  solution.stick_radius_counted = equal_area_radius(grid, solution.stick_cells) * model.length_unit;
  if (solution.stick_cells == solution.contact_cells) {
    solution.stick_radius = solution.contact_radius;
    solution.stick_radius_note = "everything sticks";
  } else if (solution.detail != Detail::all) {
    solution.stick_radius = solution.stick_radius_counted;
    solution.stick_radius_note = "only counted: nobody asked for more";
  } else if (slip.size() > 0) {
    const StickFront front = find_stick_front(grid, problem.friction_bound, slip, tangential.stick);
    solution.stick_radius = front.radius * model.length_unit;
    solution.stick_radius_note = front.why_counted;
  } else {
    solution.stick_radius = solution.stick_radius_counted;
    solution.stick_radius_note = "the contact has grown: slip does not begin where stick ends";
  }
  const double moment_unit = grid.cell_area() * model.moment_unit();
  const double force_unit = grid.cell_area() * model.force_unit();
  const ArrayXd rotation = rotation_field(grid);
  const double moment = (tangential.traction * rotation).sum();
  const std::array force{tangential.traction.head(cells).sum(), tangential.traction.tail(cells).sum()};
  solution.moment = moment * moment_unit;
  solution.force = {force[0] * force_unit, force[1] * force_unit};
  solution.moment_limit = loads.moment_limit * moment_unit;
  solution.limit = loads.limit;
  if (solution.limit.centre) {
    for (double& x : *solution.limit.centre) x *= model.length_unit;
  }
  solution.certificate = certify({tangential.traction, tangential.elastic_displacement, tangential.slip},
                                 problem.friction_bound, rotation, problem.moment.value_or(moment),
                                 problem.displacement ? force : problem.force.value_or(std::array{0.0, 0.0}),
                                 least_eigenvalue(model.pair, grid.h1, grid.h2));
  solution.slip_direction = slip_direction(tangential.traction, tangential.slip);
  solution.resolution = resolution(grid, loads, tangential.stick, tangential.twist);
}

/// What became of the loads' work.
void describe_energy(ModelSolution& solution, const LoadStep& loads) {
  const Model& model = solution.model;
  const TangentialSolution& tangential = solution.tangential;
  const double unit = model.grid.cell_area() * model.moment_unit();
  solution.elastic_energy = 0.5 * (tangential.traction * tangential.elastic_displacement).sum() * unit;
  solution.dissipated = (loads.problem.friction_bound * norms(tangential.slip)).sum() * unit;
  solution.work = -(tangential.traction * tangential.slip).sum() * unit;
}

}  // namespace

void describe(ModelSolution& solution, const LoadStep& loads, const ArrayXd& slip) {
  describe_contact(solution);
  describe_tractions(solution, loads, slip);
  describe_energy(solution, loads);
}

Solution in_si(ModelSolution solution) {
  const Model& model = solution.model;
  solution.grid = model.grid_in_m();
  solution.friction = model.friction;
  solution.threads = model.threads;
  solution.shear_modulus = model.stress_unit;
  const auto in_unit = [](ArrayXd& field, double unit) {
    field *= unit;
    return std::move(field);
  };
  solution.pressure = in_unit(solution.normal.pressure, model.stress_unit);
  solution.traction = in_unit(solution.tangential.traction, model.stress_unit);
  solution.elastic_displacement = in_unit(solution.tangential.elastic_displacement, model.length_unit);
  solution.slip = in_unit(solution.tangential.slip, model.length_unit);
  solution.stick = std::move(solution.tangential.stick);
  solution.left_out = model.left_out;
  solution.iterations = solution.tangential.iterations;
  solution.change = solution.tangential.change;
  solution.grids = std::move(solution.tangential.grids);
  solution.pressure_iterations = solution.normal.iterations;
  solution.pressure_complementarity = solution.normal.complementarity;
  return solution;
}

double measure_contact_radius(const Dimensionless& model, const ArrayXd& pressure) {
  const double load = pressure.sum();
  const auto mean = [&](const ArrayXd& x) { return (pressure * x).sum() / load; };
  const ArrayXd x1 = cell_x1(model.grid) - mean(cell_x1(model.grid));
  const ArrayXd x2 = cell_x2(model.grid) - mean(cell_x2(model.grid));
  const double covariance = mean(x1.square()) * mean(x2.square()) - mean(x1 * x2) * mean(x1 * x2);
  const double radius = std::sqrt(5.0 * std::sqrt(std::max(covariance, 0.0)));
  // A contact one cell wide has no second moment.
  return model.hertzian && radius > 0.0 ? radius : equal_area_radius(model.grid, (pressure > 0.0).count());
}

}  // namespace slipstick::solver
