#include "convergence/check/given_contact.hpp"

#include <algorithm>
#include <limits>
#include <utility>

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

/// The same bodies on another grid in the same unit of length.
solver::Dimensionless with_grid(solver::Dimensionless bodies, const Grid& grid) {
  bodies.friction = resampled(bodies.friction, bodies.grid, grid);
  bodies.grid = grid;
  return bodies;
}

/// How far the bound may be off by the rounding of pressures.
ArrayXd bound_rounding(const solver::FrictionLaw& law, const ArrayXd& pressure, const ArrayXd& rounding) {
  if (law.is_coulomb()) return law.coefficient * rounding;
  return (pressure > 0.0).select(law.bound(ArrayXd(pressure + rounding)) - law.bound(pressure), 0.0);
}

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

}  // namespace

ArrayXd rotation_about_origin(const Grid& grid, const std::array<double, 2>& centre) {
  ArrayXd rotation = solver::rotation_field(grid);
  rotation.head(grid.cells()) -= centre[1];
  rotation.tail(grid.cells()) += centre[0];
  return rotation;
}

GivenContact::GivenContact(const solver::Dimensionless& bodies, int threads,
                           const std::array<double, 2>& middle, ArrayXd p, ArrayXd q,
                           ArrayXd rounding_of_bound, ArrayXd rounding_of_q)
    : Dimensionless(bodies),
      elasticity{.law = law, .threads = threads},
      centre(middle),
      pressure(std::move(p)),
      friction_bound(friction.bound(pressure)),
      traction(std::move(q)),
      bound_rounding(std::move(rounding_of_bound)),
      traction_rounding(std::move(rounding_of_q)),
      rotation(rotation_about_origin(grid, centre)),
      elastic_displacement(traction.size()) {
  elasticity.make(grid, solver::tangential_kernel())->apply(traction, elastic_displacement);
  displacement = elastic_displacement;
  if (pressure_coupling) displacement += pressure_displacement(*this, grid, pressure);
}

std::array<double, 2> GivenContact::force() const {
  const Index cells = pressure.size();
  return {traction.head(cells).sum(), traction.tail(cells).sum()};
}

ArrayXd pressure_displacement(const GivenContact& contact, const Grid& grid, const ArrayXd& pressure) {
  if (!contact.pressure_coupling) return {};
  ArrayXd u(2 * pressure.size());
  contact.elasticity.make(grid, solver::coupling_kernel())->apply(pressure, u);
  return u;
}

GivenContact with_fields(const GivenContact& contact, const Grid& grid, ArrayXd pressure, ArrayXd traction) {
  const ArrayXd none = ArrayXd::Zero(grid.cells());
  return {with_grid(contact, grid),
          contact.elasticity.threads,
          contact.centre,
          std::move(pressure),
          std::move(traction),
          none,
          none};
}

GivenContact make_given_contact(const ForeignField& field, const solver::Dimensionless& bodies, int threads) {
  const solver::Dimensionless here = bodies.on_grid(field.grid, field.centre);
  const double length = here.length_unit;
  const double stress = here.stress_unit;
  return {here,
          threads,
          {field.centre[0] / length, field.centre[1] / length},
          field.pressure / stress,
          field.traction / stress,
          bound_rounding(here.friction, field.pressure / stress, field.pressure_rounding / stress),
          field.traction_rounding / stress};
}

ArrayXd inner_cells(const Grid& grid, const ArrayXd& pressure) {
  const auto contact = (pressure > 0.0).cast<double>().eval();
  ArrayXd inner = contact;
  for (const Index row : {-1, 0, 1}) {
    for (const Index column : {-1, 0, 1}) inner *= shifted(grid, contact, grid, row, column);
  }
  return inner;
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
  const bool coupled = scene.coupling == solver::Coupling::full;
  if (coupled || scene.pressure == solver::PressureModel::file ||
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
  const double total = *scene.steps.front().normal / contact.force_unit() / grid.cell_area();
  return solver::solve_normal_contact(contact.elasticity, grid, {.gap = gap, .total_pressure = total})
      .pressure;
}

RigidMotions rigid_motions(const GivenContact& contact, const solver::Step& load,
                           std::optional<double> twist) {
  const Index cells = contact.pressure.size();
  RigidMotions motions{{}, ArrayXd::Zero(2 * cells)};
  for (std::size_t k = 0; k < 2; ++k) {
    ArrayXd translation = ArrayXd::Zero(2 * cells);
    translation.segment(static_cast<Index>(k) * cells, cells).setOnes();
    if (load.displacement) {
      motions.imposed += (*load.displacement)[k] / contact.length_unit * translation;
    } else {
      motions.free.push_back(translation);
    }
  }
  if (twist) {
    motions.imposed += *twist * contact.rotation;
  } else {
    motions.free.push_back(contact.rotation);
  }
  return motions;
}

solver::TangentialProblem own_problem(const GivenContact& contact, const solver::Step& load) {
  solver::TangentialProblem problem{
      .friction_bound = contact.friction_bound,
      .initial_displacement = contact.displacement - contact.elastic_displacement,
      .moment = {},
      .twist = solver::value_if<solver::Twist>(load.torsion)};
  if (!contact.pressure_coupling) problem.initial_displacement = {};
  if (!problem.twist) {
    problem.moment = (contact.traction * solver::rotation_field(contact.grid)).sum();
  }
  // The problem's displacement is that of the grid's centre. If the twist is free, a centre off the origin
  // moves by an unknown amount, and the force stands for the displacement.
  const auto& [c1, c2] = contact.centre;
  const double twist = problem.twist.value_or(0.0);
  if (load.displacement && (problem.twist || (c1 == 0.0 && c2 == 0.0))) {
    const double unit = contact.length_unit;
    problem.displacement = {(*load.displacement)[0] / unit - twist * c2,
                            (*load.displacement)[1] / unit + twist * c1};
  } else {
    problem.force = contact.force();
  }
  return problem;
}

}  // namespace slipstick::convergence
