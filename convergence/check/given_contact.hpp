#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "convergence/check/foreign_field.hpp"
#include "solver/load_step.hpp"

namespace slipstick::convergence {

/// Of the largest mu p: cells below it are told from empty ones by the tolerance of the normal contact only.
inline constexpr double kNextToNothing = 1e-3;

/// A contact whose pressure and tractions are given, dimensionless on its own grid, with the displacements
/// that the tractions cause by this project's operator.
struct GivenContact {
  solver::Model model;                  ///< of the scene, on the field's grid
  solver::Elasticity elasticity;        ///< how its displacements are computed
  std::array<double, 2> centre;         ///< of the grid in the scene's coordinates
  Eigen::ArrayXd pressure;              ///< cells
  Eigen::ArrayXd friction_bound;        ///< cells: mu p
  Eigen::ArrayXd traction;              ///< 2*cells
  Eigen::ArrayXd traction_rounding;     ///< cells: what the file's digits leave open of |q|
  Eigen::ArrayXd bound_rounding;        ///< and of mu p
  Eigen::ArrayXd displacement;          ///< 2*cells: K q and, of dissimilar materials, that by pressure
  Eigen::ArrayXd elastic_displacement;  ///< 2*cells: K q
  Eigen::ArrayXd rotation;              ///< 2*cells: (-x2, x1) about the scene's origin

  /// Moment about the scene's origin and force, over the cell area.
  double moment() const { return (traction * rotation).sum(); }
  std::array<double, 2> force() const;
  double energy() const { return 0.5 * (traction * elastic_displacement).sum(); }
};

/// Throws InputError for a grid that does not fit in memory.
GivenContact make_given_contact(const ForeignField& field, const solver::Scene& scene,
                                const solver::Model& scene_model);

/// The same bodies with another pressure and other tractions, without rounding, on another grid about the
/// same centre.
GivenContact with_fields(const GivenContact& contact, const solver::Grid& grid, Eigen::ArrayXd pressure,
                         Eigen::ArrayXd traction);

/// Whether the pressure solves the normal problem of its own grid, of pressures constant in each cell, for
/// the scene's bodies: no other discretisation's does. Not looked at under height maps and roughness, which
/// stand on grids of their own.
bool solves_normal_problem(const GivenContact& contact, const solver::Scene& scene);

/// Displacement fields of the scene's rigid motions that are not imposed: translations, unless the scene says
/// how far, and rotation, unless the twist is given. `imposed`: the sum of those that are.
struct RigidMotions {
  std::vector<Eigen::ArrayXd> free;
  Eigen::ArrayXd imposed;
};
RigidMotions rigid_motions(const GivenContact& contact, const solver::Step& load,
                           std::optional<double> twist);

/// The displacements of a rigid motion about the scene's origin: 2*cells.
Eigen::ArrayXd rigid_motion(const GivenContact& contact, const std::array<double, 2>& displacement,
                            double twist);

/// The tangential problem that a contact with this pressure poses on its grid: under the motions that the
/// scene imposes, and else under the tractions' own loads.
solver::TangentialProblem own_problem(const GivenContact& contact, const solver::Step& load);

/// The displacement by pressure, of dissimilar materials; empty where there is none.
Eigen::ArrayXd pressure_displacement(const solver::Model& model, const solver::Elasticity& elasticity,
                                     const solver::Grid& grid, const Eigen::ArrayXd& pressure);

}  // namespace slipstick::convergence
