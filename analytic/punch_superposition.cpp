#include "analytic/punch_superposition.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

#include "analytic/gsl.hpp"
#include "analytic/out_of_range.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;

constexpr double kSmallest = std::numeric_limits<double>::min();

/// Radius x of one of the punches, with its distances from both ends: near the ends x has too few digits.
struct Punch {
  double radius;
  double beyond;  ///< distance from the lowest of the integral
  double inward;  ///< distance from the highest
};

/// The punches from `low` on to low + length, for an integral over dx/sqrt(x^2 - r^2).
struct Punches {
  double low;
  double length;
  double beyond_radius;  ///< low - r
  double beyond_flat;    ///< low - b, b the radius that w begins at
};

/// Integrals of f(x) w(x)/sqrt(x^2 - r^2) dx. With x = m cosh(u), m the larger of r and b, the integrand is analytic:
/// the substitution removes the square root at m; the one at the smaller of the two lies arccos of their ratio off the
/// real axis. The panels of Gauss's rule are proportional to the distance from the singularity.
class Quadrature {
 public:
  /// growth: the power of x that the integrand follows.
  Quadrature(const Punches& punches, double growth) : punches_(punches), growth_(growth) {
    const double above = std::min(punches.beyond_radius, punches.beyond_flat);
    anchor_ = punches.low - above;
    const double apart = std::abs(punches.beyond_radius - punches.beyond_flat);
    const double other = std::max(0.0, anchor_ - apart);
    low_root_ = std::sqrt(above) * std::sqrt(punches.low + anchor_);  // a product could underflow
    const double high = punches.low + punches.length;
    high_root_ = std::sqrt((punches.length + above) * (high + anchor_));
    length_ = along(punches.length);
    start_ = std::asinh(low_root_ / anchor_);
    off_axis_ = std::atan2(std::sqrt(apart * (anchor_ + other)), other);
  }

  template <class Function>
  double operator()(const Function& f) const {
    if (!(punches_.length > 0)) return 0;
    double sum = 0;
    double from = growth_ > 0 ? cut_from_above() : 0;
    const double end = growth_ < 0 ? std::min(length_, kNegligible / -growth_) : length_;
    while (from < end) {
      const double to = std::min(end, from + panel(from));
      sum += growth_ > 0 ? gsl::gauss_legendre([&](double down) { return at(length_ - down, down, f); }, length_ - to,
                                               length_ - from)
                         : gsl::gauss_legendre([&](double up) { return at(up, length_ - up, f); }, from, to);
      from = to;
    }
    return sum;
  }

 private:
  static constexpr double kNegligible = 40;  // powers of e below which a part of the integral is nothing
  static constexpr double kSteep = 16;       // powers of e over which one rule follows an exponential

  /// u from the lowest radius to the one so far beyond.
  double along(double beyond) const {
    const double x = punches_.low + beyond;
    const double above = std::min(punches_.beyond_radius, punches_.beyond_flat);
    const double root = std::sqrt(beyond + above) * std::sqrt(x + anchor_);
    return std::log1p((beyond + beyond * ((x + punches_.low) / (root + low_root_))) / (punches_.low + low_root_));
  }

  double cut_from_above() const {
    const double cut = (punches_.low + punches_.length) * std::exp(-kNegligible / growth_);
    return cut > punches_.low ? along(cut - punches_.low) : 0;
  }

  /// Singular are: x = r or b, off the axis at u = 0; x = -c, by the elliptic functions of c/x.
  double panel(double from) const {
    constexpr double kReach = 1.5;
    constexpr double kShortest = 1e-9;  // of the whole: w begins at zero, where b and r all but meet
    const double u = start_ + from;
    const double distance = std::max(std::hypot(u, off_axis_), kShortest * length_);
    const double analytic = kReach * std::min(distance, std::hypot(from, pi));
    if (growth_ == 0) return analytic;
    // ln x grows by at most h min(1, u + h) over a panel h.
    const double most = kSteep / std::abs(growth_);
    const double gentle = u < 1 ? 2 * most / (u + std::sqrt(u * u + 4 * most)) : 0;
    return std::min(analytic, std::max(most, gentle));
  }

  /// f(x) dx/(sqrt(x^2 - r^2) du), `up` from the low end in u and `down` from the high end; where the
  /// integrand grows `down` is the one that holds the digits.
  template <class Function>
  double at(double up, double down, const Function& f) const {
    const double beyond = 2 * std::sinh(up / 2) * (punches_.low * std::sinh(up / 2) + low_root_ * std::cosh(up / 2));
    Punch punch{.radius = punches_.low + beyond, .beyond = beyond, .inward = punches_.length - beyond};
    if (growth_ > 0) {
      const double high = punches_.low + punches_.length;
      const double sum = high + high_root_;  // m exp(u, high)
      punch.radius = (sum * std::exp(-down) + anchor_ * (anchor_ / sum) * std::exp(down)) / 2;
      punch.inward = down > 1
                         ? high - punch.radius
                         : 2 * std::sinh(down / 2) * (high_root_ * std::cosh(down / 2) - high * std::sinh(down / 2));
      if (punch.radius > 2 * punches_.low) punch.beyond = punch.radius - punches_.low;
    }
    return f(punch) * ratio_of_roots(punch);
  }

  /// sqrt(x^2 - m^2)/sqrt(x^2 - r^2).
  double ratio_of_roots(const Punch& punch) const {
    if (punches_.beyond_radius <= punches_.beyond_flat) return 1;  // m is r
    const double r = punches_.low - punches_.beyond_radius;
    return std::sqrt((punch.beyond + punches_.beyond_flat) * (punch.radius + anchor_) /
                     ((punch.beyond + punches_.beyond_radius) * (punch.radius + r)));
  }

  Punches punches_;
  double growth_;
  double anchor_;     // m
  double low_root_;   // m sinh(u), low
  double high_root_;  // m sinh(u), high
  double length_;     // in u
  double start_;      // u, low
  double off_axis_;
};

/// The stick radius as the punches see it, c/x.
struct Front {
  double c;
  double beyond;  ///< the lowest x - c

  StickRadius operator()(const Punch& punch) const {
    return {.ratio = std::min(1.0, c / punch.radius), .complement = (punch.beyond + beyond) / punch.radius};
  }
};

class Superposition : public Profile {
 public:
  double pressure(double radius) const override {
    if (radius == 0) return shape_.peak;
    return sum(punches({.ratio = radius, .complement = 1 - radius}, 0), 0, [](const Punch&) { return 1.0; });
  }

  double twist_integral(StickRadius c) const override {
    return sum(punches(c, c.ratio), 0,
               [&, front = front(c)](const Punch& punch) { return flat_punch_profile().twist_integral(front(punch)); });
  }
  double twist_slope(StickRadius c) const override {
    const double at_front = c.beyond(shape_.flat) > 0 ? weight(c.ratio, c.complement, c.beyond(shape_.flat)) : 0;
    return pi / 2 * at_front + sum(punches(c, c.ratio), 0, [&, front = front(c)](const Punch& punch) {
             return flat_punch_profile().twist_slope(front(punch));
           });
  }
  double punch_density(StickRadius s) const override {
    const double beyond_flat = s.beyond(shape_.flat);
    return beyond_flat > 0 ? weight(s.ratio, s.complement, beyond_flat) : 0;
  }
  std::vector<double> kinks() const override {
    if (shape_.flat > 0) return {shape_.flat};
    constexpr double kGentle = 4;  // powers of e over which a panel follows x^growth
    std::vector<double> list;
    for (double inward = kGentle / std::max(kGentle, shape_.growth); inward < 1; inward *= 2)
      list.insert(list.begin(), 1 - inward);
    return list;
  }

  MomentShare moment_share(StickRadius c) const override {
    const double deficit = moment_deficit(c);
    if (deficit < 0.5) return {.excess = 1 - deficit, .deficit = deficit};
    const double ratio = moment_ratio(c);
    return {.excess = ratio, .deficit = 1 - ratio};
  }

  /// punches with x >= c have a slip ring: q of each follows from its own torsion.
  double stick_traction(StickRadius c, double radius, double inward) const override {
    if (radius == 0) return 0;
    const Punches range = punches(c, inward);
    return sum(range, 0, [&, front = front(c)](const Punch& punch) {
      const double x = punch.radius;
      const double root = std::sqrt((punch.beyond + range.beyond_radius) * (x + radius));
      return root / x * flat_punch_profile().stick_traction(front(punch), radius / x, inward / x);
    });
  }

 protected:
  struct Shape {
    double flat;           ///< b, where w begins
    double growth;         ///< the power of x that w follows
    double second_moment;  ///< integral_b^1 w x^2 dx
    double peak;           ///< p(0)
  };
  Superposition(Constants constants, const Shape& shape) : Profile(std::move(constants)), shape_(shape) {}

  /// w(x); also given are 1 - x and x - b.
  virtual double weight(double x, double inward, double beyond_flat) const = 0;
  /// integral_b^c w x^2 dx.
  virtual double second_moment_within(StickRadius c) const = 0;

 private:
  /// Punches larger than c, for integrals over dx/sqrt(x^2 - r^2) with r = c - inward.
  Punches punches(StickRadius c, double inward) const {
    const double distance = c.beyond(shape_.flat);
    if (distance >= 0)
      return {.low = c.ratio, .length = c.complement, .beyond_radius = inward, .beyond_flat = distance};
    return {.low = shape_.flat, .length = 1 - shape_.flat, .beyond_radius = inward - distance, .beyond_flat = 0};
  }

  Front front(StickRadius c) const { return {c.ratio, std::max(0.0, -c.beyond(shape_.flat))}; }

  /// integral of f w/sqrt(x^2 - r^2), where f follows another power of x.
  template <class Function>
  double sum(const Punches& range, double growth, const Function& f) const {
    return Quadrature(range, shape_.growth + growth)([&](const Punch& punch) {
      return weight(punch.radius, punch.inward, punch.beyond + range.beyond_flat) * f(punch);
    });
  }

  /// M/M_lim.
  double moment_ratio(StickRadius c) const {
    return sum(punches(c, c.ratio), 3,
               [&, front = front(c)](const Punch& punch) {
                 const double share =
                     flat_punch_profile().full_stick() + flat_punch_profile().moment_share(front(punch)).excess;
                 return punch.radius * punch.radius * punch.radius * share;
               }) /
           shape_.second_moment;
  }

  /// 1 - M/M_lim: all of the punches within c, and of the others the share that c/x leaves.
  double moment_deficit(StickRadius c) const {
    constexpr double kTiny = 1e-9;  // below, a punch's share is its leading term to an ulp
    const double outer = sum(punches(c, c.ratio), 0, [&, front = front(c)](const Punch& punch) {
      const StickRadius t = front(punch);
      if (t.ratio < kTiny) return 16 / (9 * pi * pi);
      return flat_punch_profile().moment_share(t).deficit / (t.ratio * t.ratio * t.ratio);
    });
    const double inner = c.beyond(shape_.flat) > 0 ? second_moment_within(c) : 0;
    return (inner + c.ratio * (c.ratio * (c.ratio * outer))) / shape_.second_moment;  // the cube could underflow
  }

  Shape shape_;
};

class Power final : public Superposition {
 public:
  explicit Power(double n)
      : Superposition({.name = fmt::format("power:{}", n),
                       .reference_pressure = fmt::format("mean pressure times {:g}", (n + 1) / 2),
                       .load = 2 * pi / (n + 1),
                       .moment_limit = pi / 4 * (n + 1) / (n + 2)},
                      {.flat = 0,
                       .growth = n - 1,
                       .second_moment = 1 / (n + 2),
                       .peak = n > 1 ? 1 / (n - 1) : std::numeric_limits<double>::infinity()}),
        exponent_(n) {}

 private:
  double weight(double x, double inward, double) const override { return power(x, inward) / x; }
  double second_moment_within(StickRadius c) const override {
    return power(c.ratio, c.complement) * c.ratio * c.ratio / (exponent_ + 2);
  }
  /// x^n: n + 2 or n - 1, rounded, would cost digits of a small x, and a large n needs the digits of 1 - x.
  double power(double x, double inward) const {
    return inward < 0.5 ? std::exp(exponent_ * std::log1p(-inward)) : std::pow(x, exponent_);
  }

  double exponent_;
};

/// 2 s - b arccos(b/x) with s = sqrt(x^2 - b^2), twice the least it can be.
double rounded_weight(double x, double beyond_flat, double flat) {
  const double s = std::sqrt(beyond_flat * (x + flat));
  return 2 * s - flat * std::atan2(s, flat);
}

/// integral_b^high w(x) x^power dx, power >= 1.
double rounded_moment(double flat, double length, double power) {
  const double low = std::max(flat, kSmallest);
  const Punches range{.low = low, .length = length, .beyond_radius = low, .beyond_flat = 0};
  return Quadrature(range, power + 2)([&](const Punch& punch) {
    return rounded_weight(punch.radius, punch.beyond, flat) * std::pow(punch.radius, power + 1);
  });
}

class RoundedPunch final : public Superposition {
 public:
  explicit RoundedPunch(double flat) : RoundedPunch(flat, 2 * rounded_moment(flat, 1 - flat, 1)) {}

 private:
  RoundedPunch(double flat, double norm) : RoundedPunch(flat, norm, rounded_moment(flat, 1 - flat, 2) / norm) {}
  RoundedPunch(double flat, double norm, double second_moment)
      : Superposition({.name = fmt::format("rounded_punch:{}", flat),
                       .reference_pressure = "mean pressure",
                       .load = pi,
                       .moment_limit = pi / 2 * second_moment},
                      {.flat = flat,
                       .growth = 1,
                       .second_moment = second_moment,
                       .peak = rounded_moment(flat, 1 - flat, -1) / norm}),
        flat_(flat),
        norm_(norm) {}

  double weight(double x, double, double beyond_flat) const override {
    return rounded_weight(x, beyond_flat, flat_) / norm_;
  }
  double second_moment_within(StickRadius c) const override {
    return rounded_moment(flat_, c.beyond(flat_), 2) / norm_;
  }

  double flat_;
  double norm_;
};

}  // namespace

std::unique_ptr<const Profile> power_profile(double exponent) {
  constexpr double kMin = 0.01;
  constexpr double kMax = 1000;
  if (!(exponent >= kMin && exponent <= kMax))
    out_of_range("exponent of the gap", exponent, fmt::format("{} <= n <= {}", kMin, kMax));
  return std::make_unique<const Power>(exponent);
}

std::unique_ptr<const Profile> rounded_punch_profile(double flat_ratio) {
  if (!(flat_ratio >= 0 && flat_ratio < 1)) out_of_range("b/a", flat_ratio, "0 <= b/a < 1");
  return std::make_unique<const RoundedPunch>(flat_ratio);
}

}  // namespace slipstick::analytic
