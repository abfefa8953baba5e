#include "convergence/check/given_contact.hpp"

#include "solver/over_unit.hpp"

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
  model.grid = {field.grid.n1, field.grid.n2, 1.0, solver::over_unit(field.grid.h2, unit)};
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

GivenContact make_given_contact(const ForeignField& field, const solver::Scene& scene,
                                const solver::Model& scene_model) {
  GivenContact contact{};
  contact.model = on_grid_of(field, scene_model);
  const solver::Model& model = contact.model;
  contact.elasticity = {.pair = model.pair, .threads = scene.threads};
  contact.centre = {field.centre[0] / model.length_unit, field.centre[1] / model.length_unit};
  contact.pressure = field.pressure / model.stress_unit;
  contact.friction_bound = model.friction * contact.pressure;
  contact.traction = field.traction / model.stress_unit;
  contact.traction_rounding = field.traction_rounding / model.stress_unit;
  contact.bound_rounding = model.friction * field.pressure_rounding / model.stress_unit;
  contact.rotation = rotation_about_origin(contact);
  contact.elastic_displacement.resize(contact.traction.size());
  contact.elasticity.make(model.grid, solver::tangential_kernel())
      ->apply(contact.traction, contact.elastic_displacement);
  contact.displacement = contact.elastic_displacement;
  const ArrayXd by_pressure = pressure_displacement(model, contact.elasticity, model.grid, contact.pressure);
  if (by_pressure.size() > 0) contact.displacement += by_pressure;
  return contact;
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

solver::TangentialProblem own_problem(const GivenContact& contact) {
  const ArrayXd about_grid = solver::rotation_field(contact.model.grid);
  solver::TangentialProblem problem{
      .friction_bound = contact.friction_bound,
      .initial_displacement = contact.displacement - contact.elastic_displacement,
      .moment = (contact.traction * about_grid).sum(),
      .twist = {},
      .force = contact.force()};
  if (!contact.model.pressure_coupling) problem.initial_displacement = {};
  return problem;
}

}  // namespace slipstick::convergence
