#include "analytic/axisymmetric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analytic/elliptic.hpp"
#include "analytic/elliptic_series.hpp"
#include "analytic/gsl.hpp"

namespace slipstick::analytic {

namespace {

using series::Table;
using std::numbers::pi;

/// (1 - c)(1 + c), the square of the modulus that belongs to c.
double squared_modulus(StickRadius c) { return c.complement * (1 + c.ratio); }

// With f = E, K or B of modulus sqrt(1 - s^2) and -H' = f/s, M and M_lim - M are integrals of s^2 f. Both integrands
// are positive: neither cancels as Eq. (5) does. Each integral is a power series, of y = 1 - c^2 or of c^2, up to 1/2.

/// integral_c^1 s^2 f ds, per f(c = 1), over y: half the integral of sqrt(1 - y) f, term by term.
constexpr Table upper_series(const series::Exact& taylor) {
  series::Exact integrated = series::product(series::complementary_modulus(), taylor);
  for (std::size_t n = 0; n < series::kTerms; ++n) integrated[n] /= static_cast<long double>(2 * (n + 1));
  return series::rounded(integrated);
}

/// integral_0^c s^m f ds over c^(m + 1), of the terms with a power of c: log ln(1/c) + constant, term by term.
struct LowerSeries {
  Table log;
  Table constant;
};
constexpr LowerSeries lower_series(const series::Logarithmic& f, int m = 2) {
  series::Logarithmic integrated{};
  for (std::size_t n = m < 0 ? 1 : 0; n < series::kTerms; ++n) {
    const auto power = static_cast<long double>(2 * n) + (m + 1);
    integrated.log[n] = f.log[n] / power;
    integrated.constant[n] = (f.constant[n] + integrated.log[n]) / power;
  }
  return {.log = series::rounded(integrated.log), .constant = series::rounded(integrated.constant)};
}

/// The moment of a profile whose f has these series; scale: (8/3)/(M_lim/(mu p0 a^3)).
struct MomentSeries {
  double scale;
  double f_at_edge;
  Table upper;
  LowerSeries lower;
  double slip_share = 1;

  MomentShare operator()(StickRadius c) const {
    const double y = squared_modulus(c);
    if (y <= 0.5) {
      const double excess = scale * f_at_edge * y * series::sum(upper, y);
      return {.excess = excess, .deficit = slip_share - excess};
    }
    const double x = c.ratio * c.ratio;
    const double deficit =
        scale * x * c.ratio * (-std::log(c.ratio) * series::sum(lower.log, x) + series::sum(lower.constant, x));
    return {.excess = slip_share - deficit, .deficit = deficit};
  }
};

/// Distances that the tractions' R_J is made of: (c^2 - r^2)/(1 - r^2), and 1 - r^2.
struct Rim {
  double inside;
  double rim;
};
Rim rim(StickRadius c, double r, double inward) {
  return {.inside = inward * (c.ratio + r), .rim = (inward + c.complement) * (1 + r)};
}

/// Below this R_J's arguments leave GSL's range in the end; the leading terms in c are then exact to an ulp,
/// the next c^2 ln c smaller.
constexpr double kTiny = 1e-9;

class Hertz final : public Profile {
 public:
  Hertz()
      : Profile(
            {.name = "hertz", .reference_pressure = "peak pressure", .load = 2 * pi / 3, .moment_limit = 3 * pi / 16}) {
  }

  double pressure(double radius) const override { return std::sqrt((1 - radius) * (1 + radius)); }

  double twist_integral(StickRadius c) const override { return squared_modulus(c) * complete_elliptic(c.ratio).d; }
  double twist_slope(StickRadius c) const override { return complete_elliptic(c.ratio).e; }
  double punch_density(StickRadius s) const override { return s.ratio; }

  MomentShare moment_share(StickRadius c) const override {
    static constexpr MomentSeries kMoment{.scale = 64 / (3 * pi * pi),
                                          .f_at_edge = pi / 2,
                                          .upper = upper_series(series::taylor_e()),
                                          .lower = lower_series(series::logarithmic_e())};
    return kMoment(c);
  }

  /// Eq. (1)'s bracket is Heuman's Lambda function; with Carlson's R_J it is one term, nothing to cancel.
  double stick_traction(StickRadius c, double r, double inward) const override {
    const auto [inside, rim] = analytic::rim(c, r, inward);
    if (c.ratio < kTiny)
      return 2 / pi * std::atan2(r, std::sqrt(inward) * std::sqrt(c.ratio + r));  // (2/pi) arcsin(r/c)
    return 2 / (3 * pi) * r * std::sqrt(inside) * squared_modulus(c) / rim *
           carlson_rj(0, c.ratio * c.ratio, 1, inside / rim);
  }
};

class Cone final : public Profile {
 public:
  Cone() : Profile({.name = "cone", .reference_pressure = "mean pressure", .load = pi, .moment_limit = pi / 6}) {}

  double pressure(double radius) const override {
    const double excess = (1 - radius) / radius;  // of 1/r over 1
    return std::log1p(excess + std::sqrt(excess * (2 + excess)));
  }

  /// integral_c^1 K/s ds, term by term.
  double twist_integral(StickRadius c) const override {
    static constexpr Table kUpper = [] {
      series::Exact integrated = series::summed(series::taylor_k());
      for (std::size_t n = 0; n < series::kTerms; ++n) integrated[n] /= static_cast<long double>(n + 1);
      return series::rounded(integrated);
    }();
    static constexpr LowerSeries kLower = lower_series(series::logarithmic_k(), -1);
    const double y = squared_modulus(c);
    if (y <= 0.5) return pi / 4 * y * series::sum(kUpper, y);
    const double x = c.ratio * c.ratio;
    const double log = -std::log(c.ratio);
    const double leading = log + 2 * std::numbers::ln2;
    return leading * leading / 2 - pi * pi / 12 - (log * series::sum(kLower.log, x) + series::sum(kLower.constant, x));
  }
  double twist_slope(StickRadius c) const override { return complete_elliptic(c.ratio).k; }
  double punch_density(StickRadius) const override { return 1; }

  MomentShare moment_share(StickRadius c) const override {
    static constexpr MomentSeries kMoment{.scale = 16 / (pi * pi),
                                          .f_at_edge = pi / 2,
                                          .upper = upper_series(series::taylor_k()),
                                          .lower = lower_series(series::logarithmic_k())};
    return kMoment(c);
  }

  /// q = (2/pi) r integral_c^1 K/(s sqrt(s^2 - r^2)) ds. With s = r cosh(u) the integrand is smooth and falls
  /// like exp(-u); what is singular lies pi/2 off the axis, at s = 0.
  double stick_traction(StickRadius c, double r, double inward) const override {
    constexpr double kNegligible = 40;  // exp(-40) is below a unit of rounding
    constexpr double kSteep = 12;       // one rule of 20 points follows exp(-u) so far, to all digits
    constexpr double kReach = 2;        // longest panel, over its distance from the singular point
    static const gsl::GaussRule rule(20);

    const double depth = std::sqrt(inward) * std::sqrt(c.ratio + r);  // the product may underflow
    const double rim = std::sqrt((inward + c.complement) * (1 + r));
    const double rising = c.ratio + depth;  // s = (rising e^u + r^2/rising e^-u)/2 from u = 0 at s = c
    const double falling = r * (r / rising);
    const double end = std::min(kNegligible, std::log1p((c.complement + squared_modulus(c) / (rim + depth)) / rising));
    const double start = r > 0 ? std::log(rising / r) : kNegligible;
    double sum = 0;
    for (double from = 0; from < end;) {
      const double to = std::min({end, from + kSteep, from + kReach * std::hypot(start + from, pi / 2)});
      sum += rule(
          [&](double u) {
            const double growth = std::exp(u);
            const double s = std::min(1.0, (rising * growth + falling / growth) / 2);
            return complete_elliptic(s).k / s;
          },
          from, to);
      from = to;
    }
    return 2 / pi * r * sum;
  }
};

class FlatPunch final : public Profile {
  static constexpr auto kSlipShare = static_cast<double>(1 - 8 / (3 * std::numbers::pi_v<long double>));

 public:
  FlatPunch()
      : Profile({.name = "flat_punch",
                 .reference_pressure = "pressure at the centre",
                 .load = 2 * pi,
                 .moment_limit = pi / 4,
                 .edge = pi / 2,
                 .slip_share = kSlipShare}) {}

  double pressure(double radius) const override { return 1 / std::sqrt((1 - radius) * (1 + radius)); }

  double twist_integral(StickRadius c) const override { return complete_elliptic(c.ratio).k; }
  double twist_slope(StickRadius c) const override {
    const CompleteElliptic elliptic = complete_elliptic(c.ratio);
    return elliptic.k - elliptic.d;  // B
  }
  double punch_density(StickRadius) const override { return 0; }

  MomentShare moment_share(StickRadius c) const override {
    static constexpr MomentSeries kMoment{.scale = 16 / (3 * pi * pi),
                                          .f_at_edge = pi / 4,
                                          .upper = upper_series(series::taylor_b()),
                                          .lower = lower_series(series::logarithmic_b()),
                                          .slip_share = kSlipShare};
    return kMoment(c);
  }

  /// Legendre's Pi, complete, by Carlson's integrals (DLMF 19.25.2).
  double stick_traction(StickRadius c, double r, double inward) const override {
    const auto [inside, rim] = analytic::rim(c, r, inward);
    if (c.ratio < kTiny)
      return 2 / pi * std::atan2(r, std::sqrt(inward) * std::sqrt(c.ratio + r));  // (2/pi) arcsin(r/c)
    const double rj = carlson_rj(0, c.ratio * c.ratio, 1, inside / rim);
    return 2 / pi * r * std::sqrt(inside) / rim * (complete_elliptic(c.ratio).k + squared_modulus(c) / (3 * rim) * rj);
  }
};

/// One for the whole program.
template <class Kind>
const Profile& lasting() {
  static const Kind profile;
  return profile;
}

}  // namespace

double Profile::punch_density(StickRadius) const { return std::numeric_limits<double>::quiet_NaN(); }

/// Up to kSmall above H(1) the difference would lose digits to it; the slope's integral does not.
double Profile::twist_gain(StickRadius c, StickRadius s) const {
  constexpr double kSmall = 0.1;
  const double deep = twist_integral(c);
  if (deep >= (1 + kSmall) * edge()) return deep - twist_integral(s);
  return gsl::gauss_legendre(
      [&](double x) { return twist_slope({.ratio = std::exp(-x), .complement = -std::expm1(-x)}); },
      -std::log1p(-s.complement), -std::log1p(-c.complement));
}

double Profile::bonded_traction(double radius) const {
  return edge() == 0 ? 0 : 2 / pi * edge() * radius / std::sqrt((1 - radius) * (1 + radius));
}

const Profile& hertz_profile() { return lasting<Hertz>(); }
const Profile& cone_profile() { return lasting<Cone>(); }
const Profile& flat_punch_profile() { return lasting<FlatPunch>(); }

}  // namespace slipstick::analytic
