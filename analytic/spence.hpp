#pragma once

#include "analytic/axisymmetric.hpp"

/// Bodies of different materials pressed together with friction (Goodman 1962, Spence 1968, 1975): under the
/// pressure one surface draws inwards more than the other, friction holds them together within c < a and acts
/// with mu p against the slip in the ring beyond. As the contact grows the state enlarges itself, and c/a is
/// the same under a flat punch and under every gap like r^n, so that it is worked out under the flat punch.
///
/// The difference of the materials is Dundurs'
///   beta = ((1 - 2 nu_1)/G_1 - (1 - 2 nu_2)/G_2)/(2 ((1 - nu_1)/G_1 + (1 - nu_2)/G_2));
/// against a rigid body 2 it is (1 - 2 nu_1)/(2 (1 - nu_1)). Where beta > 0, surface 1 tends to move inwards
/// and friction on it points outwards; the sign of beta matters for nothing else.
namespace slipstick::analytic {

/// c/a where the shear is taken not to change the pressure (Goodman's approximation, what a solver finds that
/// couples pressure to tangential displacement only): artanh(c)/c = (mu/beta) K(sqrt(1 - c^2)), lengths over
/// a. Relative error of c and 1 - c at most 1e-11. Throws std::domain_error unless friction > 0,
/// 0 < |beta| <= 1/2, 1/600 <= mu/|beta| <= 200.
StickRadius goodman_stick_radius(double friction, double beta);

/// Normal contact with friction, all couplings kept.
struct FrictionalContact {
  double stick_ratio;  ///< c/a
  double stick_error;  ///< its estimated error, absolute: what a coarser rule on the same panels differs by
  /// Load over that without friction, at the same approach, under a flat punch; from 1 without friction to
  /// Mossakovskii's (1963) artanh(beta)/beta where everything sticks.
  double stiffness_ratio;
};

/// Solves Spence's problem as a system of singular integral equations, in some tenths of a second, to about
/// ten digits. Throws std::domain_error unless friction > 0, 0 < |beta| <= 1/2, 1/7 <= mu/|beta| <= 10,
/// std::runtime_error if no solution is found.
FrictionalContact spence_contact(double friction, double beta);

}  // namespace slipstick::analytic
