#include "convergence/check/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "solver/contact/coulomb_method.hpp"
#include "solver/contact/normal_contact.hpp"
#include "solver/scene/surface.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/scene/to_dimensionless.hpp"
#include "solver/solve.hpp"
#include "solver/step/pressure.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Grid;
using solver::Index;

/// Part of mu p by which rounding may change |q| of a slipping cell.
constexpr double kExactlyOnCircle = 1e-9;
/// Cells of the largest grid on which a scene's pressure is solved for comparison: about a minute's work.
constexpr double kMaxSolvedCells = 2e7;

/// Part of a cell by which the centres of two grids may differ.
constexpr double kSameCells = 1e-3;

/// The values of a grid at the same places of another one, whose first cell is cell (row, column) of the
/// first; zero beyond it.
ArrayXd shifted(const Grid& from, const ArrayXd& values, const Grid& to, Index row, Index column) {
  ArrayXd result = ArrayXd::Zero(to.cells());
  for (Index i = std::max(Index{0}, -row); i < std::min(to.n1, from.n1 - row); ++i) {
    for (Index j = std::max(Index{0}, -column); j < std::min(to.n2, from.n2 - column); ++j) {
      result[i * to.n2 + j] = values[(i + row) * from.n2 + j + column];
    }
  }
  return result;
}

/// The values of a grid about the scene's origin on another one about `centre`; none where their cells do not
/// coincide. Lengths are in the unit of `to`.
std::optional<ArrayXd> moved(const Grid& from, const ArrayXd& values, const Grid& to,
                             const std::array<double, 2>& centre) {
  const double off1 = (centre[0] / to.h1) + 0.5 * static_cast<double>(from.n1 - to.n1);
  const double off2 = (centre[1] / to.h2) + 0.5 * static_cast<double>(from.n2 - to.n2);
  const double stretched = std::max(std::abs(from.h1 / to.h1 - 1.0), std::abs(from.h2 / to.h2 - 1.0));
  if (!(std::max(std::abs(off1 - std::round(off1)), std::abs(off2 - std::round(off2))) <= kSameCells &&
        stretched * static_cast<double>(std::max(from.n1, from.n2)) <= kSameCells)) {
    return std::nullopt;
  }
  return shifted(from, values, to, std::lround(off1), std::lround(off2));
}

/// The error of the rigid motion in the mean over the contact, weighted with mu p and relative to the motion
/// or to the displacements, whichever are larger; positive where the motion is too large.
double motion_error(const GivenContact& c, const RightAnswer& right, const State& state) {
  const auto size = [&](const ArrayXd& motion) { return (c.friction_bound * solver::norms(motion)).sum(); };
  const auto about_origin = [&](const std::array<double, 2>& displacement, double twist) {
    ArrayXd motion = twist * c.rotation;
    motion.head(c.pressure.size()) += displacement[0];
    motion.tail(c.pressure.size()) += displacement[1];
    return motion;
  };
  const ArrayXd found = about_origin(state.displacement, state.twist);
  const ArrayXd expected = about_origin(right.displacement, right.twist);
  return std::copysign(size(found - expected), size(found) - size(expected)) /
         std::max(size(expected), size(c.displacement));
}

ArrayXd inner_cells(const Grid& grid, const ArrayXd& pressure) {
  const auto contact = (pressure > 0.0).cast<double>().eval();
  ArrayXd inner = contact;
  for (const Index row : {-1, 0, 1}) {
    for (const Index column : {-1, 0, 1}) inner *= shifted(grid, contact, grid, row, column);
  }
  return inner;
}

bool is_above_limit(double factor) { return !(factor > 1.0 - kBelowLimit); }

}  // namespace

GivenContact with_fields(const GivenContact& contact, const Grid& grid, ArrayXd pressure, ArrayXd traction) {
  solver::Dimensionless bodies = contact;
  bodies.friction = resampled(bodies.friction, bodies.grid, grid);
  bodies.grid = grid;
  return {bodies, contact.elasticity, contact.centre, std::move(pressure), std::move(traction)};
}

ArrayXd resized(const Grid& from, const Grid& to, const ArrayXd& values) {
  return shifted(from, values, to, (from.n1 - to.n1) / 2, (from.n2 - to.n2) / 2);
}

std::optional<ArrayXd> scene_pressure(const GivenContact& contact, const solver::Scene& scene,
                                      const solver::Model& model, Grid& grid) {
  const double unit = contact.length_unit;
  const Grid in_m = model.grid_in_m();
  const Grid own{in_m.n1, in_m.n2, in_m.h1 / unit, in_m.h2 / unit};
  const double half1 = 0.5 * static_cast<double>(own.n1) * own.h1;
  const double half2 = 0.5 * static_cast<double>(own.n2) * own.h2;
  const auto larger = [](Index n, double h, double half) {
    const double missing = half - 0.5 * static_cast<double>(n) * h;
    return n + 2 * static_cast<Index>(std::clamp(std::ceil(missing / h), 0.0, kMaxSolvedCells));
  };
  grid.n1 = larger(grid.n1, grid.h1, half1 + std::abs(contact.centre[0]));
  grid.n2 = larger(grid.n2, grid.h2, half2 + std::abs(contact.centre[1]));
  if (!(static_cast<double>(grid.n1) * static_cast<double>(grid.n2) <= kMaxSolvedCells)) return std::nullopt;
  const bool coupled = scene.contact.coupling == solver::Coupling::full;
  if (coupled || scene.contact.pressure == solver::PressureModel::file ||
      std::ranges::any_of(scene.surfaces, solver::is_measured)) {
    if (!moved(own, ArrayXd::Zero(own.cells()), grid, contact.centre)) return std::nullopt;
    return moved(own,
                 coupled ? ArrayXd(solver::solve(scene).pressure / contact.stress_unit)
                         : solver::find_pressure(scene, model, scene.steps.front()).pressure,
                 grid, contact.centre);
  }
  if (!scene.steps.front().normal) return std::nullopt;
  std::vector<solver::Surface> surfaces = scene.surfaces;
  for (solver::Surface& surface : surfaces) {
    surface = solver::to_dimensionless(std::move(surface), unit);
    for (std::size_t k = 0; k < 2; ++k) surface.at[k] -= contact.centre[k];
  }
  ArrayXd gap = solver::gap_field(surfaces, scene.combine, grid);
  if (scene.ends_at_grid_edge) {
    gap = ((solver::cell_x1(grid) + contact.centre[0]).abs() > half1 ||
           (solver::cell_x2(grid) + contact.centre[1]).abs() > half2)
              .select(std::numeric_limits<double>::infinity(), gap);
  }
  const solver::Reduction part(grid, gap, gap.isFinite().cast<double>());
  gap = part.restricted(std::move(gap));
  const double area = grid.cell_area() * (part.quadrant() ? 4.0 : 1.0);
  const double total = *scene.steps.front().normal / contact.force_unit() / area;
  const auto solved =
      solver::solve_normal_contact(contact.elasticity, part.grid(), {.gap = gap, .total_pressure = total});
  return part.expanded(solved.pressure, solver::normal_symmetry());
}

KnownMotion known_motion(const GivenContact& contact, const solver::Step& load, std::optional<double> twist) {
  KnownMotion motion{.twist = twist};
  const double unit = contact.length_unit;
  if (load.displacement) motion.displacement = {(*load.displacement)[0] / unit, (*load.displacement)[1] / unit};
  return motion;
}

solver::TangentialProblem own_problem(const GivenContact& contact, const solver::Step& load) {
  solver::TangentialProblem problem{
      .friction_bound = contact.friction_bound,
      .initial_displacement =
          contact.pressure_coupling ? ArrayXd(contact.displacement - contact.elastic_displacement) : ArrayXd(),
      .moment = {},
      .twist = solver::value_if<solver::Twist>(load.torsion)};
  if (!problem.twist) {
    problem.moment = (contact.traction * solver::rotation_field(contact.grid)).sum();
  }
  // The problem's displacement belongs to the grid's centre. If the twist is free, a centre off the origin
  // moves by an unknown amount: then the force is imposed instead.
  const auto& [c1, c2] = contact.centre;
  const double twist = problem.twist.value_or(0.0);
  if (load.displacement && (problem.twist || (c1 == 0.0 && c2 == 0.0))) {
    const double unit = contact.length_unit;
    problem.displacement = {(*load.displacement)[0] / unit - twist * c2, (*load.displacement)[1] / unit + twist * c1};
  } else {
    problem.force = contact.force();
  }
  leave_out_translations(problem, contact.grid, contact.traction);
  return problem;
}

void leave_out_translations(solver::TangentialProblem& problem, const Grid& grid, const ArrayXd& traction) {
  constexpr double kNoForce = 1e-6;  // of the tractions' sizes
  if (!problem.force) return;
  const auto [force1, force2] = *problem.force;
  if (std::hypot(force1, force2) <= kNoForce * solver::norms(traction).sum() &&
      solver::is_half_turn_symmetric(grid, problem.friction_bound) &&
      solver::turns_into_itself(problem.initial_displacement))
    problem.force.reset();
}

double solved_multiple(double factor) {
  if (is_above_limit(factor)) return kScaledLoads * factor;
  return factor > 1.0 + kBelowLimit ? 1.0 : (1.0 - kBelowLimit) * factor;
}

void scale_loads(solver::TangentialProblem& problem, double factor) {
  if (problem.limit_factor) *problem.limit_factor /= factor;
  if (problem.moment) *problem.moment *= factor;
  if (!problem.force) return;
  for (double& force : *problem.force) force *= factor;
}

solver::TangentialSolution solve_problem(const GivenContact& contact, const Grid& grid,
                                         solver::TangentialProblem problem, double tolerance) {
  const ArrayXd& bound = problem.friction_bound;
  const bool mirrored = !problem.force && !problem.displacement && problem.initial_displacement.size() == 0;
  const solver::Reduction part = mirrored ? solver::Reduction(grid, bound, bound) : solver::Reduction(grid, bound);
  solver::Elasticity elasticity = contact.elasticity;
  elasticity.diagonal = part.diagonal();
  solver::TangentialProblem own = reduced(problem, part);
  problem = {};  // its fields are large on a fine grid
  solver::TangentialSolution solution =
      solve_by_coulomb_method(elasticity, part.grid(), std::move(own), {.tolerance = tolerance});
  const bool usable = solution.status == solver::Status::converged || solution.change <= kIterationGap;
  if (!usable) throw std::runtime_error("the right answer to judge by was not found: " + solution.message);
  solution.traction = part.expanded(std::move(solution.traction), solver::torsion_symmetry());
  return solution;
}

RightAnswer find_right_answer(const GivenContact& contact, const solver::Step& load) {
  const Grid& grid = contact.grid;
  solver::TangentialProblem problem = own_problem(contact, load);
  const double factor = solver::limit_of(problem, grid).factor;
  problem.limit_factor = factor;
  scale_loads(problem, solved_multiple(factor));
  const solver::TangentialSolution solution = solve_problem(contact, grid, std::move(problem));
  return {.traction = solution.traction,
          .twist = solution.twist,
          .displacement = {solution.displacement[0] + solution.twist * contact.centre[1],
                           solution.displacement[1] - solution.twist * contact.centre[0]},
          .scaled = is_above_limit(factor)};
}

std::vector<Index> slip_ring(const GivenContact& contact, const RightAnswer& right) {
  const ArrayXd size = solver::norms(right.traction);
  const double least = kNextToNothing * contact.friction_bound.maxCoeff();
  std::vector<Index> cells;
  for (Index cell = 0; cell < size.size(); ++cell) {
    const double bound = contact.friction_bound[cell];
    if (bound > least && size[cell] >= (1.0 - kExactlyOnCircle) * bound) cells.push_back(cell);
  }
  return cells;
}

std::vector<double> ring_excess(const GivenContact& contact, const RightAnswer& right, const Regions& regions) {
  std::vector<Index> ring = slip_ring(contact, right);
  std::erase_if(ring, [&](Index cell) { return regions.ring[cell] == 0.0; });
  if (ring.size() < kMinSlipping) return {};
  const ArrayXd size = solver::norms(contact.traction);
  std::vector<double> excess;
  for (const Index cell : ring) excess.push_back(size[cell] / contact.friction_bound[cell] - 1.0);
  std::ranges::sort(excess);
  return excess;
}

Regions find_regions(const GivenContact& contact, const RightAnswer& right) {
  Regions regions{inner_cells(contact.grid, contact.pressure), ArrayXd::Ones(contact.grid.cells())};
  const std::vector<Index> ring = slip_ring(contact, right);
  const auto inside = std::ranges::count_if(ring, [&](Index cell) { return regions.inner[cell] > 0.0; });
  if (inside >= static_cast<std::ptrdiff_t>(kMinSlipping)) regions.ring = regions.inner;
  return regions;
}

Deviation find_deviation(const GivenContact& contact, const RightAnswer& right, const State& reported,
                         const State& fitted, const Regions& regions) {
  const double moment = (right.traction * contact.rotation).sum();
  const std::vector<double> excess = ring_excess(contact, right, regions);
  const ArrayXd off = solver::norms(contact.traction - right.traction);
  const double size = solver::norms(right.traction).sum();
  return {.tractions = off.sum() / size,
          .inside = (off * regions.inner).sum() / size,
          .motion = motion_error(contact, right, reported),
          .moment = moment == 0.0 ? 0.0 : contact.moment() / moment - 1.0,
          .friction = excess.empty() ? 0.0 : excess[excess.size() / 2],
          .gap = fitted.gap.sum() / contact.energy()};
}

solver::SlipDirection noticeable_direction(const GivenContact& c, const State& state, double part) {
  const double least = part * solver::norms(c.displacement).maxCoeff();
  const ArrayXd size = solver::norms(state.slip);
  const double something = kNextToNothing * c.friction_bound.maxCoeff();
  const ArrayXd noticeable = ((size > least) && (c.friction_bound > something)).cast<double>();
  return solver::slip_direction(c.traction, noticeable.replicate(2, 1) * state.slip);
}

Deviation larger(const Deviation& a, const Deviation& b) {
  const auto of = [&](double Deviation::*part) { return std::max(std::abs(a.*part), std::abs(b.*part)); };
  return {of(&Deviation::tractions), of(&Deviation::inside), of(&Deviation::motion),  of(&Deviation::moment),
          of(&Deviation::friction),  of(&Deviation::gap),    of(&Deviation::pressure)};
}

}  // namespace slipstick::convergence
