#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "convergence/check/foreign_field.hpp"
#include "solver/model.hpp"
#include "solver/tractions.hpp"

namespace slipstick::convergence {

/// Of the largest mu p: only the tolerance of the normal contact distinguishes cells below it from empty
/// ones.
inline constexpr double kNextToNothing = 1e-3;

/// A part of mu p by which a cell may miss its circle, or exceed it, where a solver stops at a tolerance.
inline constexpr double kOnCircle = 1e-4;

/// A contact whose pressure and tractions are given, on a grid of its own, with the displacements that the
/// tractions cause by this project's operator.
struct GivenContact : solver::Dimensionless {
  /// bodies: on the contact's grid; the others are the members of these names.
  GivenContact(const solver::Dimensionless& bodies, int threads, const std::array<double, 2>& middle,
               Eigen::ArrayXd p, Eigen::ArrayXd q, Eigen::ArrayXd rounding_of_bound,
               Eigen::ArrayXd rounding_of_q);

  solver::Elasticity elasticity;        ///< how its displacements are computed
  std::array<double, 2> centre;         ///< of the grid in the scene's coordinates
  Eigen::ArrayXd pressure;              ///< cells
  Eigen::ArrayXd friction_bound;        ///< cells: mu p
  Eigen::ArrayXd traction;              ///< 2*cells
  Eigen::ArrayXd bound_rounding;        ///< cells: what the file's digits leave open of mu p
  Eigen::ArrayXd traction_rounding;     ///< and of |q|
  Eigen::ArrayXd rotation;              ///< 2*cells: (-x2, x1) about the scene's origin
  Eigen::ArrayXd elastic_displacement;  ///< 2*cells: K q
  Eigen::ArrayXd displacement;          ///< 2*cells: K q and, of dissimilar materials, that by pressure

  /// Moment about the scene's origin and force, over the cell area.
  double moment() const { return (traction * rotation).sum(); }
  std::array<double, 2> force() const;
  double energy() const { return 0.5 * (traction * elastic_displacement).sum(); }

  /// N and N m of a load over the cell area.
  double newtons() const { return grid.cell_area() * force_unit(); }
  double newton_metres() const { return grid.cell_area() * moment_unit(); }
};

/// The scene's bodies with a field's pressure and tractions, on the field's grid. bodies: on any grid.
GivenContact make_given_contact(const ForeignField& field, const solver::Dimensionless& bodies, int threads);

/// The same bodies with another pressure and other tractions, without rounding, on another grid about the
/// same centre.
GivenContact with_fields(const GivenContact& contact, const solver::Grid& grid, Eigen::ArrayXd pressure,
                         Eigen::ArrayXd traction);

/// Values of any grid about the same centre, with cells of the same size and an even number of them more or
/// less along each axis: cut off or continued by zero.
Eigen::ArrayXd resized(const solver::Grid& from, const solver::Grid& to, const Eigen::ArrayXd& values);

/// The pressure of a scene's own normal contact in a contact's units, on `grid` about its centre and as far
/// beyond as the scene's grid reaches: `grid` becomes that larger one. Measured surfaces, pressures from
/// files and those that shear changes stand on the scene's grid alone: none, where its cells are not those
/// of `grid`. None, too, without a normal load to solve for.
std::optional<Eigen::ArrayXd> scene_pressure(const GivenContact& contact, const solver::Scene& scene,
                                             const solver::Model& model, solver::Grid& grid);

/// Displacement fields of the scene's rigid motions that are not imposed: translations, unless the scene says
/// how far, and rotation, unless the twist is given. `imposed`: the sum of those that are.
struct RigidMotions {
  std::vector<Eigen::ArrayXd> free;
  Eigen::ArrayXd imposed;
};
RigidMotions rigid_motions(const GivenContact& contact, const solver::Step& load,
                           std::optional<double> twist);

/// (-x2, x1) about the scene's origin: 2*cells. centre: of the grid, in the scene's coordinates.
Eigen::ArrayXd rotation_about_origin(const solver::Grid& grid, const std::array<double, 2>& centre);

/// The tangential problem that a contact with this pressure poses on its grid: under the motions that the
/// scene imposes, and else under the tractions' own loads.
solver::TangentialProblem own_problem(const GivenContact& contact, const solver::Step& load);

/// The displacement that a pressure on a grid causes, of dissimilar materials; empty where there is none.
Eigen::ArrayXd pressure_displacement(const GivenContact& contact, const solver::Grid& grid,
                                     const Eigen::ArrayXd& pressure);

}  // namespace slipstick::convergence
