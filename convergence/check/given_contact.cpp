#include "convergence/check/given_contact.hpp"

#include <utility>

#include "solver/scene/surface.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/scene/to_dimensionless.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

/// The scene's model on another grid. What follows from the grid alone, the gap and its reduction, is left as
/// it is: nothing is solved for the pressure here.
solver::Model on_grid_of(const ForeignField& field, solver::Model model) {
  const double unit = field.grid.h1;
  const double rescaled = model.length_unit / unit;
  model.length_unit = unit;
  model.grid = {field.grid.n1, field.grid.n2, 1.0, solver::to_dimensionless(field.grid.h2, unit)};
  if (model.normal_load) *model.normal_load *= rescaled * rescaled;
  return model;
}

ArrayXd rotation_about_origin(const GivenContact& contact) {
  const Index cells = contact.model.grid.cells();
  ArrayXd rotation = solver::rotation_field(contact.model.grid);
  rotation.head(cells) -= contact.centre[1];
  rotation.tail(cells) += contact.centre[0];
  return rotation;
}

}  // namespace

std::array<double, 2> GivenContact::force() const {
  const Index cells = pressure.size();
  return {traction.head(cells).sum(), traction.tail(cells).sum()};
}

ArrayXd pressure_displacement(const solver::Model& model, const solver::Elasticity& elasticity,
                              const solver::Grid& grid, const ArrayXd& pressure) {
  if (!model.pressure_coupling) return {};
  ArrayXd u(2 * pressure.size());
  elasticity.make(grid, solver::coupling_kernel())->apply(pressure, u);
  return u;
}

GivenContact with_fields(const GivenContact& contact, const solver::Grid& grid, ArrayXd pressure,
                         ArrayXd traction) {
  GivenContact other{};
  other.model = contact.model;
  other.model.grid = grid;
  other.elasticity = contact.elasticity;
  other.centre = contact.centre;
  other.pressure = std::move(pressure);
  other.friction_bound = other.model.friction * other.pressure;
  other.traction = std::move(traction);
  other.traction_rounding = other.bound_rounding = ArrayXd::Zero(grid.cells());
  other.rotation = rotation_about_origin(other);
  other.elastic_displacement.resize(other.traction.size());
  other.elasticity.make(grid, solver::tangential_kernel())->apply(other.traction, other.elastic_displacement);
  other.displacement = other.elastic_displacement;
  const ArrayXd by_pressure = pressure_displacement(other.model, other.elasticity, grid, other.pressure);
  if (by_pressure.size() > 0) other.displacement += by_pressure;
  return other;
}

GivenContact make_given_contact(const ForeignField& field, const solver::Scene& scene,
                                const solver::Model& scene_model) {
  GivenContact bodies{};
  bodies.model = on_grid_of(field, scene_model);
  const solver::Model& model = bodies.model;
  bodies.elasticity = {.pair = model.pair, .threads = scene.threads};
  bodies.centre = {field.centre[0] / model.length_unit, field.centre[1] / model.length_unit};
  GivenContact contact =
      with_fields(bodies, model.grid, field.pressure / model.stress_unit, field.traction / model.stress_unit);
  contact.traction_rounding = field.traction_rounding / model.stress_unit;
  contact.bound_rounding = model.friction * field.pressure_rounding / model.stress_unit;
  return contact;
}

bool solves_normal_problem(const GivenContact& contact, const solver::Scene& scene) {
  // Of the displacements: what a solver's tolerance leaves between surfaces that should lie together.
  constexpr double kTogether = 1e-5;
  std::vector<solver::Surface> surfaces = scene.surfaces;
  for (solver::Surface& surface : surfaces) {
    if (surface.shape == solver::Shape::height_map || surface.shape == solver::Shape::roughness) return false;
    surface = solver::to_dimensionless(std::move(surface), contact.model.length_unit);
    for (std::size_t k = 0; k < 2; ++k) surface.at[k] -= contact.centre[k];
  }
  const solver::Grid& grid = contact.model.grid;
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
      motions.imposed += (*load.displacement)[k] / contact.model.length_unit * translation;
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

ArrayXd rigid_motion(const GivenContact& contact, const std::array<double, 2>& displacement, double twist) {
  ArrayXd motion = twist * contact.rotation;
  motion.head(contact.pressure.size()) += displacement[0];
  motion.tail(contact.pressure.size()) += displacement[1];
  return motion;
}

solver::TangentialProblem own_problem(const GivenContact& contact, const solver::Step& load) {
  solver::TangentialProblem problem{
      .friction_bound = contact.friction_bound,
      .initial_displacement = contact.displacement - contact.elastic_displacement,
      .moment = {},
      .twist = solver::value_if<solver::Twist>(load.torsion)};
  if (!contact.model.pressure_coupling) problem.initial_displacement = {};
  if (!problem.twist) {
    problem.moment = (contact.traction * solver::rotation_field(contact.model.grid)).sum();
  }
  // The grid's centre moves with the body. Where it stands apart and the twist is free, that is not imposed.
  const auto& [c1, c2] = contact.centre;
  const double twist = problem.twist.value_or(0.0);
  if (load.displacement && (problem.twist || (c1 == 0.0 && c2 == 0.0))) {
    const double unit = contact.model.length_unit;
    problem.displacement = {(*load.displacement)[0] / unit - twist * c2,
                            (*load.displacement)[1] / unit + twist * c1};
  } else {
    problem.force = contact.force();
  }
  return problem;
}

}  // namespace slipstick::convergence
