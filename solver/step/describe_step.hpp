#pragma once

#include <functional>

#include "solver/contact/normal_contact.hpp"
#include "solver/model/model.hpp"
#include "solver/solution.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::solver {

/// The answer as it was found: fields in the model's units, those of Solution not yet filled in.
struct ModelSolution : Solution {
  Model model;
  NormalSolution normal;
  TangentialSolution tangential;
};

/// solve() without the change of units.
ModelSolution solve_in_model_units(const Scene& scene,
                                   const std::function<void(const ModelSolution&)>& on_step = {});

/// The answer with its fields, in SI units.
Solution in_si(ModelSolution solution);

/// Fills in the members that follow from pressure, tractions and loads: the contact, the stick area, loads
/// and limits, certificate, energies, resolution. slip: see ContactState.
void describe(ModelSolution& solution, const Scene& scene, const LoadStep& loads, const Eigen::ArrayXd& slip);

/// Contact radius of a pressure, in the grid's units: of a Hertzian contact from the second moments of the
/// pressure about its centre (those along the axes are a_i^2/5), which know the radius to far less than a
/// cell; else from the area of the contact cells.
double measure_contact_radius(const Dimensionless& model, const Eigen::ArrayXd& pressure);

}  // namespace slipstick::solver
