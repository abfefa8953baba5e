#pragma once

#include <memory>
#include <optional>

#include "analytic/axisymmetric.hpp"
#include "solver/scene/friction_law.hpp"

namespace slipstick::convergence {

/// What friction carries over an axisymmetric contact: reference times profile.pressure(r/a).
struct FrictionBound {
  std::shared_ptr<const analytic::Profile> profile;
  double reference;  ///< Pa
};

/// The friction bound of a law under a pressure, reference_pressure (Pa) times pressure.pressure(r/a).
/// Coulomb's law and Tresca's under every pressure, the others under Hertz's. None where it has no exact form
/// here.
std::optional<FrictionBound> find_friction_bound(const solver::FrictionLaw& law,
                                                 std::shared_ptr<const analytic::Profile> pressure,
                                                 double reference_pressure);

}  // namespace slipstick::convergence
