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

/// How far a result is from Coulomb's law and equilibrium; needs no reference solution. All relative; NaN
/// where the fields hold NaN, so that no bound passes.
struct Certificate {
  /// sum(s.q + mu p |s|) / (q.Kq/2). Each term is non-negative where |q| <= mu p and zero only where
  /// Coulomb's law holds. Coulomb's law minimises the convex energy q.Kq/2 over the friction discs and the
  /// given moment, so that |q - q*|_K^2/2 <= energy(q) - energy(q*) <= gap.
  double gap;
  /// A sharper bound of (energy(q) - energy(q*)) / (q.Kq/2), of second order in what slip a stick cell has
  /// left: the sum over cells of the most that -s.d - k|d|^2/2 can be for |q + d| <= mu p, with q.Kq >= k
  /// q.q. Never above the gap, and free of its rounding: at small loads, where the gap weighs rounding errors
  /// of the displacement with the whole of mu p, it stays as small as ever.
  double energy_error;
  /// What rounding of displacements, slips and tractions may do to the gap, over q.Kq/2: no smaller gap can
  /// be distinguished from zero.
  double rounding;
  double moment;          ///< |t.q Delta - M| / M_lim
  double force;           ///< |sum of q - F/Delta| / sum of mu p
  double friction_bound;  ///< max |q|/(mu p) - 1
  /// What the gap, its bound of second order and its rounding are relative to: q.Kq/2, or that of a state
  /// before where it was more. An error is absolute, and a state that is all but unloaded inherits it.
  double energy = 0.0;
};

/// What a step's certificate takes over from the state that the step starts from.
struct Inherited {
  double energy = 0.0;  ///< see Certificate::energy
  double motion = 0.0;  ///< of the step: the largest in the contact, in size
};

/// friction_bound: mu p of each cell; rotation: the field t = (-x2, x1); moment, force: M/Delta and F/Delta
/// that were asked for. least_eigenvalue: of the operator, a lower bound (elastic_law.hpp); with 0 the energy
/// error is the gap.
Certificate certify(const TractionField& field, const Eigen::ArrayXd& friction_bound,
                    const Eigen::ArrayXd& rotation, double moment, const std::array<double, 2>& force = {},
                    double least_eigenvalue = 0.0);
/// The same about a grid's origin.
Certificate certify(const TractionField& field, const Eigen::ArrayXd& friction_bound, const Grid& grid,
                    double moment, const std::array<double, 2>& force = {}, double least_eigenvalue = 0.0,
                    const Inherited& before = {});

/// Upper bounds of the members of a certificate. Infinite: anything but NaN.
struct CertificateBounds {
  double gap;
  double moment;
  double force;
  double friction_bound;
};

/// The first member that is beyond its bound, or NaN, with its value and the bound in words; empty where the
/// certificate holds.
std::string beyond(const Certificate& certificate, const CertificateBounds& bounds);

/// Angle between slip and the reverse of traction, in degrees; zero under Coulomb's law.
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
