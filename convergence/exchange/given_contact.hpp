#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "solver/elasticity/elasticity.hpp"
#include "solver/model/model.hpp"

namespace slipstick::convergence {

/// A contact whose pressure and tractions another program computed, on their own grid: `check` and scenes
/// with solver.program judge fields through it.
///
///  1. The pressure gives the friction bound, by the scene's law of friction.
///  2. This project's operator gives the displacements under tractions and pressure.
///  3. find_state() gives the rigid motion under which the field is closest to the law of friction, its slip
///     and its gap; where the scene imposes a motion, that one.
struct GivenContact : solver::Dimensionless {
  /// bodies: on the contact's grid. middle: of that grid, in the scene's coordinates. p: cells; q: 2*cells.
  GivenContact(const solver::Dimensionless& bodies, solver::Elasticity elastic, const std::array<double, 2>& middle,
               Eigen::ArrayXd p, Eigen::ArrayXd q);

  solver::Elasticity elasticity;  ///< makes the operators of its displacements
  std::array<double, 2> centre;   ///< of the grid in the scene's coordinates
  Eigen::ArrayXd pressure;        ///< cells
  Eigen::ArrayXd friction_bound;  ///< cells: mu p under Coulomb's law
  Eigen::ArrayXd traction;        ///< 2*cells
  /// cells: errors of the bound and of |q| that the digits of a file allow; zero unless they are set.
  Eigen::ArrayXd bound_rounding, traction_rounding;
  Eigen::ArrayXd rotation;              ///< 2*cells: (-x2, x1) about the scene's origin
  Eigen::ArrayXd elastic_displacement;  ///< 2*cells: K q
  Eigen::ArrayXd displacement;          ///< 2*cells: K q and, of dissimilar materials, K13 p and K23 p

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

/// The rigid motion of a contact, as far as the scene or a program gives it.
struct KnownMotion {
  std::optional<double> twist = {};                        ///< rad; none: it is fitted
  std::optional<std::array<double, 2>> displacement = {};  ///< of the scene's origin; none: it is fitted
  bool translates = true;  ///< false: the contact cannot move sideways, and no translation is fitted
};

/// Tractions under a rigid motion: the known one, or the one that the law of friction fits best.
struct State {
  double twist;                        ///< rad
  std::array<double, 2> displacement;  ///< of the scene's origin
  Eigen::ArrayXd slip;                 ///< 2*cells
  Eigen::ArrayXd gap;                  ///< cells
};
State find_state(const GivenContact& contact, KnownMotion motion);

/// The rigid motions of a contact as displacement fields of 2*cells.
struct RigidMotions {
  std::vector<Eigen::ArrayXd> free;  ///< of unit size; the rotation last
  Eigen::ArrayXd imposed;            ///< the sum of the imposed ones
};
RigidMotions rigid_motions(const GivenContact& contact, const KnownMotion& motion);

/// (-x2, x1) about the scene's origin: 2*cells. centre: of the grid, in the scene's coordinates.
Eigen::ArrayXd rotation_about_origin(const solver::Grid& grid, const std::array<double, 2>& centre);

/// The tangential displacement that a pressure causes; empty unless the materials are dissimilar.
Eigen::ArrayXd pressure_displacement(const GivenContact& contact, const solver::Grid& grid,
                                     const Eigen::ArrayXd& pressure);

}  // namespace slipstick::convergence
