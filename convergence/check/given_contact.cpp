#include "convergence/check/given_contact.hpp"

#include <utility>

#include "solver/scene/surface.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/scene/to_dimensionless.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Grid;
using solver::Index;

solver::Dimensionless on_grid(solver::Dimensionless bodies, const Grid& grid) {
  bodies.grid = grid;
  return bodies;
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
      elasticity{.pair = pair, .threads = threads},
      centre(middle),
      pressure(std::move(p)),
      friction_bound(friction * pressure),
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
  return {on_grid(contact, grid),
          contact.elasticity.threads,
          contact.centre,
          std::move(pressure),
          std::move(traction),
          none,
          none};
}

GivenContact make_given_contact(const ForeignField& field, const solver::Dimensionless& bodies, int threads) {
  const double length = field.grid.h1;
  const double stress = bodies.stress_unit;
  solver::Dimensionless here =
      on_grid(bodies, {field.grid.n1, field.grid.n2, 1.0, solver::to_dimensionless(field.grid.h2, length)});
  here.length_unit = length;
  return {here,
          threads,
          {field.centre[0] / length, field.centre[1] / length},
          field.pressure / stress,
          field.traction / stress,
          bodies.friction * field.pressure_rounding / stress,
          field.traction_rounding / stress};
}

bool solves_normal_problem(const GivenContact& contact, const solver::Scene& scene) {
  // Of the displacements: what a solver's tolerance leaves between surfaces that should lie together.
  constexpr double kTogether = 1e-5;
  std::vector<solver::Surface> surfaces = scene.surfaces;
  for (solver::Surface& surface : surfaces) {
    if (surface.shape == solver::Shape::height_map || surface.shape == solver::Shape::roughness) return false;
    surface = solver::to_dimensionless(std::move(surface), contact.length_unit);
    for (std::size_t k = 0; k < 2; ++k) surface.at[k] -= contact.centre[k];
  }
  const Grid& grid = contact.grid;
  const ArrayXd& p = contact.pressure;
  const ArrayXd gap = solver::gap_field(surfaces, scene.combine, grid);
  ArrayXd u3(grid.cells());
  contact.elasticity.make(grid, solver::normal_kernel())->apply(p, u3);
  const ArrayXd approach = (p > 0.0).select(gap + u3, 0.0);
  const double mean = (p * approach).sum() / p.sum();
  return (p * (approach - mean).abs()).sum() <= kTogether * (p * u3).sum();
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
  // The grid's centre moves with the body. Where it stands apart and the twist is free, that is not imposed.
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
