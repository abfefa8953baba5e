#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "convergence/check/foreign_field.hpp"
#include "solver/model/model.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::convergence {

/// Part of the largest mu p. Only the tolerance of the normal contact distinguishes cells that carry less
/// from empty ones.
inline constexpr double kNextToNothing = 1e-3;

/// A contact with given pressure and tractions on a grid of its own, and the displacements that this
/// project's operator computes from them.
struct GivenContact : solver::Dimensionless {
  /// bodies: on the contact's grid; the others are the members of these names.
  GivenContact(const solver::Dimensionless& bodies, int threads, const std::array<double, 2>& middle,
               Eigen::ArrayXd p, Eigen::ArrayXd q, Eigen::ArrayXd rounding_of_bound,
               Eigen::ArrayXd rounding_of_q);

  solver::Elasticity elasticity;        ///< how its displacements are computed
  std::array<double, 2> centre;         ///< of the grid in the scene's coordinates
  Eigen::ArrayXd pressure;              ///< cells
  Eigen::ArrayXd friction_bound;        ///< cells: mu p, or what another law makes of p
  Eigen::ArrayXd traction;              ///< 2*cells
  Eigen::ArrayXd bound_rounding;        ///< cells: error of mu p that the file's digits allow
  Eigen::ArrayXd traction_rounding;     ///< cells: likewise of |q|
  Eigen::ArrayXd rotation;              ///< 2*cells: (-x2, x1) about the scene's origin
  Eigen::ArrayXd elastic_displacement;  ///< 2*cells: K q
  Eigen::ArrayXd displacement;          ///< 2*cells: K q and, of dissimilar materials, that by pressure

  /// Moment about the scene's origin and force, over the cell area.
  double moment() const { return (traction * rotation).sum(); }
  std::array<double, 2> force() const;
  /// Friction over pressure in the mean: mu under Coulomb's law.
  double mean_friction() const {
    return friction.is_coulomb() ? friction.coefficient : friction_bound.sum() / pressure.sum();
  }
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

/// 1 in contact cells all of whose neighbours, those at corners too, are in contact: the contact's edge cuts
/// none of them. The others carry as much of a traction as a discretisation gives to a part of a cell.
Eigen::ArrayXd inner_cells(const solver::Grid& grid, const Eigen::ArrayXd& pressure);

/// A field on a larger or smaller grid about the same centre, with cells of the same size: continued by zero
/// or cut off. The numbers of cells along each axis differ by an even number.
Eigen::ArrayXd resized(const solver::Grid& from, const solver::Grid& to, const Eigen::ArrayXd& values);

/// The pressure of the scene's own normal contact, in the units of `contact`. `grid` is enlarged until it
/// covers the scene's grid. None without a normal load. Measured surfaces, pressures from files and pressures
/// that shear changes exist on the scene's grid only; none where its cells do not coincide with those of
/// `grid`.
std::optional<Eigen::ArrayXd> scene_pressure(const GivenContact& contact, const solver::Scene& scene,
                                             const solver::Model& model, solver::Grid& grid);

/// The rigid motions of a contact as displacement fields. The twist is imposed if it is given, a translation
/// if the scene says how far.
struct RigidMotions {
  std::vector<Eigen::ArrayXd> free;  ///< of unit size; the rotation last
  Eigen::ArrayXd imposed;            ///< the sum of the imposed ones
};
RigidMotions rigid_motions(const GivenContact& contact, const solver::Step& load,
                           std::optional<double> twist);

/// (-x2, x1) about the scene's origin: 2*cells. centre: of the grid, in the scene's coordinates.
Eigen::ArrayXd rotation_about_origin(const solver::Grid& grid, const std::array<double, 2>& centre);

/// The tangential problem of a contact with this pressure, on its grid: under the motions that the scene
/// imposes, otherwise under the loads that the tractions carry.
solver::TangentialProblem own_problem(const GivenContact& contact, const solver::Step& load);

/// The tangential displacement that a pressure causes; empty unless the materials are dissimilar.
Eigen::ArrayXd pressure_displacement(const GivenContact& contact, const solver::Grid& grid,
                                     const Eigen::ArrayXd& pressure);

}  // namespace slipstick::convergence
