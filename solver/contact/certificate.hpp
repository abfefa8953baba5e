#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

enum class Status { converged, not_converged };

/// Tractions q, the displacements K q that they cause, and the slip s. 2*cells values each.
struct TractionField {
  const Eigen::ArrayXd& traction;
  const Eigen::ArrayXd& elastic_displacement;
  const Eigen::ArrayXd& slip;
};

/// The distance of a result from Coulomb's law and equilibrium, without a reference solution:
///
/// 1. gap: sum of s.q + mu p |s|, the duality gap, over q.Kq/2.
/// 2. energy_error: a bound of second order in the slip of stick cells.
/// 3. rounding of both, and the violation of moment, force and friction bound.
///
/// All members are relative, and NaN where fields are NaN, so that no bound passes.
struct Certificate {
  /// sum(s.q + mu p |s|) / (q.Kq/2). Each term is non-negative where |q| <= mu p and zero only where
  /// Coulomb's law holds. Coulomb's law minimises the convex energy q.Kq/2 over the friction discs and the
  /// given moment, so that |q - q*|_K^2/2 <= energy(q) - energy(q*) <= gap.
  double gap;
  /// A sharper bound of (energy(q) - energy(q*)) / (q.Kq/2), of second order in the remaining slip of stick cells: the
  /// sum over cells of max over |q + d| <= mu p of -s.d - k|d|^2/2, with q.Kq >= k q.q. It never exceeds the gap, and
  /// is free of the gap's rounding: at small loads the gap weights rounding errors of the displacement by mu p.
  double energy_error;
  /// Rounding error of the gap over q.Kq/2: a smaller gap cannot be distinguished from zero.
  double rounding;
  double moment;          ///< |t.q Delta - M| / M_lim
  double force;           ///< |sum of q - F/Delta| / sum of mu p
  double friction_bound;  ///< max |q|/(mu p) - 1
  /// The energy to which gap, energy_error and rounding are relative: q.Kq/2, or an earlier state's if that
  /// was larger. Errors are absolute, and a nearly unloaded state inherits them.
  double energy = 0.0;
};

/// The state before a step, for its certificate.
struct Inherited {
  double energy = 0.0;  ///< see Certificate::energy
  double motion = 0.0;  ///< largest |rigid displacement| of the step in the contact
};

/// friction_bound: mu p of each cell; rotation: the field t = (-x2, x1); moment, force: the imposed M/Delta and
/// F/Delta. least_eigenvalue: a lower bound for the operator (elastic_law.hpp); with 0 the energy error is the gap.
Certificate certify(const TractionField& field, const Eigen::ArrayXd& friction_bound, const Eigen::ArrayXd& rotation,
                    double moment, const std::array<double, 2>& force = {}, double least_eigenvalue = 0.0);
/// The same about a grid's origin.
Certificate certify(const TractionField& field, const Eigen::ArrayXd& friction_bound, const Grid& grid, double moment,
                    const std::array<double, 2>& force = {}, double least_eigenvalue = 0.0,
                    const Inherited& before = {});

/// Upper bounds of the members of a certificate. Infinite: anything but NaN.
struct CertificateBounds {
  double gap;
  double moment;
  double force;
  double friction_bound;
};

/// The first member that exceeds its bound or is NaN, with value and bound in words; empty if the
/// certificate holds.
std::string violated_bounds(const Certificate& certificate, const CertificateBounds& bounds);

/// Angle between slip and -traction, in degrees; zero under Coulomb's law.
struct SlipDirection {
  double mean;  ///< weighted by slip
  double max;   ///< among cells that slip at least kNoticeableSlip of the largest slip
};
inline constexpr double kNoticeableSlip = 1e-2;

/// Zero where nothing slips.
SlipDirection slip_direction(const Eigen::ArrayXd& traction, const Eigen::ArrayXd& slip);

/// sqrt(v1^2 + v2^2) in each cell.
Eigen::ArrayXd norms(const Eigen::ArrayXd& vectors);

/// v1 w1 + v2 w2 in each cell.
Eigen::ArrayXd dot_products(const Eigen::ArrayXd& v, const Eigen::ArrayXd& w);

}  // namespace slipstick::solver
