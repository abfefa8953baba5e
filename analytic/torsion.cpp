#include "analytic/torsion.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "analytic/elliptic.hpp"
#include "analytic/gsl.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;

/// The stick ratio c and 1 - c: near either end one of them carries digits that the other cannot.
struct Stick {
  double ratio;
  double complement;
};

/// M/M_lim and 1 - M/M_lim.
struct Load {
  double ratio;
  double deficit;
};

// Superposed twists of flat punches of radii c..1 (Jäger 1995) give, with E of modulus sqrt(1 - s^2),
//   M/M_lim = kScale * integral_c^1 s^2 E ds,    1 - M/M_lim = kScale * integral_0^c s^2 E ds.
// Every integrand is positive: neither cancels as Eq. (5) does. Each integral is a power series, below.
constexpr double kScale = 64 / (3 * pi * pi);
constexpr double kTwistScale = 3 / (4 * pi);  // Eq. (4)

// Both series go by powers of at most 1/2, with coefficients that fall like n^-2: what is left is below
// 1e-17.
constexpr std::size_t kTerms = 48;

/// M/M_lim near full stick. With y = 1 - s^2 the integrand is sqrt(1 - y) E(y)/2, analytic at y = 0; the
/// table is its Taylor series over pi/4 (binomial series times DLMF 19.5.2), integrated term by term.
constexpr auto kRatioSeries = [] {
  std::array<double, kTerms> root{1}, elliptic{1}, series{};
  for (std::size_t n = 1; n < kTerms; ++n) {
    const auto x = static_cast<double>(n);
    root[n] = root[n - 1] * (x - 1.5) / x;
    elliptic[n] = elliptic[n - 1] * (x - 1.5) * (x - 0.5) / (x * x);
  }
  for (std::size_t n = 0; n < kTerms; ++n) {
    for (std::size_t j = 0; j <= n; ++j) series[n] += root[j] * elliptic[n - j];
    series[n] /= static_cast<double>(n + 1);
  }
  return series;
}();

double ratio_series(double y) {
  double sum = 0;
  for (std::size_t n = kTerms; n-- > 0;) sum = kRatioSeries[n] + y * sum;
  return kScale * pi / 4 * y * sum;
}

/// 1 - M/M_lim near gross slip: the logarithmic series of E about s = 0 (DLMF 19.12.2), integrated term by
/// term.
double deficit_series(double c) {
  const double log = -std::log(c);
  double d = 2 * std::numbers::ln2;
  double power = c * c / 2;
  double sum = 1.0 / 3;
  for (std::size_t n = 0; n < kTerms; ++n) {
    const auto m = static_cast<double>(n);
    const double pair = (2 * m + 1) * (2 * m + 2);
    sum += power / (2 * m + 5) * (log + d - 1 / pair + 1 / (2 * m + 5));
    power *= c * c * (m + 0.5) * (m + 1.5) / ((m + 1) * (m + 2));
    d -= 2 / pair;
  }
  return kScale * c * c * c * sum;
}

Load load_at(Stick c) {
  const double y = c.complement * (1 + c.ratio);
  if (y <= 0.5) {
    const double ratio = ratio_series(y);
    return {.ratio = ratio, .deficit = 1 - ratio};
  }
  const double deficit = deficit_series(c.ratio);
  return {.ratio = 1 - deficit, .deficit = deficit};
}

/// H = K - E of modulus sqrt(1 - c^2), the twist over its scale; dH/dc = -E/c.
double twist_integral(Stick c) { return c.complement * (1 + c.ratio) * complete_elliptic(c.ratio).d; }

TorsionState state_at(Stick c, Load load) {
  return {.moment_ratio = load.ratio,
          .moment_deficit = load.deficit,
          .stick_ratio = c.ratio,
          .stick_complement = c.complement,
          .twist = kTwistScale * twist_integral(c),
          .moment = moment_limit() * load.ratio,
          .tangent_stiffness = 16.0 / 3 * c.ratio * c.ratio * c.ratio};
}

/// The x > 0 at which f(x) = value, for f with f(0) = 0 and slopes between `least` and `most`: these bracket
/// the root, Brent's method closes in, and one Newton step with the slope there takes off what its last
/// interval leaves.
template <class Function, class Slope>
double solve(double value, Function f, Slope slope, double least, double most) {
  constexpr double kMargin = 1e-9;  // the bracket's ends may be the root itself, but for rounding
  if (value == 0) return 0;
  const double x = gsl::root([&](double at) { return f(at) - value; }, value / most * (1 - kMargin),
                             value / least * (1 + kMargin));
  return x + (value - f(x)) / slope(x);
}

// M/M_lim is nearly linear in c^3: its slope there is kScale/3 * E, between kScale/3 (c = 0) and pi/2 of that
// (c = 1).
constexpr double kLeastSlope = kScale / 3;
double slope(Stick c) { return kLeastSlope * complete_elliptic(c.ratio).e; }

/// For small loads: solved in u = 1 - c^3.
Stick stick_from_ratio(double moment_ratio) {
  const auto stick = [](double u) {
    const double complement = -std::expm1(std::log1p(-u) / 3);
    return Stick{.ratio = 1 - complement, .complement = complement};
  };
  return stick(solve(
      moment_ratio, [&](double u) { return load_at(stick(u)).ratio; },
      [&](double u) { return slope(stick(u)); }, kLeastSlope, kLeastSlope * pi / 2));
}

/// For loads near the limit: solved in v = c^3.
Stick stick_from_deficit(double moment_deficit) {
  const auto stick = [](double v) {
    const double ratio = std::cbrt(v);
    return Stick{.ratio = ratio, .complement = 1 - ratio};
  };
  return stick(solve(
      moment_deficit, [&](double v) { return load_at(stick(v)).deficit; },
      [&](double v) { return slope(stick(v)); }, kLeastSlope, kLeastSlope * pi / 2));
}

TorsionState state_under(Load load) {
  return state_at(load.ratio <= 0.5 ? stick_from_ratio(load.ratio) : stick_from_deficit(load.deficit), load);
}

[[noreturn]] void out_of_range(std::string_view name, double value, std::string_view range) {
  throw std::domain_error(fmt::format("{} = {}; allowed: {}", name, value, range));
}

}  // namespace

double moment_limit() { return 3 * pi / 16; }

TorsionState from_moment_ratio(double moment_ratio) {
  if (moment_ratio >= 1)
    throw std::domain_error(
        fmt::format("M/M_lim = {} is gross slip; allowed: 0 <= M/M_lim < 1", moment_ratio));
  if (!(moment_ratio >= 0)) out_of_range("M/M_lim", moment_ratio, "0 <= M/M_lim < 1");
  return state_under({.ratio = moment_ratio, .deficit = 1 - moment_ratio});
}

TorsionState from_moment_deficit(double moment_deficit) {
  if (moment_deficit == 0)
    throw std::domain_error("1 - M/M_lim = 0 is gross slip; allowed: 0 < 1 - M/M_lim <= 1");
  if (!(moment_deficit > 0 && moment_deficit <= 1))
    out_of_range("1 - M/M_lim", moment_deficit, "0 < 1 - M/M_lim <= 1");
  return state_under({.ratio = 1 - moment_deficit, .deficit = moment_deficit});
}

TorsionState from_stick_ratio(double stick_ratio) {
  if (!(stick_ratio > 0 && stick_ratio <= 1)) out_of_range("a_s/a", stick_ratio, "0 < a_s/a <= 1");
  const Stick c{.ratio = stick_ratio, .complement = 1 - stick_ratio};
  return state_at(c, load_at(c));
}

TorsionState from_stick_complement(double stick_complement) {
  if (!(stick_complement >= 0 && stick_complement < 1))
    out_of_range("1 - a_s/a", stick_complement, "0 <= 1 - a_s/a < 1");
  const Stick c{.ratio = 1 - stick_complement, .complement = stick_complement};
  return state_at(c, load_at(c));
}

TorsionState from_twist(double twist) {
  // H grows like -ln c: solved in x = -ln c, where its slope is E.
  const double h = twist / kTwistScale;
  const auto stick = [](double x) { return Stick{.ratio = std::exp(-x), .complement = -std::expm1(-x)}; };
  static const double largest =
      kTwistScale * twist_integral({.ratio = std::numeric_limits<double>::min(), .complement = 1});
  if (!(twist >= 0 && twist <= largest))
    out_of_range("G a^2 phi/(mu W)", twist,
                 fmt::format("0 <= G a^2 phi/(mu W) <= {:.6g}, beyond which a_s/a underflows", largest));
  const Stick c = stick(solve(
      h, [&](double x) { return twist_integral(stick(x)); },
      [&](double x) { return complete_elliptic(stick(x).ratio).e; }, 1, pi / 2));
  TorsionState state = state_at(c, load_at(c));
  state.twist = twist;
  return state;
}

double traction(const TorsionState& state, double radius) {
  // Below this R_J's arguments leave GSL's range in the end, and its leading term is exact to an ulp: it is
  // (2/pi) r integral_c^inf ds/(s sqrt(s^2 - r^2)), the next term c^2 ln c smaller.
  constexpr double kLogarithmic = 1e-9;

  const double c = state.stick_ratio;
  const double r = radius;
  if (!(r >= 0 && r <= 1)) out_of_range("r/a", r, "0 <= r/a <= 1");
  const double rim = (1 - r) * (1 + r);
  // The front's distance, from whichever of c and 1 - c holds the digits.
  const double inward = c < 0.5 ? c - r : (1 - r) - state.stick_complement;
  if (inward <= 0) return std::sqrt(rim);
  if (c < kLogarithmic) return 2 / pi * std::atan2(r, std::sqrt(inward) * std::sqrt(c + r));  // arcsin(r/c)
  // Eq. (1)'s bracket is Heuman's Lambda function; with Carlson's R_J it is one term, nothing to cancel.
  const double inside = inward * (c + r);
  const double slip = state.stick_complement * (1 + c);
  return 2 / (3 * pi) * r * std::sqrt(inside) * slip / rim * carlson_rj(0, c * c, 1, inside / rim);
}

}  // namespace slipstick::analytic
