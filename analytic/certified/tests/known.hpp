#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "analytic/certified/ball_text.hpp"
#include "analytic/certified/certified.hpp"

#if __has_include(<flint/acb_elliptic.h>)
#include <flint/acb_elliptic.h>
#else
#include <acb_elliptic.h>
#endif

/// Known values of the contact in balls, by other ways than the code's.
namespace slipstick::analytic::certified::known {

constexpr slong kBits = 300;

inline const Profile kHertz{Kind::hertz};
inline const Profile kCone{Kind::cone};
inline const Profile kFlatPunch{Kind::flat_punch};
inline const Profile kConstant{Kind::constant};
inline Profile power(const std::string& exponent) { return {Kind::power, exponent}; }

/// The quantities that name a state, and all members of one.
inline const std::map<std::string, Quantity> kQuantities{{"moment_ratio", Quantity::moment_ratio},
                                                         {"moment_deficit", Quantity::moment_deficit},
                                                         {"stick_ratio", Quantity::stick_ratio},
                                                         {"stick_complement", Quantity::stick_complement},
                                                         {"twist", Quantity::twist}};
inline const std::map<std::string, Number State::*> kMember{{"moment_ratio", &State::moment_ratio},
                                                            {"moment_deficit", &State::moment_deficit},
                                                            {"stick_ratio", &State::stick_ratio},
                                                            {"stick_complement", &State::stick_complement},
                                                            {"twist", &State::twist},
                                                            {"moment", &State::moment},
                                                            {"tangent_stiffness", &State::tangent_stiffness}};

inline Ball exact(const std::string& text) { return read_exactly("text", text).ball(); }

/// All that a number allows for.
inline Ball enclosure(const Number& number) { return exact(number.value) + exact(number.radius).symmetric(); }

inline bool overlap(const Ball& a, const Ball& b) { return a.finite() && b.finite() && !(a < b) && !(a > b); }

/// Whether two enclosures meet, the second one no wider than this part of itself.
inline ::testing::AssertionResult agree(const Number& number, const Ball& known,
                                        const std::string& within = "1e-38") {
  const Precision precision(kBits);
  const Ball ball = enclosure(number);
  if (!overlap(ball, known))
    return ::testing::AssertionFailure() << number.value << " is not the known value";
  if (!(upper_bound(known) - lower_bound(known) < exact(within) * abs(known)))
    return ::testing::AssertionFailure() << number.value << ": the known value is too vague";
  return ::testing::AssertionSuccess();
}

inline State at_stick_ratio(const Profile& profile, const std::string& c,
                            const std::vector<std::string>& radii = {}, int digits = 40) {
  return state(profile, Quantity::stick_ratio, c, radii, digits);
}

// Other ways than the code's: pressures instead of superposed punches,
// Arb's elliptic integrals instead of means, other variables of integration.

inline ComplexBall elliptic(void (*f)(acb_t, const acb_t, slong), const ComplexBall& parameter,
                            bool analytic) {
  if (analytic && (1 - parameter).touches_cut()) return ComplexBall::indeterminate();
  return made_by<ComplexBall>(f, parameter.get(), Precision::bits());
}

/// K and E of modulus sqrt(1 - s^2).
inline ComplexBall k_of(const ComplexBall& s, bool analytic = false) {
  return elliptic(acb_elliptic_k, 1 - s * s, analytic);
}
inline ComplexBall e_of(const ComplexBall& s, bool analytic = false) {
  return elliptic(acb_elliptic_e, 1 - s * s, analytic);
}

/// -s H'(s) of the sphere and the cone.
inline ComplexBall fall(Kind kind, const ComplexBall& s, bool analytic) {
  return kind == Kind::hertz ? e_of(s, analytic) : k_of(s, analytic);
}

inline Ball load(const Profile& profile) {
  if (profile.kind == Kind::hertz) return 2 * pi() / 3;
  if (profile.kind == Kind::cone || profile.kind == Kind::constant) return pi();
  if (profile.kind == Kind::flat_punch) return 2 * pi();
  return 2 * pi() / (exact(profile.exponent) + 1);
}

/// p cos(theta), where v = k cos(theta) is the height over the pressure's rim.
inline ComplexBall pressure_by_cosine(const Profile& profile, const ComplexBall& v, const ComplexBall& k,
                                      const ComplexBall& cosine) {
  if (profile.kind == Kind::flat_punch) return 1 / k;
  if (profile.kind == Kind::constant) return cosine;
  if (profile.kind == Kind::hertz) return v * cosine;
  if (profile.kind == Kind::cone) return cosine * (log(1 + v) - log(1 - v)) / 2;
  return v * cosine * hypergeometric(1 - exact(profile.exponent) / 2, 1, Ball(3) / 2, v * v);
}

struct Integrals {
  Ball twist;   ///< H
  Ball moment;  ///< M/(mu p0 a^3)
};

/// Both from the pressure: with rho^2 = c^2 + k^2 sin^2 theta and x = k sin theta,
/// H = integral p k cos/rho,  M = 8 integral p k cos/rho (c^3/3 + x rho^2/2 atan(x/c) + c x^2/2).
inline Integrals from_pressure(const Profile& profile, const Ball& c) {
  const Ball k = sqrt(1 - c * c);
  const auto integrate = [&](bool moment) {
    const auto integrand = [&](const ComplexBall& theta, bool analytic) {
      const ComplexBall x = k * sin(theta);
      const ComplexBall v = k * cos(theta);
      const ComplexBall rho2 = c * c + x * x;
      // All cuts are here: rho is imaginary where x/c is beyond +-i, and where v is beyond +-1.
      if (analytic && (rho2.touches_cut() || (1 + v).touches_cut() || (1 - v).touches_cut()))
        return ComplexBall::indeterminate();
      ComplexBall weight = pressure_by_cosine(profile, v, k, cos(theta)) * k / sqrt(rho2);
      if (!moment) return weight;
      return weight * (c * c * c / 3 + x * rho2 / 2 * atan(x / c) + c * x * x / 2);
    };
    return integral(integrand, 0, pi() / 2);
  };
  return {.twist = integrate(false), .moment = 8 * integrate(true)};
}

/// q/(mu p0) inside the stick radius: 2/pi r integral_c^1 e/(s sqrt(s^2 - r^2)) ds.
inline Ball traction_from_twist(Kind kind, const Ball& c, const Ball& r) {
  const auto integrand = [&](const ComplexBall& s, bool analytic) {
    const ComplexBall root2 = s * s - r * r;
    if (analytic && root2.touches_cut()) return ComplexBall::indeterminate();
    return fall(kind, s, analytic) / (s * sqrt(root2));
  };
  return 2 / pi() * r * integral(integrand, c, 1);
}

}  // namespace slipstick::analytic::certified::known
