#include "convergence/oracle/exact_theories.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analytic/shear_bounds.hpp"

namespace slipstick::convergence {

using solver::FrictionKind;

std::optional<FrictionBound> find_friction_bound(const solver::FrictionLaw& law,
                                                 std::shared_ptr<const analytic::Profile> pressure,
                                                 double reference_pressure) {
  const bool hertz = pressure.get() == &analytic::hertz_profile();
  const double by_coefficient = law.coefficient * reference_pressure;
  if (!law.map.empty() || law.factors) return std::nullopt;
  switch (law.kind) {
    case FrictionKind::coulomb:
      return FrictionBound{std::move(pressure), by_coefficient};
    case FrictionKind::tresca:
      return FrictionBound{{&analytic::constant_bound_profile(), [](const analytic::Profile*) {}},
                           law.shear_strength};
    case FrictionKind::capped:
      if (!hertz) return std::nullopt;
      return FrictionBound{analytic::capped_hertz_profile(std::min(1.0, law.shear_strength / by_coefficient)),
                           by_coefficient};
    case FrictionKind::power:
      if (!hertz) return std::nullopt;
      return FrictionBound{analytic::power_of_hertz_profile(law.exponent),
                           law.coefficient * std::pow(reference_pressure, law.exponent)};
  }
  return std::nullopt;
}

}  // namespace slipstick::convergence
