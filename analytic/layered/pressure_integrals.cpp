#include "analytic/layered/pressure_integrals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analytic/elliptic.hpp"
#include "analytic/gsl.hpp"
#include "analytic/layered/panel_rule.hpp"

namespace slipstick::analytic::layered {
namespace {

using std::numbers::pi;

constexpr double kSmallest = PressureIntegrals::kSmallest;
/// Panels over the length of detail: 16 points leave 3^-32, since singular points are 4/3 half-panels away.
constexpr double kPanel = 3;

const gsl::GaussRule& gauss_rule(std::size_t points) {
  static const gsl::GaussRule full(16);
  static const gsl::GaussRule coarse(14);
  return points == 16 ? full : coarse;
}

/// 1 - s at the ends of panels between the edge and kSmallest, at most halving s and at most so long.
std::vector<double> panel_ends(double longest) {
  std::vector<double> ends{0};
  for (double s = 1; s > kSmallest;) {
    s = std::max({s / 2, s - longest, kSmallest});
    ends.push_back(1 - s);
  }
  return ends;
}

}  // namespace

PressureIntegrals::PressureIntegrals(ChebyshevPanels weight, double edge, double detail, double resolution)
    : weight_(std::move(weight)),
      edge_(edge),
      at_edge_(pi / 2 * edge),
      detail_(detail),
      points_(resolution < 1 ? 14 : 16),
      ellipse_(
          [&](double y) {
            // With x^2 = y + (1 - y) t^2 the integral is sqrt(1 - y) times that of w over t.
            return PanelRule(detail, resolution)([&](double t) { return weight_(y + (1 - y) * t * t); });
          },
          squared_ends(1, detail), static_cast<std::size_t>(kTerms * resolution)),
      growth_(
          [&](double complement) {
            return smooth_integral({1 - complement, complement}) / complement;
          },
          panel_ends(kPanel * detail), points_ + 8) {
  load_ = 2 * pi * edge;
  for (const Node& node : nodes(0, 1)) {
    const double s = node.s.ratio;
    moment_limit_ += 8 * node.weight * s * s * node.integral;
  }
  // The load of a punch of radius x under x w/sqrt(x^2 - r^2) is 2 pi x^2 w.
  load_ += 2 * pi * PanelRule(detail, resolution)([&](double x) { return x * x * weight_(x * x); });
}

double PressureIntegrals::pressure(double radius) const {
  const double root = std::sqrt((1 - radius) * (1 + radius));
  return root * ellipse_(radius * radius) + (edge_ == 0 ? 0 : edge_ / root);
}

/// H(s) without the edge's constant: integral_s^1 w(x^2) K(s/x) dx, K by its complementary modulus, and the
/// edge term's K(s) - K(1).
double PressureIntegrals::smooth_integral(StickRadius s) const {
  double sum = 0;
  double done = 0;  // x - s
  while (done < s.complement) {
    const double x = s.ratio + done;
    const double end = std::min({s.complement, done + x, done + kPanel * detail_});
    sum += gauss_rule(points_)(
        [&](double beyond) {
          const double at = s.ratio + beyond;
          return weight_(at * at) * complete_elliptic(std::min(1.0, s.ratio / at)).k;
        },
        done, end);
    done = end;
  }
  if (edge_ == 0) return sum;
  // By the slope of K, which keeps the digits of a small 1 - s.
  const double small = gsl::gauss_legendre(
      [&](double x) {
        const CompleteElliptic elliptic = complete_elliptic(std::exp(-x));
        return elliptic.k - elliptic.d;
      },
      0, -std::log1p(-std::min(s.complement, 0.5)));
  const double large = s.complement > 0.5 ? complete_elliptic(s.ratio).k - complete_elliptic(0.5).k : 0;
  return sum + edge_ * (small + large);
}

double PressureIntegrals::integral(StickRadius s) const {
  if (s.ratio < kSmallest)
    return integral({kSmallest, 1 - kSmallest}) + pressure(0) * std::log(kSmallest / s.ratio);
  return at_edge_ + s.complement * growth_(s.complement);
}

double PressureIntegrals::slope(StickRadius s) const {
  if (s.ratio < kSmallest) return pressure(0) / s.ratio;
  const ChebyshevSeries& panel = growth_.at(s.complement);
  return panel(s.complement) + s.complement * panel.derivative()(s.complement);
}

std::vector<PressureIntegrals::Node> PressureIntegrals::nodes(double from, double to) const {
  std::vector<Node> result;
  for (const ChebyshevSeries& panel : growth_.panels()) {
    const double low = std::max(from, panel.low());
    const double high = std::min(to, panel.high());
    if (!(low < high)) continue;
    for (const auto& [fraction, weight] : gauss_rule(points_).nodes()) {
      const double complement = low + (high - low) * fraction;
      const StickRadius s{1 - complement, complement};
      result.push_back({s, (high - low) * weight, at_edge_ + complement * panel(complement)});
    }
  }
  return result;
}

std::vector<PressureIntegrals::Node> PressureIntegrals::beyond(StickRadius c) const {
  return nodes(0, c.complement);
}
std::vector<PressureIntegrals::Node> PressureIntegrals::within(StickRadius c) const {
  return nodes(c.complement, 1);
}

/// With v = sqrt(s^2 - r^2) the integrand is -H'(s)/s dv, smooth.
double PressureIntegrals::punches(StickRadius c, double radius, double inward) const {
  const auto root = [&](double complement) {  // v at 1 - s, from the digits of s - c and c - r
    const double beyond = (c.complement - complement) + inward;
    return std::sqrt(beyond) * std::sqrt((1 - complement) + radius);
  };
  double sum = 0;
  for (const ChebyshevSeries& panel : growth_.panels()) {
    const double high = std::min(c.complement, panel.high());
    if (!(panel.low() < high)) break;
    sum += gauss_rule(points_)(
        [&](double v) {
          const double s = std::min(1.0, std::hypot(v, radius));
          return slope({s, 1 - s}) / s;
        },
        root(high), root(panel.low()));
  }
  return at_edge_ == 0 ? sum : sum + at_edge_ / std::sqrt((inward + c.complement) * (1 + radius));
}

}  // namespace slipstick::analytic::layered
