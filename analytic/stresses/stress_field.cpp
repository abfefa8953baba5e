#include "analytic/stresses/stress_field.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "analytic/gsl.hpp"
#include "analytic/out_of_range.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

/// Depths below count as this one: what that changes goes like its square root.
constexpr double kSurface = 1e-34;
/// Farther from the centre of the contact the terms of a closed form cancel, and its series in s converges.
constexpr double kOutside = 4;
/// Over a. From farther away the narrowest slip rings leave the range of a double.
constexpr double kLargestDistance = 1e6;

/// One of the discs, seen from a point: s, and r - s with its own digits; the weight of the disc in an integral.
struct Disc {
  StickRadius radius;
  double inside;
  double weight;
};

/// R, R + Z with Z = z + i s: neither cancels, since both R and Z lie in the first quadrant.
struct Roots {
  Roots(BodyPoint at, double s, double inside)
      : z(at.depth, s),
        r(std::sqrt(Complex(at.depth * at.depth + inside * (at.radius + s), 2 * at.depth * s))),
        sum(r + z) {}
  Complex z;
  Complex r;
  Complex sum;
};

/// Stresses of a disc turned by G phi = 1. With w = (R - Z)/r = r/(R + Z):
///   sigma_tz = -(4/pi) (Im w + s Re(w/R)),  sigma_rt = (4/pi) (Im w^2/2 + s Re(w^2/R)).
TorsionStress of_turned_disc(BodyPoint at, const Disc& disc) {
  const double s = disc.radius.ratio;
  if (std::hypot(at.radius, at.depth) < kOutside) {
    const Roots roots(at, s, disc.inside);
    const Complex w = at.radius / roots.sum;
    return {.rt = 4 / pi * (std::imag(w * w) / 2 + s * std::real(w * w / roots.r)),
            .tz = -4 / pi * (std::imag(w) + s * std::real(w / roots.r))};
  }
  // The same as an integral of its derivative in s, none of whose terms cancel.
  static const gsl::GaussRule rule(10);
  TorsionStress sum{};
  for (const auto& [fraction, weight] : rule.nodes()) {
    const double t = s * fraction;
    const Roots roots(at, t, at.radius - t);
    const Complex w = at.radius / roots.sum;
    const Complex cube = roots.r * roots.r * roots.r;
    sum.rt += 4 / pi * s * weight * t * std::imag(w * w * (2.0 * roots.r + roots.z) / cube);
    sum.tz -= 4 / pi * s * weight * t * at.radius * std::imag(1.0 / cube);
  }
  return sum;
}

/// What the stresses by a pressure are made of: the harmonic function chi that equals p at the surface, and
/// d(chi)/dz = chi_z, d(chi)/dr = chi_r, V with dV/dz = chi, L with dL/dz = V (Boussinesq's potentials).
struct Potentials {
  double chi;
  double z_chi_z;
  double z_chi_r;
  double z_v_r_over_r;
  double l_r_over_r;

  void add(const Potentials& other, double weight) {
    chi += weight * other.chi;
    z_chi_z += weight * other.z_chi_z;
    z_chi_r += weight * other.z_chi_r;
    z_v_r_over_r += weight * other.z_v_r_over_r;
    l_r_over_r += weight * other.l_r_over_r;
  }
};

/// Of a flat punch with the pressure 1/sqrt(s^2 - r^2).
Potentials of_punch(BodyPoint at, const Disc& disc) {
  const Roots roots(at, disc.radius.ratio, disc.inside);
  const Complex inverse = 1.0 / roots.r;
  const Complex cube = inverse * inverse * inverse;
  return {.chi = -std::imag(inverse),
          .z_chi_z = at.depth * std::imag(roots.z * cube),
          .z_chi_r = at.depth * at.radius * std::imag(cube),
          .z_v_r_over_r = -at.depth * std::imag(inverse / roots.sum),
          .l_r_over_r = std::imag(1.0 / roots.sum)};
}

/// Of Hertz's pressure sqrt(1 - r^2) (Huber 1904): the integral of s times the above, with R dR = i Z ds.
Potentials of_hertz(BodyPoint at) {
  const double z = at.depth;
  const Roots roots(at, 1, at.radius - 1);
  const double angle = std::arg(roots.sum);
  const Complex w = at.radius / roots.sum;
  return {.chi = std::imag(roots.r) - z * angle,
          .z_chi_z = z * (std::real(1.0 / roots.r) - angle),
          .z_chi_r = z * std::imag((at.radius - z * w) / roots.r),
          .z_v_r_over_r = z * (angle - std::imag(Complex(-z, 1) / roots.sum)) / 2,
          .l_r_over_r = std::imag(roots.z * (z / 2 - roots.z / 3.0) / roots.sum - roots.r / 3.0) + z * angle / 2};
}

/// Fractions of a panel and weights of double exponential quadrature (Takahasi and Mori 1974), which does not
/// mind that a function is singular at an end; both distances from the ends have all digits.
struct EndNode {
  double from_low;
  double from_high;
  double weight;
};
const std::vector<EndNode>& end_nodes() {
  static const std::vector<EndNode> nodes = [] {
    constexpr double kNodeStep = 0.125;
    constexpr int kNodeReach = 31;
    std::vector<EndNode> list;
    for (int k = -kNodeReach; k <= kNodeReach; ++k) {
      const double growth = pi * std::sinh(kNodeStep * k);
      const EndNode node{1 / (1 + std::exp(-growth)), 1 / (1 + std::exp(growth)), 0};
      list.push_back(node);
      list.back().weight = kNodeStep * pi * std::cosh(kNodeStep * k) * node.from_low * node.from_high;
    }
    return list;
  }();
  return nodes;
}

/// Integrals over the discs between two radii, seen from a point. The stresses of a disc are singular at
/// s = r +- i z; in u of s = r + z sinh(u) these roots are gone, and what remains lies pi/2 off the axis.
class Discs {
 public:
  Discs(StickRadius low, StickRadius high, BodyPoint at) : low_(low), high_(high), depth_(at.depth) {
    start_ = std::asinh(low.beyond(at.radius) / depth_);
    const double middle = (start_ + std::asinh(high.beyond(at.radius) / depth_)) / 2;
    const double gap = low.ratio < 0.5 ? high.ratio - low.ratio : low.complement - high.complement;
    length_ = 2 * std::asinh(gap / (2 * depth_ * std::cosh(middle)));
  }

  /// Calls f with each disc.
  template <class Function>
  void each(const Function& f) const {
    constexpr double kLongestPanel = 2;
    static const gsl::GaussRule rule(20);
    const int panels = std::max(1, static_cast<int>(std::ceil(length_ / kLongestPanel)));
    const double panel = length_ / panels;
    for (const EndNode& node : end_nodes()) {
      const double low = panel * node.from_low;
      const double high = panel * node.from_high;
      if (panels == 1) f(disc(low, high, panel * node.weight));
      if (panels == 1) continue;
      f(disc(low, length_ - low, panel * node.weight));
      f(disc(length_ - high, high, panel * node.weight));
    }
    for (int k = 1; k < panels - 1; ++k)
      for (const auto& [fraction, weight] : rule.nodes()) {
        const double up = panel * (k + fraction);
        f(disc(up, length_ - up, panel * weight));
      }
  }

 private:
  Disc disc(double up, double down, double weight) const {
    const double u = start_ + up;
    const double above = 2 * depth_ * std::cosh(start_ + up / 2) * std::sinh(up / 2);
    const double below = 2 * depth_ * std::cosh(u + down / 2) * std::sinh(down / 2);
    const StickRadius s{.ratio = std::min(1.0, low_.ratio + above), .complement = high_.complement + below};
    return {.radius = s, .inside = -depth_ * std::sinh(u), .weight = weight * depth_ * std::cosh(u)};
  }

  StickRadius low_;
  StickRadius high_;
  double depth_;
  double start_;
  double length_;
};

/// Calls f with discs of all radii from `low` on, whose weights are parts of ds.
template <class Function>
void over_discs(StickRadius low, const Profile& profile, BodyPoint at, const Function& f) {
  if (low.complement == 0) return;
  for (const double kink : profile.kinks()) {
    if (!(kink > low.ratio)) continue;
    const StickRadius high{.ratio = kink, .complement = 1 - kink};
    Discs(low, high, at).each(f);
    low = high;
  }
  Discs(low, {.ratio = 1, .complement = 0}, at).each(f);
}

/// The largest of the discs.
Disc edge_disc(BodyPoint at) { return {{.ratio = 1, .complement = 0}, at.radius - 1, 1}; }

/// The point, within what can be computed.
BodyPoint checked(BodyPoint at, const Profile& profile) {
  if (!(at.radius >= 0 && at.radius <= kLargestDistance))
    out_of_range("r/a", at.radius, fmt::format("0 <= r/a <= {}", kLargestDistance));
  if (!(at.depth >= 0 && at.depth <= kLargestDistance))
    out_of_range("z/a", at.depth, fmt::format("0 <= z/a <= {}", kLargestDistance));
  if (at.depth == 0 && at.radius <= 1) {
    const double pressure = profile.pressure(at.radius);
    if (!(at.radius == 1 ? pressure == 0 : std::isfinite(pressure)))
      out_of_range("z/a", at.depth, fmt::format("above 0 at r/a = {}: the stress is infinite there", at.radius));
  }
  return {.radius = at.radius, .depth = std::max(at.depth, kSurface)};
}

TorsionStress first_loading(const TorsionState& state, const Profile& profile, BodyPoint at) {
  TorsionStress sum{};
  const auto add = [&](const Disc& disc, double weight) {
    const TorsionStress stress = of_turned_disc(at, disc);
    sum.rt += weight * stress.rt;
    sum.tz += weight * stress.tz;
  };
  const StickRadius c{.ratio = state.stick_ratio, .complement = state.stick_complement};
  over_discs(c, profile, at, [&](const Disc& disc) {
    add(disc, disc.weight * profile.twist_slope(disc.radius) / (2 * disc.radius.ratio));
  });
  if (profile.edge() > 0) {
    const double share = c.complement > 0 ? 1 : state.moment_ratio / profile.full_stick();
    add(edge_disc(at), share * profile.edge() / 2);
  }
  return sum;
}

}  // namespace

Severity severity(const PressureStress& pressure, const TorsionStress& torsion, double friction) {
  const auto& [rr, tt, zz, rz] = pressure;
  const double rt = friction * torsion.rt;
  const double tz = friction * torsion.tz;
  if (!std::isfinite(rr + tt + zz + rz + rt + tz)) return {rr, rr, rr};
  const double apart = (rr - tt) * (rr - tt) + (tt - zz) * (tt - zz) + (zz - rr) * (zz - rr);
  const Eigen::Matrix3d tensor{{rr, rt, rz}, {rt, tt, tz}, {rz, tz, zz}};
  const Eigen::Vector3d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
  return {.von_mises = std::sqrt(apart / 2 + 3 * (rz * rz + rt * rt + tz * tz)),
          .tresca = principal[2] - principal[0],
          .tension = principal[2]};
}

StressField::StressField(const TorsionState& state, const Profile& profile) : profile_(&profile), parts_{{1, state}} {}

StressField::StressField(const LoadingHistory& history, const Profile& profile) : profile_(&profile) {
  for (const auto& [weight, amplitude] : history.branches())
    parts_.push_back({weight, from_moment_ratio(amplitude, profile)});
}

PressureStress StressField::by_pressure(BodyPoint point, double poisson) const {
  if (!(poisson > -1 && poisson <= 0.5)) out_of_range("nu", poisson, "-1 < nu <= 1/2");
  const BodyPoint at = checked(point, *profile_);
  Potentials sum{};
  const double known = profile_->punch_density({.ratio = 0.5, .complement = 0.5});
  if (std::isnan(known)) return {known, known, known, known};
  if (profile_ == &hertz_profile() && std::hypot(at.radius, at.depth) < kOutside) {
    sum = of_hertz(at);
  } else {
    over_discs({.ratio = 0, .complement = 1}, *profile_, at, [&](const Disc& disc) {
      sum.add(of_punch(at, disc), disc.weight * profile_->punch_density(disc.radius));
    });
    if (profile_->edge() > 0) sum.add(of_punch(at, edge_disc(at)), 2 / pi * profile_->edge());
  }
  const double tt = (1 - 2 * poisson) * sum.l_r_over_r + sum.z_v_r_over_r - 2 * poisson * sum.chi;
  return {
      .rr = -(1 + 2 * poisson) * sum.chi - sum.z_chi_z - tt, .tt = tt, .zz = sum.z_chi_z - sum.chi, .rz = -sum.z_chi_r};
}

TorsionStress StressField::by_torsion(BodyPoint point) const {
  const BodyPoint at = checked(point, *profile_);
  TorsionStress sum{};
  for (const auto& [weight, state] : parts_) {
    const TorsionStress stress = first_loading(state, *profile_, at);
    sum.rt += weight * stress.rt;
    sum.tz += weight * stress.tz;
  }
  return sum;
}

}  // namespace slipstick::analytic
