#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "solver/elasticity.hpp"
#include "solver/grid.hpp"
#include "solver/normal_contact.hpp"

namespace slipstick::solver {

/// Torsion of a contact whose pressure is known. One consistent set of units; displacements are K q.
struct TorsionProblem {
  Eigen::ArrayXd friction_bound;        ///< mu p of each cell; zero outside the contact
  Eigen::ArrayXd initial_displacement;  ///< (u1, u2) by the pressure, Eq. (12); empty: none
  std::optional<double> moment;         ///< M_3 over the cell area; or else
  std::optional<double> twist;          ///< phi_3 itself is imposed
};

struct TorsionSolution {
  Status status = Status::not_converged;
  std::string message;      ///< why it did not converge; empty if it did
  Eigen::ArrayXd traction;  ///< q, 2*cells
  Eigen::ArrayXd
      elastic_displacement;  ///< K q, 2*cells; of a reduced model zero outside its part of the grid
  Eigen::ArrayXd slip;       ///< s of Eq. (8), 2*cells, zero outside the contact
  Eigen::ArrayXd stick;      ///< 1 in A_S, 0 elsewhere
  double twist = 0.0;        ///< phi_3
  double change = 0.0;       ///< what the method's stopping test saw last
  int iterations = 0;
  /// dM/dphi over the cell area (Coulomb's method; 0: not computed). That of a bonded circular punch is
  /// (16/3) G a_s^3.
  double tangent_stiffness = 0.0;
  std::vector<GridWork> grids = {};  ///< work done, coarsest grid first
  double bytes = 0.0;                ///< operators and workspaces on the finest grid
};

/// The largest moment (over the cell area) that the friction bounds can carry about the origin: sum of mu p
/// r.
double moment_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound);

/// Throws std::invalid_argument if neither or both of moment and twist are given, if a bound is negative or
/// NaN, or if the moment is not below moment_limit().
void require_valid(const TorsionProblem& problem, const Grid& grid);

}  // namespace slipstick::solver
