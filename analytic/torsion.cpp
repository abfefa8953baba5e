#include "analytic/torsion.hpp"

#include <limits>
#include <numbers>

#include "analytic/out_of_range.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;

/// Numbers below lose digits.
constexpr double kMin = std::numeric_limits<double>::min();

constexpr StickRadius kFull{.ratio = 1, .complement = 0};

/// G a^2 phi/(mu W) of H.
double twist_at(double twist_integral, const Profile& profile) { return twist_integral / (2 * profile.load()); }

TorsionState state_at(StickRadius c, MomentShare share, const Profile& profile) {
  const double ratio = profile.full_stick() + share.excess;
  return {.moment_ratio = ratio,
          .moment_deficit = share.deficit,
          .stick_ratio = c.ratio,
          .stick_complement = c.complement,
          .twist = twist_at(profile.twist_integral(c), profile),
          .moment = profile.moment_limit() * ratio,
          .tangent_stiffness = profile.bonded_stiffness(c) * c.ratio * c.ratio * c.ratio};
}

TorsionState state_at(StickRadius c, const Profile& profile) { return state_at(c, profile.moment_share(c), profile); }

/// Full stick under a singular edge: the bonded punch.
TorsionState fully_stuck(double moment_ratio, double moment_deficit, const Profile& profile) {
  const double moment = profile.moment_limit() * moment_ratio;
  const double stiffness = profile.bonded_stiffness(kFull);
  return {.moment_ratio = moment_ratio,
          .moment_deficit = moment_deficit,
          .stick_ratio = 1,
          .stick_complement = 0,
          .twist = moment / stiffness,
          .moment = moment,
          .tangent_stiffness = stiffness};
}

/// A function's value, and d ln f/d ln x there.
struct Sample {
  double value;
  double power;
};

/// The x in (0, high) at which an increasing f with f(0) = 0 has the given value, by Newton's method in ln x
/// and ln f, in which the functions below are nearly straight; within a bracket, which halves if need be.
template <class Function>
double solve(double value, double start, double high, Function f) {
  constexpr double kConverged = 1e-9;  // in ln x; the error left is of the order of its square
  constexpr int kMaxSteps = 200;       // four are usual
  constexpr int kStraight = 20;        // later every other step halves: a bumpy table may send Newton to and fro
  if (value == 0) return 0;
  double low = 0;
  double x = start > 0 && start < high ? start : high / 2;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Sample sample = f(x);
    const double step = std::log(value / sample.value) / sample.power;
    double next = x * std::exp(step);
    if (std::abs(step) <= kConverged || next == x) return next;
    (sample.value < value ? low : high) = x;
    const bool astray = !(next > low && next < high) || (i >= kStraight && i % 2 == 0);
    if (astray) next = low > 0 ? std::sqrt(low) * std::sqrt(high) : high / 16;
    x = next;
  }
  throw std::runtime_error(fmt::format("no root found for {}: last at {}", value, x));
}

/// dM/d(c^3) is -S f/6 with f = -c H' and S the bonded stiffness: M over M_lim as a power series begins with
/// this slope at c = 1.
double slope_in_cube(StickRadius c, const Profile& profile) {
  return profile.bonded_stiffness(c) / 6 * profile.twist_slope(c) / (profile.load() * profile.moment_limit());
}

/// From the moment beyond full stick, solved in u = 1 - c^3.
StickRadius stick_from_excess(double excess, const Profile& profile) {
  const auto stick = [](double u) {
    const double complement = -std::expm1(std::log1p(-u) / 3);
    return StickRadius{.ratio = 1 - complement, .complement = complement};
  };
  const double start = excess / slope_in_cube(kFull, profile);
  return stick(solve(excess, start, 1, [&](double u) {
    const StickRadius c = stick(u);
    const double value = profile.moment_share(c).excess;
    return Sample{.value = value, .power = u * slope_in_cube(c, profile) / value};
  }));
}

/// For loads near the limit, solved in c.
StickRadius stick_from_deficit(double deficit, const Profile& profile) {
  const auto stick = [](double c) { return StickRadius{.ratio = c, .complement = 1 - c}; };
  return stick(solve(deficit, std::cbrt(deficit), 1, [&](double at) {
    const StickRadius c = stick(at);
    const double value = profile.moment_share(c).deficit;
    const double slope = at * slope_in_cube(c, profile);  // first: the cube could underflow
    return Sample{.value = value, .power = 3 * slope * at * at / value};
  }));
}

/// By x = -ln c, in which H grows with the slope -c H'.
StickRadius stick_beyond(double x) { return {.ratio = std::exp(-x), .complement = -std::expm1(-x)}; }

/// Whether the slip ring is too narrow for double precision. Where the bound is not zero at the edge, its
/// width over a goes like the square of the load.
bool is_too_narrow(double load, const Profile& profile) {
  constexpr double kNarrowest = 1e-150;
  return load > 0 && load < kNarrowest && std::isinf(profile.twist_slope({.ratio = 1, .complement = 0}));
}

/// Where there is slip, or no load.
TorsionState state_under(MomentShare share, const Profile& profile) {
  constexpr double kNearLimit = 0.3;  // fraction of slip's effect; there 1 - c is no small difference
  const StickRadius c = share.deficit > kNearLimit * profile.slip_share() ? stick_from_excess(share.excess, profile)
                                                                          : stick_from_deficit(share.deficit, profile);
  return state_at(c, share, profile);
}

}  // namespace

TorsionState from_moment_ratio(double moment_ratio, const Profile& profile) {
  if (moment_ratio >= 1)
    throw std::domain_error(fmt::format("M/M_lim = {} is gross slip; allowed: 0 <= M/M_lim < 1", moment_ratio));
  if (!(moment_ratio == 0 || moment_ratio >= kMin))
    out_of_range("M/M_lim", moment_ratio, "0, or 2.3e-308 <= M/M_lim < 1");
  // Beyond full stick 1 - M/M_lim is exact, and the share of slip has more digits than full stick's rest.
  const double excess = profile.full_stick() > 0 ? profile.slip_share() - (1 - moment_ratio) : moment_ratio;
  if (excess < 0 || is_too_narrow(excess, profile)) return fully_stuck(moment_ratio, 1 - moment_ratio, profile);
  TorsionState state = state_under({.excess = excess, .deficit = 1 - moment_ratio}, profile);
  state.moment_ratio = moment_ratio;
  return state;
}

TorsionState from_moment_deficit(double moment_deficit, const Profile& profile) {
  if (moment_deficit == 0) throw std::domain_error("1 - M/M_lim = 0 is gross slip; allowed: 0 < 1 - M/M_lim <= 1");
  if (!(moment_deficit >= kMin && moment_deficit <= 1))
    out_of_range("1 - M/M_lim", moment_deficit, "2.3e-308 <= 1 - M/M_lim <= 1");
  const double excess = profile.slip_share() - moment_deficit;
  if (excess < 0) return fully_stuck(1 - moment_deficit, moment_deficit, profile);
  return state_under({.excess = excess, .deficit = moment_deficit}, profile);
}

TorsionState from_stick_ratio(double stick_ratio, const Profile& profile) {
  if (!(stick_ratio >= kMin && stick_ratio <= 1)) out_of_range("a_s/a", stick_ratio, "2.3e-308 <= a_s/a <= 1");
  return state_at({.ratio = stick_ratio, .complement = 1 - stick_ratio}, profile);
}

TorsionState from_stick_complement(double stick_complement, const Profile& profile) {
  if (!(stick_complement >= 0 && stick_complement < 1))
    out_of_range("1 - a_s/a", stick_complement, "0 <= 1 - a_s/a < 1");
  return state_at({.ratio = 1 - stick_complement, .complement = stick_complement}, profile);
}

TorsionState from_twist(double twist, const Profile& profile) {
  const double largest = twist_at(profile.twist_integral({.ratio = kMin, .complement = 1}), profile);
  if (!(twist >= 0 && twist <= largest))
    out_of_range("G a^2 phi/(mu W)", twist,
                 fmt::format("0 <= G a^2 phi/(mu W) <= {:.6g}, beyond which a_s/a underflows", largest));
  const double stuck = twist_at(profile.edge(), profile);
  if ((stuck > 0 && twist <= stuck) || is_too_narrow(twist, profile)) {
    const double ratio = profile.bonded_stiffness(kFull) * twist / profile.moment_limit();
    TorsionState state = fully_stuck(ratio, 1 - ratio, profile);
    state.twist = twist;
    return state;
  }
  const double value = 2 * profile.load() * (twist - stuck);
  const StickRadius c = stick_beyond(solve(value, value / profile.twist_slope(kFull), -std::log(kMin), [&](double x) {
    const StickRadius c = stick_beyond(x);
    const double h = profile.twist_gain(c, kFull);
    return Sample{.value = h, .power = x * profile.twist_slope(c) / h};
  }));
  TorsionState state = state_at(c, profile);
  state.twist = twist;
  return state;
}

double traction(const TorsionState& state, double radius, const Profile& profile) {
  const double r = radius;
  if (!(r >= 0 && r <= 1)) out_of_range("r/a", r, "0 <= r/a <= 1");
  const StickRadius c{.ratio = state.stick_ratio, .complement = state.stick_complement};
  if (c.complement == 0) {  // full stick: the bonded punch, if anything
    if (profile.edge() == 0 || state.moment_ratio == 0) return 0;
    if (r == 1) out_of_range("r/a", r, "below 1: the traction is infinite at the edge");
    return state.moment_ratio / profile.full_stick() * profile.bonded_traction(r);
  }
  const double inward = c.beyond(r);
  if (inward > 0) return profile.stick_traction(c, r, inward);
  const double pressure = profile.pressure(r);
  if (!(pressure <= std::numeric_limits<double>::max())) out_of_range("r/a", r, "where the pressure is finite");
  return pressure;
}

}  // namespace slipstick::analytic
