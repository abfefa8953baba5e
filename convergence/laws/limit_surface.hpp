#pragma once

#include <vector>

#include "analytic/axisymmetric.hpp"

namespace slipstick::convergence {

/// A load under which all of an axisymmetric contact slides, turning about a point at a distance from its
/// axis. The loads that the contact carries lie on one side of the plane through this one whose normal is
/// that motion: force * centre + moment is largest here (Goyal 1991).
struct LimitLoad {
  double centre;  ///< distance over a; infinite: it slides without turning
  double force;   ///< |F|/(mu W), perpendicular to the arm
  double moment;  ///< M/M_lim
};

/// The loads that a contact carries. The surface is symmetric about the axis of moments.
struct LimitSurface {
  std::vector<LimitLoad> loads;  ///< from the moment alone to the force alone
  /// Between loads next to each other the surface lies between their chord and their tangents, which are so
  /// far apart at most, over the distance from the origin.
  double gap;
  /// (F/(mu W))^2 + (M/M_lim)^2 = 1, which is used in its place (Howe and Cutkosky 1996): its distance from
  /// the origin over the exact one, less 1, where that is farthest from 0.
  double ellipsoid_error;
  LimitLoad ellipsoid_farthest;
};

/// Computes a number of loads, whose motions are spread evenly. Throws std::domain_error for fewer than 3.
LimitSurface limit_surface(const analytic::Profile& profile, int loads);

}  // namespace slipstick::convergence
