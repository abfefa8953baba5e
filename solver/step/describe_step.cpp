#include "solver/step/describe_step.hpp"

#include <numbers>
#include <utility>

#include "solver/contact/stick_front.hpp"
#include "solver/grid/counted_area.hpp"
#include "solver/grid/motion_field.hpp"
#include "solver/grid/sweep.hpp"
#include "solver/step/resolution.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Duality gaps: slip that dissipates less may be rounding,
constexpr double kGapsOfNoSlip = 10.0;
/// where it dissipates less than this part of the elastic energy, too.
constexpr double kNoSlip = 1e-5;

double equal_area_radius(const Grid& grid, Index cells) {
  return std::sqrt(static_cast<double>(cells) * grid.cell_area() / std::numbers::pi);
}

/// Cells that counting adds to a contact at each side of its edge.
double counted_by_side(const Scene& scene) {
  const bool is_face = std::ranges::any_of(
      scene.surfaces, [](const Surface& surface) { return surface.shape == Shape::flat_punch; });
  // Hertz's pressure is that at the centres of cells.
  if (is_face || scene.pressure == PressureModel::hertz) return 0.0;
  return scene.pressure == PressureModel::hertz_averaged ? kCutBySide : kCountedBySide;
}

/// The pressure and the contact under it.
void describe_contact(ModelSolution& solution, const Scene& scene) {
  const Model& model = solution.model;
  const Grid& grid = model.grid;
  const ArrayXd& pressure = solution.normal.pressure;
  solution.normal_load = pressure.sum() * grid.cell_area() * model.force_unit();
  solution.peak_pressure = pressure.maxCoeff() * model.stress_unit;
  solution.approach = solution.normal.approach * model.length_unit;
  solution.contact_cells = (pressure > 0.0).count();
  solution.contact_area = counted_area(model.grid_in_m(), pressure, counted_by_side(scene));
  solution.contact_radius = measure_contact_radius(model, pressure) * model.length_unit;
  solution.contact_radius_counted = equal_area_radius(grid, solution.contact_cells) * model.length_unit;
}

/// Force along x1 and x2 and moment of the tractions, over the cell's area.
std::array<double, 3> resultants_of(const ArrayXd& traction, const Grid& grid) {
  const MotionField rotation(grid, 0.0, 0.0, 1.0);
  const Index cells = grid.cells();
  return Sweep::whole(grid).sum<std::array<double, 3>>([&](Index first, Index last, auto& sum) {
    const auto q1 = traction.segment(first, last - first);
    const auto q2 = traction.segment(first + cells, last - first);
    sum += std::array{q1.sum(), q2.sum(), rotation.dot(first, q1) + rotation.dot(first + cells, q2)};
  });
}

/// Stick area, loads and their limits, certificate. slip: see ContactState.
void describe_tractions(ModelSolution& solution, const LoadStep& loads, const ArrayXd& slip) {
  const Model& model = solution.model;
  const Grid& grid = model.grid;
  const TangentialProblem& problem = loads.problem;
  const TangentialSolution& tangential = solution.tangential;
  solution.stick_cells = (tangential.stick > 0.0).count();
  const bool sticks = solution.stick_cells == solution.contact_cells;
  solution.stick_area = sticks ? solution.contact_area : counted_area(model.grid_in_m(), tangential.stick);
  solution.stick_radius_counted = equal_area_radius(grid, solution.stick_cells) * model.length_unit;
  if (sticks) {
    solution.stick_radius = solution.contact_radius;
    solution.stick_radius_note = "everything sticks";
  } else if (solution.detail != Detail::all) {
    solution.stick_radius = solution.stick_radius_counted;
    solution.stick_radius_note = "cells counted; no sub-cell fit was asked for";
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
  const auto [force1, force2, moment] = resultants_of(tangential.traction, grid);
  const std::array force{force1, force2};
  solution.moment = moment * moment_unit;
  solution.force = {force[0] * force_unit, force[1] * force_unit};
  solution.moment_limit = loads.moment_limit * moment_unit;
  solution.friction_force = problem.friction_bound.sum() * force_unit;
  solution.limit = loads.limit;
  if (solution.limit.centre) {
    for (double& x : *solution.limit.centre) x *= model.length_unit;
  }
  const bool inherits = problem.energy_before > 0.0 || model.pressure_coupling;
  const double reach = 0.5 * std::hypot(grid.x1(grid.n1 - 1) - grid.x1(0), grid.x2(grid.n2 - 1) - grid.x2(0));
  const double motion =
      std::hypot(tangential.displacement[0], tangential.displacement[1]) + std::abs(tangential.twist) * reach;
  solution.certificate = certify({tangential.traction, tangential.elastic_displacement, tangential.slip},
                                 problem.friction_bound, grid, problem.moment.value_or(moment),
                                 problem.displacement ? force : problem.force.value_or(std::array{0.0, 0.0}),
                                 model.law->least_eigenvalue(grid.h1, grid.h2),
                                 {problem.energy_before, inherits ? motion : 0.0});
}

/// Where the work of the loads went.
void describe_energy(ModelSolution& solution, const LoadStep& loads) {
  const Model& model = solution.model;
  const TangentialSolution& tangential = solution.tangential;
  const double unit = model.grid.cell_area() * model.moment_unit();
  const Index cells = model.grid.cells();
  const ArrayXd& bound = loads.problem.friction_bound;
  using Sums = std::array<double, 3>;  // over the moment's unit and the cell's area
  const auto [elastic, dissipated, of_loads] =
      Sweep::whole(model.grid).sum<Sums>([&](Index first, Index last, Sums& sum) {
        const Index n = last - first;
        const auto q1 = tangential.traction.segment(first, n);
        const auto q2 = tangential.traction.segment(first + cells, n);
        const auto s1 = tangential.slip.segment(first, n);
        const auto s2 = tangential.slip.segment(first + cells, n);
        const ArrayXd& u = tangential.elastic_displacement;
        sum += Sums{0.5 * (q1 * u.segment(first, n) + q2 * u.segment(first + cells, n)).sum(),
                    (bound.segment(first, n) * (s1.square() + s2.square()).sqrt()).sum(),
                    -(q1 * s1 + q2 * s2).sum()};
      });
  solution.elastic_energy = elastic * unit;
  solution.dissipated = dissipated * unit;
  solution.work = of_loads * unit;
  // Slip that may be rounding has no direction.
  const Certificate& certificate = solution.certificate;
  const bool slips = solution.stick_cells < solution.contact_cells &&
                     !(dissipated <= std::min(kGapsOfNoSlip * certificate.gap, kNoSlip) * certificate.energy);
  solution.slip_direction = slips ? slip_direction(tangential.traction, tangential.slip)
                                  : SlipDirection{std::nan(""), std::nan("")};
}

}  // namespace

void describe(ModelSolution& solution, const Scene& scene, const LoadStep& loads, const ArrayXd& slip) {
  describe_contact(solution, scene);
  describe_tractions(solution, loads, slip);
  const Model& model = solution.model;
  solution.resolution =
      resolution(scene, solution.loads, model.grid, loads, solution.tangential, solution.contact_area);
  solution.stick_area.uncertainty += solution.resolution.stick_area * model.grid_in_m().cell_area();
  solution.resolution.open.displacement *= model.length_unit;
  describe_energy(solution, loads);
}

Solution in_si(ModelSolution solution) {
  const Model& model = solution.model;
  solution.grid = model.grid_in_m();
  solution.friction = model.friction.to_dimensionless(1.0 / model.stress_unit);
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
  solution.certificate.energy *= model.grid.cell_area() * model.moment_unit();
  solution.iterations = solution.tangential.iterations;
  solution.change = solution.tangential.change;
  solution.grids = std::move(solution.tangential.grids);
  solution.pressure_iterations = solution.normal.iterations;
  solution.pressure_complementarity = solution.normal.complementarity;
  return solution;
}

double measure_contact_radius(const Dimensionless& model, const ArrayXd& pressure) {
  const Grid& grid = model.grid;
  const ArrayXd x2 = ArrayXd::NullaryExpr(grid.n2, [&](Index j) { return grid.x2(j); });
  const Sweep rows = Sweep::whole(grid);
  using Moments =
      std::array<double, 6>;  // zeroth, first (x1, x2) and second (11, 12, 22), over the cell's area
  const auto moments_about = [&](double c1, double c2) {
    return rows.sum<Moments>([&](Index first, Index last, Moments& sum) {
      const auto p = pressure.segment(first, last - first);
      const double y1 = grid.x1(first / grid.n2) - c1;
      const double load = p.sum();
      const double along2 = (p * (x2 - c2)).sum();
      sum += Moments{load, y1 * load, along2, y1 * y1 * load, y1 * along2, (p * (x2 - c2).square()).sum()};
    });
  };
  const Moments about_origin = moments_about(0.0, 0.0);
  const Moments about_centroid =
      moments_about(about_origin[1] / about_origin[0], about_origin[2] / about_origin[0]);
  const auto mean = [&](std::size_t k) { return about_centroid[k] / about_centroid[0]; };
  const double covariance = mean(3) * mean(5) - mean(4) * mean(4);
  const double radius = std::sqrt(5.0 * std::sqrt(std::max(covariance, 0.0)));
  // A contact one cell wide has no second moment.
  return model.hertzian && radius > 0.0 ? radius : equal_area_radius(model.grid, (pressure > 0.0).count());
}

}  // namespace slipstick::solver
