#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "solver/contact/certificate.hpp"
#include "solver/contact/limit_load.hpp"
#include "solver/grid/grid.hpp"
#include "solver/grid/reduction.hpp"
#include "solver/newton/safeguards.hpp"

namespace slipstick::solver {

/// A contact whose pressure is known, under a change of its tangential loads. One consistent set of units;
/// displacements are K q. Motions and slip are measured from the state `start`.
struct TangentialProblem {
  Eigen::ArrayXd friction_bound = {};        ///< mu p of each cell; zero outside the contact
  Eigen::ArrayXd initial_displacement = {};  ///< (u1, u2) by the change of pressure, Eq. (12); empty: none
  std::optional<double> moment = {};         ///< M_3 over the cell area; or else
  std::optional<double> twist = {};          ///< phi_3 itself is imposed
  /// (F1, F2) over the cell area, balanced by translations; or else these are imposed. If both are empty
  /// there are no translations: the contact is its own image under half a turn and carries no force.
  std::optional<std::array<double, 2>> force = {};
  std::optional<std::array<double, 2>> displacement = {};
  Eigen::ArrayXd start = {};                ///< tractions of the state before, 2*cells; empty: none
  double energy_before = 0.0;               ///< see ConvexProgram; of the whole grid, over the cell area
  Eigen::ArrayXd guess = {};                ///< tractions near the answer, 2*cells; empty: found from coarser grids
  std::optional<double> limit_factor = {};  ///< of the loads, see LimitLoad, where it is known
};

struct TangentialSolution {
  Status status = Status::not_converged;
  std::string message;                   ///< why it did not converge; empty if it did
  Eigen::ArrayXd traction;               ///< q, 2*cells
  Eigen::ArrayXd elastic_displacement;   ///< K q, 2*cells; outside the contact it may be zero
  Eigen::ArrayXd slip;                   ///< s of Eq. (8), 2*cells, zero outside the contact
  Eigen::ArrayXd stick;                  ///< 1 in A_S, 0 elsewhere
  double twist = 0.0;                    ///< phi_3
  std::array<double, 2> displacement{};  ///< delta_1, delta_2
  double change = 0.0;                   ///< the last value of the method's stopping test
  int iterations = 0;
  std::vector<GridWork> grids = {};  ///< work done, coarsest grid first
  Safeguards safeguards = {};        ///< of Coulomb's method, on all grids
  double part = 1.0;                 ///< contact cells over all cells
};

/// The largest moment (over the cell area) that the friction bounds can carry about the origin: sum of mu p r.
double moment_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound);

/// The limit load for the problem's imposed loads. Without translations the body turns about the origin, also
/// for a quadrant.
LimitLoad limit_of(const TangentialProblem& problem, const Grid& grid);

/// Throws std::invalid_argument if neither or both of moment and twist are given, or both of force and
/// displacement, if a bound is negative or NaN, or if the loads are not below what the contact can carry.
void require_valid(const TangentialProblem& problem, const Grid& grid);

/// The problem on a part of the grid, where a quadrant carries a quarter of the moment; without a guess.
/// Moves what only a solve needs out of the whole one.
TangentialProblem reduced(TangentialProblem& problem, const Reduction& part);

}  // namespace slipstick::solver
