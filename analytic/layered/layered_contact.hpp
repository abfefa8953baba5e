#pragma once

#include <memory>

#include "analytic/axisymmetric.hpp"
#include "analytic/indentation.hpp"
#include "analytic/layered/layered_pair.hpp"

/// Coated bodies pressed together without friction, and twisted. The pressure
///   p(r) = psi(a)/sqrt(a^2 - r^2) - integral_r^a psi'(t)/sqrt(t^2 - r^2) dt
/// lays the surfaces on each other where
///   psi(t) + integral_0^a K(t, s) psi(s) ds = (E*/pi) (approach - t^2/R),  W = 2 pi integral psi dt,
/// a Fredholm equation of the second kind (Lebedev and Ufliand 1958 for a layer); psi(a) = 0 under a sphere,
/// 1/R = 0 under a flat punch. A layer has any thickness from a 150th of the contact radius.
namespace slipstick::analytic::layered {

struct LayeredContact {
  Indentation indentation;  ///< p0 is the mean pressure
  std::shared_ptr<const Profile> profile;
  /// Estimated relative error of the contact's numbers: the change with fewer points.
  double uncertainty;
};

enum class Indenter { sphere, flat_punch };

/// radius: relative radius of curvature of the sphere or paraboloid, or radius of the punch, m. Throws
/// std::domain_error, with name and value, unless load and radius are positive and finite, and where the contact radius
/// is more than 150 thicknesses, the surfaces would part within it, or slip would begin inside.
LayeredContact press(Indenter indenter, double load, double radius, const Pair& pair);

}  // namespace slipstick::analytic::layered
