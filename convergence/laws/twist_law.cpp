#include "convergence/laws/twist_law.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analytic/cycle.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::convergence {
namespace {

using analytic::TorsionState;

/// -ln(1 - m) from whichever of m and 1 - m has the digits.
double logarithm_of(const TorsionState& state) {
  return state.moment_ratio < 0.5 ? -std::log1p(-state.moment_ratio) : -std::log(state.moment_deficit);
}

TorsionState at_logarithm(double logarithm, const analytic::Profile& profile) {
  return logarithm < std::log(2.0) ? analytic::from_moment_ratio(-std::expm1(-logarithm), profile)
                                   : analytic::from_moment_deficit(std::exp(-logarithm), profile);
}

/// The energy that a cycle loses, over 4 M phi. error: relative.
double loss_factor_of(const TorsionState& state, const analytic::Profile& profile, double error) {
  return analytic::energy_lost_per_cycle(state, profile, error) / (4.0 * state.moment * state.twist);
}

/// The exponent p of the smallest losses: their factor is proportional to m^p, or to (m - m of full stick)^p.
double loss_power_of(const analytic::Profile& profile) {
  if (profile.edge() > 0.0) return 2.0;
  constexpr double kSmall = 1e-30;
  const auto factor = [&](double m) {
    return loss_factor_of(analytic::from_moment_ratio(m, profile), profile, 1e-14);
  };
  return std::log2(factor(2.0 * kSmall) / factor(kSmall));
}

/// From rest to the last state, with a knot where slip begins under a load.
std::vector<double> knots_of(double first_slip, double last) {
  return first_slip > 0.0 ? std::vector{0.0, first_slip, last} : std::vector{0.0, last};
}

}  // namespace

double TwistLaw::moment_ratio_at(double t) const {
  const double size = std::abs(t);
  if (size >= last_twist) return std::copysign(1.0, t);
  return std::copysign(-std::expm1(-size * logarithm(size)), t);
}

TwistLaw fit_twist_law(const analytic::Profile& profile, double error) {
  if (!(error >= kMinLawError && error <= kMaxLawError)) {
    throw std::domain_error(
        fmt::format("an error of {}; allowed: {} to {}", error, kMinLawError, kMaxLawError));
  }
  const bool has_full_stick = profile.edge() > 0.0;
  const double first_slip = has_full_stick ? analytic::from_stick_ratio(1.0, profile).twist : 0.0;
  const double first_logarithm = has_full_stick ? -std::log(profile.slip_share()) : 0.0;
  const double last_twist = analytic::from_moment_deficit(kLastDeficit, profile).twist;
  const double last_logarithm = -std::log(kLastDeficit);
  const auto logarithm_per_twist = [&](double t) {
    return logarithm_of(analytic::from_twist(t, profile)) / t;
  };
  const auto twist_per_logarithm = [&](double l) { return at_logarithm(l, profile).twist / l; };
  const double loss_power = loss_power_of(profile);
  constexpr double kPartOfError = 1e-2;  // that the integrals may have
  const auto loss_factor = [&](double l) {
    return loss_factor_of(at_logarithm(l, profile), profile, std::max(1e-14, kPartOfError * error)) /
           std::pow(l - first_logarithm, loss_power);
  };
  return {.moment_limit = profile.moment_limit(),
          .full_stick = has_full_stick ? profile.full_stick() : 0.0,
          .error = error,
          .last_twist = last_twist,
          .logarithm = fit_chebyshev(logarithm_per_twist, knots_of(first_slip, last_twist), error),
          .twist = fit_chebyshev(twist_per_logarithm, knots_of(first_logarithm, last_logarithm), error),
          .first_logarithm = first_logarithm,
          .loss_power = loss_power,
          .loss_factor = fit_chebyshev(loss_factor, {first_logarithm, last_logarithm}, error)};
}

}  // namespace slipstick::convergence
