#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>

#include "solver/linear_operator.hpp"
#include "solver/normal_contact.hpp"

namespace slipstick::solver {

/// Torsion of a contact whose pressure is known. One consistent set of units; the operator is (u1, u2) = K
/// (q1, q2).
struct TorsionProblem {
  Eigen::ArrayXd friction_bound;        ///< mu p of each cell; zero outside the contact
  Eigen::ArrayXd initial_displacement;  ///< (u1, u2) by the pressure, Eq. (12); empty: none
  std::optional<double> moment;         ///< M_3 over the cell area; or else
  std::optional<double> twist;          ///< phi_3 itself is imposed
};

/// The largest moment (over the cell area) that the friction bounds can carry about the origin: sum of mu p
/// r.
double moment_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound);

struct PaperOptions {
  double tolerance = 1e-8;  ///< epsilon of Eq. (26) over the sum of mu p
  int max_iterations = 5000;
  /// Called now and then with the iteration and its change over the tolerance asked for.
  std::function<void(int iteration, double change)> progress;
};

struct TorsionSolution {
  Status status = Status::not_converged;
  std::string message;                  ///< why it did not converge; empty if it did
  Eigen::ArrayXd traction;              ///< q, 2*cells
  Eigen::ArrayXd elastic_displacement;  ///< K q, 2*cells
  Eigen::ArrayXd slip;                  ///< s of Eq. (8), 2*cells, zero outside the contact
  Eigen::ArrayXd stick;                 ///< 1 in A_S, 0 elsewhere
  double twist = 0.0;                   ///< phi_3
  double change = 0.0;                  ///< left side of Eq. (26) over the sum of mu p
  int iterations = 0;
};

/// The algorithm of Gradinaru and Spinu, Section 4, step by step, with the rotation field (-x2, x1) and the
/// sums in the denominators that the print lacks, and nothing else mended: a cell that begins to slip keeps
/// the direction its traction had then (Eqs. (22), (23)), so on contacts that are not circular the
/// certificate of the result stays bad. With the twist imposed, the steps that find the twist and balance the
/// moment fall away.
///
/// Throws std::invalid_argument if neither or both of moment and twist are given, if a bound is negative or
/// NaN, or if the moment is not below moment_limit(). Everything that the numbers do is a status with its
/// reason.
TorsionSolution solve_by_paper_method(LinearOperator& op, const TorsionProblem& problem,
                                      const PaperOptions& options = {});

}  // namespace slipstick::solver
