#include "solver/step/describe_step.hpp"

#include <numbers>

#include "solver/contact/stick_front.hpp"
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
  const bool is_face =
      std::ranges::any_of(scene.surfaces, [](const Surface& surface) { return surface.shape == Shape::flat_punch; });
  // Hertz's pressure is that at the centres of cells.
  if (is_face || scene.contact.pressure == PressureModel::hertz) return 0.0;
  return scene.contact.pressure == PressureModel::hertz_averaged ? kCutBySide : kCountedBySide;
}

ContactNumbers describe_contact(const Scene& scene, const Model& model, const NormalSolution& normal) {
  const Grid& grid = model.grid;
  const ArrayXd& pressure = normal.pressure;
  const Index cells = (pressure > 0.0).count();
  return {.normal_load = pressure.sum() * grid.cell_area(),
          .peak_pressure = pressure.maxCoeff(),
          .approach = normal.approach,
          .contact_radius = measure_contact_radius(model, pressure),
          .contact_radius_counted = equal_area_radius(grid, cells),
          .contact_cells = cells,
          .contact_area = counted_area(model.grid_in_m(), pressure, counted_by_side(scene))};
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

StickNumbers describe_stick(const Model& model, const SolvedStep& solved, const ContactNumbers& contact,
                            const ArrayXd& slip, Detail detail) {
  const ArrayXd& stick = solved.tangential.stick;
  StickNumbers numbers;
  numbers.stick_cells = (stick > 0.0).count();
  const bool sticks = numbers.stick_cells == contact.contact_cells;
  numbers.stick_area = sticks ? contact.contact_area : counted_area(model.grid_in_m(), stick);
  numbers.stick_radius_counted = equal_area_radius(model.grid, numbers.stick_cells);
  numbers.stick_radius = numbers.stick_radius_counted;
  if (sticks) {
    numbers.stick_radius = contact.contact_radius;
    numbers.stick_radius_note = "everything sticks";
  } else if (detail != Detail::all) {
    numbers.stick_radius_note = "cells counted, without a sub-cell fit";
  } else if (slip.size() > 0) {
    const StickFront front = find_stick_front(model.grid, solved.loads.problem.friction_bound, slip, stick);
    numbers.stick_radius = front.radius;
    numbers.stick_radius_note = front.why_counted;
  } else {
    numbers.stick_radius_note = "the contact has grown: slip does not begin where stick ends";
  }
  return numbers;
}

LoadNumbers describe_loads(const Model& model, const SolvedStep& solved, const RigidMotion& motion) {
  const auto [force1, force2, moment] = resultants_of(solved.tangential.traction, model.grid);
  return {.twist_angle = motion.twist,
          .displacement = {motion.delta1, motion.delta2},
          .moment = moment,
          .force = {force1, force2},
          .moment_limit = solved.loads.moment_limit,
          .friction_force = solved.loads.problem.friction_bound.sum(),
          .limit = solved.loads.limit};
}

Certificate certificate_of(const Model& model, const SolvedStep& solved, const LoadNumbers& carried) {
  const Grid& grid = model.grid;
  const TangentialProblem& problem = solved.loads.problem;
  const TangentialSolution& tangential = solved.tangential;
  const bool inherits = problem.energy_before > 0.0 || model.pressure_coupling;
  const double reach = 0.5 * std::hypot(grid.x1(grid.n1 - 1) - grid.x1(0), grid.x2(grid.n2 - 1) - grid.x2(0));
  const double motion =
      std::hypot(tangential.displacement[0], tangential.displacement[1]) + std::abs(tangential.twist) * reach;
  return certify({tangential.traction, tangential.elastic_displacement, tangential.slip}, problem.friction_bound, grid,
                 problem.moment.value_or(carried.moment),
                 problem.displacement ? carried.force : problem.force.value_or(std::array{0.0, 0.0}),
                 model.law->least_eigenvalue(grid.h1, grid.h2), {problem.energy_before, inherits ? motion : 0.0});
}

EnergyNumbers describe_energy(const Model& model, const LoadStep& loads, const TangentialSolution& tangential) {
  const Index cells = model.grid.cells();
  const ArrayXd& bound = loads.problem.friction_bound;
  using Sums = std::array<double, 3>;
  const auto [elastic, dissipated, of_loads] =
      Sweep::whole(model.grid).sum<Sums>([&](Index first, Index last, Sums& sum) {
        const Index n = last - first;
        const auto q1 = tangential.traction.segment(first, n);
        const auto q2 = tangential.traction.segment(first + cells, n);
        const auto s1 = tangential.slip.segment(first, n);
        const auto s2 = tangential.slip.segment(first + cells, n);
        const ArrayXd& u = tangential.elastic_displacement;
        sum += Sums{0.5 * (q1 * u.segment(first, n) + q2 * u.segment(first + cells, n)).sum(),
                    (bound.segment(first, n) * (s1.square() + s2.square()).sqrt()).sum(), -(q1 * s1 + q2 * s2).sum()};
      });
  return {elastic, dissipated, of_loads};
}

/// NaN for slip that may be rounding.
SlipDirection direction_of(const TangentialSolution& tangential, const StepNumbers& numbers) {
  const Certificate& certificate = numbers.certificate;
  const bool slips = numbers.stick_cells < numbers.contact_cells &&
                     !(numbers.dissipated <= std::min(kGapsOfNoSlip * certificate.gap, kNoSlip) * certificate.energy);
  return slips ? slip_direction(tangential.traction, tangential.slip) : SlipDirection{std::nan(""), std::nan("")};
}

}  // namespace

StepNumbers describe_step(const Scene& scene, const Model& model, const StepLoads& step, const SolvedStep& solved,
                          const RigidMotion& motion, const ArrayXd& slip) {
  const ContactNumbers contact = describe_contact(scene, model, solved.normal);
  const LoadNumbers loads = describe_loads(model, solved, motion);
  StepNumbers numbers{contact,
                      describe_stick(model, solved, contact, slip, step.detail),
                      loads,
                      describe_energy(model, solved.loads, solved.tangential),
                      {}};
  numbers.certificate = certificate_of(model, solved, loads);
  numbers.resolution = resolution(scene, step.loads, model.grid, solved.loads, solved.tangential, contact.contact_area);
  numbers.slip_direction = direction_of(solved.tangential, numbers);
  return numbers;
}

double measure_contact_radius(const Dimensionless& model, const ArrayXd& pressure) {
  const Grid& grid = model.grid;
  const ArrayXd x2 = ArrayXd::NullaryExpr(grid.n2, [&](Index j) { return grid.x2(j); });
  const Sweep rows = Sweep::whole(grid);
  using Moments = std::array<double, 6>;  // zeroth, first (x1, x2) and second (11, 12, 22), over the cell's area
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
  const Moments about_centroid = moments_about(about_origin[1] / about_origin[0], about_origin[2] / about_origin[0]);
  const auto mean = [&](std::size_t k) { return about_centroid[k] / about_centroid[0]; };
  const double covariance = mean(3) * mean(5) - mean(4) * mean(4);
  const double radius = std::sqrt(5.0 * std::sqrt(std::max(covariance, 0.0)));
  // A contact one cell wide has no second moment.
  return model.hertzian && radius > 0.0 ? radius : equal_area_radius(model.grid, (pressure > 0.0).count());
}

}  // namespace slipstick::solver
