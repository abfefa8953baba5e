#include "analytic/certified/ball_contact.hpp"

#include <algorithm>
#include <stdexcept>

namespace slipstick::analytic::certified {

namespace {

Ball half() { return Ball(1).shifted(-1); }

Ball elliptic_k(const Ball& s) { return pi() / (2 * agm(1, s)); }

/// e: -s K'(s), from the derivative of the mean, or K - (n - 1) H.
Ball fall_of_twist_integral(const Law& law, const Stick& stick, const Ball& twist_integral) {
  if (law.constant()) return 1 / stick.root();
  const Ball& s = stick.ratio;
  if (!law.punch()) return elliptic_k(s) - law.share * twist_integral;
  const auto [mean, slope] = agm1_and_slope(s);
  return pi() * s * slope / (2 * mean * mean);
}

/// |e^(rate u) K(c e^(sign u))| on a ball, which has to lie in |Im u| < pi/2. There s = c e^(sign u) has the argument
/// sign Im u; in K = R_F(0, s^2, 1), |t + s^2| >= (t + |s|^2) cos(arg s): |K(s)| <= K(|s|)/sqrt(cos(arg s)).
ComplexBall bound_of_term(const Ball& rate, const Ball& c, int sign, const ComplexBall& u) {
  const Precision enough(32);
  const Ball angle = upper_bound(abs(u.imaginary()));
  if (!(2 * angle < 3)) return ComplexBall::indeterminate();
  const Ball modulus = lower_bound(c * exp(sign * u.real()));
  if (!(modulus > 0)) return ComplexBall::indeterminate();
  const Ball bound = (exp(rate * u.real()) * elliptic_k(modulus) / sqrt(cos(angle))).symmetric();
  return {bound, bound};
}

/// integral_0^end e^(rate u) K(c e^(sign u)) du. Over the logarithm the integrands are smooth all the way to c = 0. For
/// its analyticity test the integrator needs only a bound, and Arb's bound of a mean is far too large.
Ball integral_of_k(const Ball& rate, const Ball& c, int sign, const Ball& end) {
  const auto integrand = [&](const ComplexBall& u, bool analytic) {
    if (analytic) return bound_of_term(rate, c, sign, u);
    return exp(rate * u) * pi() / (2 * agm1(c * exp(sign * u)));
  };
  return integral(integrand, 0, end);
}

/// J(c), with s = e^-u.
Ball slip_moment(const Stick& stick) { return integral_of_k(-3, 1, -1, stick.depth()); }

/// J(0) - J(c), with s = c e^-u up to a u beyond which what is left is too small to matter. Since agm(1, s)
/// is at least sqrt(s), that lies between 0 and pi/5 (c e^-u)^(5/2).
Ball stick_moment(const Stick& stick) {
  const Ball& c = stick.ratio;
  const Ball end = ((Precision::bits() + stick.depth()) * 3 / 10).middle();  // 0.3 > ln 2/2.5
  const Ball left = pi() / 5 * exp(-5 * end / 2) / sqrt(c);
  return c * c * c * (integral_of_k(-3, c, -1, end) + (left + left.symmetric()) / 2);
}

/// p/p0 times v where the radius is rho = sqrt(1 - v^2): finite at the edge of a flat punch too.
/// Analytic for rho off the imaginary axis.
ComplexBall pressure_by_v(const Law& law, const ComplexBall& v, const ComplexBall& rho, bool analytic) {
  switch (law.kind) {
    case Kind::flat_punch:
      return 1;
    case Kind::cone: {
      const ComplexBall inverse = (1 + v) / rho;  // arcosh(1/rho) = log((1 + v)/rho)
      if (analytic && inverse.touches_cut()) return ComplexBall::indeterminate();
      return v * log(inverse);
    }
    case Kind::constant:
      return v;
    case Kind::power:
      break;
  }
  const ComplexBall v2 = 1 - rho * rho;
  return v2 * hypergeometric(1 - law.n * half(), 1, 3 * half(), v2);
}

/// The superposed punches' tractions inside the stick radius: with rho^2 = c^2 + k^2 sin^2 theta,
/// (2/pi) r sqrt(c^2 - r^2) integral_0^(pi/2) p k cos theta/(rho (rho^2 - r^2)) dtheta.
Ball stick_traction(const Law& law, const Stick& stick, const Ball& r, const Ball& beyond) {
  const Ball& c = stick.ratio;
  const Ball inside = beyond * (c + r);
  if (law.constant()) return 2 / pi() * atan(r * stick.root() / sqrt(inside));
  const Ball modulus2 = stick.complement * (1 + c);
  const Ball modulus = sqrt(modulus2);
  const auto integrand = [&](const ComplexBall& theta, bool analytic) {
    const ComplexBall sine = sin(theta);
    const ComplexBall x2 = modulus2 * sine * sine;
    const ComplexBall rho2 = c * c + x2;
    // The root's cut, and the pressure's: it is singular at rho = 0 and elsewhere on the imaginary axis.
    if (analytic && rho2.touches_cut()) return ComplexBall::indeterminate();
    const ComplexBall rho = sqrt(rho2);
    return pressure_by_v(law, modulus * cos(theta), rho, analytic) / (rho * (inside + x2));
  };
  return 2 / pi() * r * sqrt(inside) * integral(integrand, 0, pi() / 2);
}

Ball slip_traction(const Law& law, const Rational& radius) {
  if (law.constant()) return 1;
  if (radius == Rational(1) && !law.punch()) return 0;
  const Ball r = radius.ball();
  const Ball v = sqrt((Rational(1) - radius).ball() * (1 + r));
  return pressure_by_v(law, v, r, false).real() / v;
}

// The stick ratio of a given load or twist is a root in y = ln((1 - c)/c).

/// ln(quantity/value), for a flat punch with the values at the onset of slip subtracted from both, and its
/// derivative in y. It is concave and, of the lesser of the two parts of the load, nowhere flat near the
/// root: Newton's method finds it from afar.
struct Residual {
  Ball value;
  Ball slope;
};

Residual residual(const Equation& equation, const Ball& logit) {
  const Law law(equation.kind, equation.exponent);
  const Stick stick(logit);
  const Ball& c = stick.ratio;
  const Ball h = twist_integral(law, stick);
  const Ball e = fall_of_twist_integral(law, stick, h);
  const Ball given = equation.value.ball();
  if (equation.quantity == Quantity::twist) {
    const Ball onset = law.punch() ? pi() / 2 : Ball(0);
    const Ball excess = h - onset;
    return {.value = log(excess / (2 * law.load * given - onset)), .slope = e * stick.complement / excess};
  }
  const Moment moment = moment_at(law, stick, h);
  const Ball slope = law.weight * c * c * c * e * stick.complement * 16 / (3 * pi() * pi());
  if (equation.quantity == Quantity::moment_deficit)
    return {.value = log(moment.deficit / given), .slope = -slope / moment.deficit};
  const Ball excess = moment.ratio - law.onset();
  return {.value = log(excess / (given - law.onset())), .slope = slope / excess};
}

constexpr slong kRoughBits = 20;

/// A root to about 20 bits; none if the precision is too low.
std::optional<Ball> rough_root(const Equation& equation) {
  constexpr int kMaxSteps = 100;
  constexpr int kFarthest = 2400;  // c or 1 - c = 1e-1042
  Ball y;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Residual at = residual(equation, y);
    const Ball step = at.value / at.slope;
    if (!step.finite()) return {};
    y = (y - step).middle();
    if (abs(step) < Ball(1).shifted(-kRoughBits)) return y;
    if (!(kFarthest < abs(y))) continue;
    y = y < 0 ? -kFarthest : kFarthest;
    if (equation.quantity == Quantity::twist && y > 0 && residual(equation, y).value < 0)
      throw std::domain_error("G a^2 phi/(mu W) is so large that a_s/a would be below 1e-1000");
  }
  return {};
}

/// Let f(y) = 0 be the equation, and Y an interval about y: if y - f(y)/f'(Y) lies inside Y, it holds a root of f, the
/// only one in Y (Moore 1966), and the only one at all, since load and twist grow with y. y is good to `good` bits.
std::optional<Ball> proven_root(const Equation& equation, const Ball& y, slong good) {
  const Residual at = residual(equation, y);
  const Ball around = y + (4 * at.value / at.slope).symmetric();
  if (!around.finite()) return {};
  const Ball slope = [&] {
    const Precision enough(std::min(good + 64, Precision::bits()));
    return residual(equation, around).slope;
  }();
  const Ball newton = y - at.value / slope;
  return newton.inside(around) ? std::optional(newton) : std::nullopt;
}

}  // namespace

Law::Law(Kind pressure, const Rational& exponent)
    : kind(pressure),
      n(exponent.ball()),
      share(punch() ? 1 : n - 1),
      weight(punch()      ? 1
             : constant() ? 3 * pi() / 4
                          : n + 2),
      load(punch()      ? 2 * pi()
           : constant() ? pi()
                        : 2 * pi() / (n + 1)) {}

Ball Law::moment_limit() const { return pi() * pi() / (2 * weight * load); }

Ball Law::onset() const { return punch() ? 8 / (3 * pi()) : Ball(0); }

Stick::Stick(const Rational& c) : ratio(c.ball()), complement((Rational(1) - c).ball()), exactly(c) {}

Stick::Stick(const Ball& logit) : ratio(1 / (1 + exp(logit))), complement(1 / (1 + exp(-logit))) {}

Ball Stick::depth() const { return complement < half() ? -log1p(-complement) : -log(ratio); }

Ball Stick::beyond(const Rational& radius) const {
  if (exactly) return (*exactly - radius).ball();
  return ratio < half() ? ratio - radius.ball() : (Rational(1) - radius).ball() - complement;
}

Ball twist_integral(const Law& law, const Stick& stick) {
  if (law.punch()) return elliptic_k(stick.ratio);
  if (law.constant()) return log((1 + stick.root()) / stick.ratio);
  return integral_of_k(1 - law.n, stick.ratio, 1, stick.depth());  // x = e^-u
}

Moment moment_at(const Law& law, const Stick& stick, const Ball& twist_integral) {
  const Ball& c = stick.ratio;
  if (law.constant()) {
    const Ball slip = atan(stick.root() / c) + c * stick.root();
    const Ball stuck = atan(c / stick.root()) - c * stick.root();
    return {.ratio = 2 * slip / pi(), .deficit = 2 * stuck / pi()};
  }
  const Ball whole = pi() * pi() / 16;
  const Ball bonded = law.share * c * c * c * twist_integral / 3;
  if (c < half()) {  // of J's two parts the smaller is the one to integrate
    const Ball inner = stick_moment(stick);
    return {.ratio = (whole - inner + bonded) / whole, .deficit = (inner - bonded) / whole};
  }
  const Ball outer = slip_moment(stick);
  return {.ratio = (outer + bonded) / whole, .deficit = (whole - outer - bonded) / whole};
}

std::optional<Ball> traction(const Law& law, const Stick& stick, const Rational& radius) {
  if (radius == Rational(0)) return 0;
  const Ball beyond = stick.beyond(radius);
  if (beyond > 0) return stick_traction(law, stick, radius.ball(), beyond);
  const bool slips = stick.exactly ? *stick.exactly <= radius : beyond < 0;
  return slips ? std::optional(slip_traction(law, radius)) : std::nullopt;
}

/// From few bits to all of them, each step at the precision that its result deserves.
std::optional<Stick> solve(const Equation& equation) {
  constexpr slong kMin = 64;
  const slong bits = Precision::bits();
  std::optional<Ball> y;
  slong guard = kMin - kRoughBits;
  for (; !y; guard *= 2) {
    if (kRoughBits + guard > bits) return {};
    const Precision precision(kRoughBits + guard);
    y = rough_root(equation);
  }
  slong good = kRoughBits;
  for (; 2 * good + guard < bits; good *= 2) {
    const Precision precision(2 * good + guard);
    const Residual at = residual(equation, *y);
    y = (*y - at.value / at.slope).middle();
  }
  y = proven_root(equation, *y, good);
  return y ? std::optional<Stick>(*y) : std::nullopt;
}

}  // namespace slipstick::analytic::certified
