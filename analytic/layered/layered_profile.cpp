#include "analytic/layered/layered_profile.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "analytic/elliptic.hpp"

namespace slipstick::analytic::layered {
namespace {

using std::numbers::pi;

constexpr StickRadius kFull{.ratio = 1, .complement = 0};

/// Radius below which H(s) is a logarithm and a constant: what is left out goes like s^2 ln s, 1e-12 here.
constexpr double kCentre = 0x1p-22;

double cube(double x) { return x * x * x; }

/// 1 - s at the ends of panels from the edge to kCentre, which at most halve s.
std::vector<double> complement_ends(double thickness) {
  std::vector<double> ends{0};
  for (double s = 1; s > kCentre; ends.push_back(1 - s)) s = std::max({s / 2, s - 3 * thickness, kCentre});
  return ends;
}

std::vector<double> clipped(const std::vector<double>& ends, double low, double high) {
  std::vector<double> result{low};
  for (const double end : ends)
    if (end > low && end < high) result.push_back(end);
  result.push_back(high);
  return result;
}

std::vector<double> squared(std::vector<double> ends) {
  for (double& end : ends) end *= end;
  return ends;
}

/// The pressure, and its H(s) = integral_s^1 p(r)/sqrt(r^2 - s^2) dr.
class PressureIntegrals {
 public:
  PressureIntegrals(const Pressure& pressure, double thickness, Points points)
      : weight_(pressure.weight),
        edge_(pressure.edge),
        thickness_(thickness),
        points_(points),
        // With x^2 = y + (1 - y) t^2 the pressure is sqrt(1 - y) times the integral of w over t.
        ellipse_([&, nodes = gauss_nodes(panel_ends(1, 4 * thickness), points)](
                     double y) { return sum(nodes, [&](double t) { return weight_(y + (1 - y) * t * t); }); },
                 squared(panel_ends(1, 2 * thickness)), points),
        growth_(
            [&](double u) {
              return beyond_edge({1 - u, u}) / u;
            },
            complement_ends(thickness), points),
        growth_slope_(growth_.derivative()) {
    // The load of the punch of radius x is 2 pi x^2 w.
    const auto nodes = gauss_nodes(panel_ends(1, 4 * thickness), points);
    load_ = 2 * pi * (edge_ + sum(nodes, [&](double x) { return x * x * weight_(x * x); }));
    for (const Node& node : rings(0, 1 - kCentre)) limit_ += 8 * node.weight * std::pow(1 - node.x, 2) * node.value;
  }

  double pressure(double radius) const {
    const double root = std::sqrt((1 - radius) * (1 + radius));
    return root * ellipse_(radius * radius) + (edge_ == 0 ? 0 : edge_ / root);
  }
  double load() const { return load_; }           ///< 2 pi integral p r dr
  double moment_limit() const { return limit_; }  ///< 8 integral s^2 H(s) ds
  double edge() const { return pi / 2 * edge_; }  ///< H(1)

  /// H(s) and -H'(s).
  double integral(StickRadius s) const {
    if (s.ratio < kCentre) return integral({kCentre, 1 - kCentre}) + pressure(0) * std::log(kCentre / s.ratio);
    return edge() + s.complement * growth_(s.complement);
  }
  double slope(StickRadius s) const {
    if (s.ratio < kCentre) return pressure(0) / s.ratio;
    return growth_(s.complement) + s.complement * growth_slope_(s.complement);
  }

  /// A rule in 1 - s, with H(s).
  std::vector<Node> rings(double low, double high) const {
    if (!(low < high)) return {};
    std::vector<Node> nodes = gauss_nodes(clipped(growth_.ends(), low, high), points_);
    for (Node& node : nodes) node.value = integral({1 - node.x, node.x});
    return nodes;
  }

  /// integral_c^1 -H'(s)/sqrt(s^2 - r^2) ds + H(1)/sqrt(1 - r^2), r = c - inward: with v = sqrt(s^2 - r^2)
  /// the integrand is -H'(s)/s dv, smooth.
  double punches(StickRadius c, double radius, double inward) const {
    std::vector<double> ends;
    for (const double u : clipped(growth_.ends(), 0, c.complement))
      ends.push_back(std::sqrt((c.complement - u) + inward) * std::sqrt((1 - u) + radius));
    std::reverse(ends.begin(), ends.end());
    const double edge_part = edge_ == 0 ? 0 : edge() / ends.back();
    return edge_part + sum(gauss_nodes(ends, points_), [&](double v) {
             const double s = std::min(1.0, std::hypot(v, radius));
             return slope({s, 1 - s}) / s;
           });
  }

 private:
  /// H(s) - H(1): integral_s^1 w(x^2) K(s/x) dx, K by its complementary modulus, and the edge's K(s) - K(1)
  /// by the slope of K, which keeps the digits of a small 1 - s.
  double beyond_edge(StickRadius s) const {
    std::vector<double> ends{0};  // x - s
    while (ends.back() < s.complement)
      ends.push_back(std::min({s.complement, 2 * ends.back() + s.ratio, ends.back() + 3 * thickness_}));
    const double total = sum(gauss_nodes(ends, points_), [&](double beyond) {
      const double x = s.ratio + beyond;
      return weight_(x * x) * complete_elliptic(std::min(1.0, s.ratio / x)).k;
    });
    if (edge_ == 0) return total;
    const auto depths = gauss_nodes(panel_ends(-std::log1p(-s.complement), 1), points_);
    return total + edge_ * sum(depths, [](double x) {
                     return flat_punch_profile().twist_slope({std::exp(-x), -std::expm1(-x)});
                   });
  }

  PiecewisePolynomial weight_;
  double edge_;
  double thickness_;
  Points points_;
  PiecewisePolynomial ellipse_;  // of r^2: (p - edge term)/sqrt(1 - r^2)
  PiecewisePolynomial growth_;   // of 1 - s: (H(s) - H(1))/(1 - s)
  PiecewisePolynomial growth_slope_;
  double load_ = 0;
  double limit_ = 0;
};

/// A stick radius c: chi = (2/pi) t H(max(t, c)), the half-space's, and within c a correction y = t z(t^2).
/// Lengths over a, pressures over p0, the friction and G are 1.
class Stick {
 public:
  Stick(const PressureIntegrals& pressure, std::shared_ptr<const CosineTransform> torsion, StickRadius c)
      : torsion_(std::move(torsion)),
        c_(c),
        h_(pressure.integral(c)),
        chi_(gauss_nodes(panel_ends(c.ratio, 4 * torsion_->thickness()), torsion_->points())),
        core_size_(chi_.size()),
        ends_(squared(panel_ends(c.ratio, 2 * torsion_->thickness()))) {
    for (Node& node : chi_) node.value = 2 / pi * node.x * h_;
    for (const Node& ring : pressure.rings(0, c.complement))
      chi_.push_back({1 - ring.x, ring.weight, 2 / pi * (1 - ring.x) * ring.value});
    solutions_ = solve_fredholm(*torsion_, &CosineTransform::odd, c.ratio,
                                {[](double t) { return 4 / pi * t; }, [this](double t) { return moved(t); }});
    turn_ = solutions_[1](c.ratio) / solutions_[0](c.ratio);
    stiffness_ = 4 * pi * solutions_[0].moment(1);
    const double extra = turn_ * stiffness_ - 4 * pi * solutions_[1].moment(1);
    // y'(c) = 2 c^2 z'(c^2), since z(c^2) = 0.
    const double y_slope = 2 * ends_.back() * z({*(ends_.end() - 2), ends_.back()}).derivative()(ends_.back());
    twist_slope_ = (2 / pi * c.ratio * pressure.slope(c) + y_slope) / solutions_[0](c.ratio);
    moment_ = extra;
    for (const Node& node : chi_) moment_ += 4 * pi * node.weight * node.x * node.value;
    const double least = std::min(c.ratio, kCentre);
    const double rise = pressure.integral({least, 1 - least}) - h_;
    deficit_ = 8.0 / 3 * cube(least) * (rise + pressure.pressure(0) / 3) - extra;
    for (const Node& node : pressure.rings(c.complement, 1 - kCentre))
      deficit_ += 8 * node.weight * std::pow(1 - node.x, 2) * (node.value - h_);
  }

  double twist() const { return h_ / 2 + turn_; }      ///< G phi/mu
  double twist_slope() const { return twist_slope_; }  ///< -d twist/dc
  double moment() const { return moment_; }
  double deficit() const { return deficit_; }  ///< of the limit moment
  double stiffness() const { return stiffness_; }

  /// The correction's part of q at r < c, -r integral_r^c 2 t z'(t^2)/sqrt(t^2 - r^2) dt.
  double traction(double radius, double inward) const {
    std::call_once(once_, [&] {
      const auto nodes = gauss_nodes(panel_ends(1, 4 * torsion_->thickness() / c_.ratio), torsion_->points());
      const auto front = [&, slope = z(ends_).derivative()](double y) {
        return -2 * sum(nodes, [&](double t) { return slope(y + (ends_.back() - y) * t * t); });
      };
      front_.emplace(front, ends_, torsion_->points());
    });
    return radius * std::sqrt(inward * (c_.ratio + radius)) * (*front_)(radius * radius);
  }

  /// Energy lost in a first loading, pi^2 integral_c^1 chi v dt with v = (4/pi) twist t - chi - K chi.
  double energy_lost() const {
    double total = 0;
    for (std::size_t ring = core_size_; ring < chi_.size(); ++ring) {
      const auto& [t, weight, chi] = chi_[ring];
      double lag = 4 / pi * twist() * t - chi - moved(t);
      for (std::size_t i = 0; i < core_size_; ++i)
        lag -= chi_[i].weight * torsion_->odd(t, chi_[i].x) *
               (turn_ * solutions_[0].nodes[i].value - solutions_[1].nodes[i].value);
      total += weight * chi * lag;
    }
    return pi * pi * total;
  }

 private:
  /// integral_0^1 K(t, s) chi(s) ds of the half-space's chi.
  double moved(double t) const {
    double total = 0;
    for (const Node& node : chi_) total += node.weight * torsion_->odd(t, node.x) * node.value;
    return total;
  }

  PiecewisePolynomial z(const std::vector<double>& ends) const {
    const auto over_t = [&](double square) {
      const double t = std::sqrt(square);
      return (turn_ * solutions_[0](t) - solutions_[1](t)) / t;
    };
    return {over_t, ends, torsion_->points()};
  }

  std::shared_ptr<const CosineTransform> torsion_;
  StickRadius c_;
  double h_;
  std::vector<Node> chi_;            // the half-space's: within c, and beyond
  std::size_t core_size_;            // number of nodes within c, on which the solutions live
  std::vector<double> ends_;         // of panels of t^2
  std::vector<Solution> solutions_;  // for a unit twist, and for the displacement by the half-space's chi
  double turn_ = 0;                  // twist beyond the half-space's
  double twist_slope_ = 0;
  double stiffness_ = 0;
  double moment_ = 0;
  double deficit_ = 0;
  mutable std::once_flag once_;
  mutable std::optional<PiecewisePolynomial> front_;
};

class LayeredProfile final : public Profile {
 public:
  /// full: where the edge begins to slip.
  LayeredProfile(const Pressure& pressure, const PressureIntegrals& integrals,
                 std::shared_ptr<const CosineTransform> torsion, const Stick& full)
      : Profile({.name = pressure.name,
                 .reference_pressure = pressure.unit,
                 .load = integrals.load(),
                 .moment_limit = integrals.moment_limit() / integrals.load(),
                 .edge = 2 * full.twist(),
                 .slip_share = pressure.edge == 0 ? 1 : full.deficit() / integrals.moment_limit()}),
        integrals_(integrals),
        torsion_(std::move(torsion)) {}

  double pressure(double radius) const override { return integrals_.pressure(radius); }
  double twist_integral(StickRadius c) const override { return 2 * stick(c)->twist(); }
  double twist_slope(StickRadius c) const override { return 2 * c.ratio * stick(c)->twist_slope(); }

  MomentShare moment_share(StickRadius c) const override {
    const double deficit = stick(c)->deficit() / integrals_.moment_limit();
    if (deficit < 0.5 * slip_share()) return {.excess = slip_share() - deficit, .deficit = deficit};
    const double excess = stick(c)->moment() / integrals_.moment_limit() - full_stick();
    return {.excess = excess, .deficit = slip_share() - excess};
  }

  double stick_traction(StickRadius c, double radius, double inward) const override {
    return 2 / pi * radius * integrals_.punches(c, radius, inward) + stick(c)->traction(radius, inward);
  }
  double bonded_traction(double radius) const override { return stick_traction(kFull, radius, 1 - radius); }
  double bonded_stiffness(StickRadius c) const override { return stick(c)->stiffness() / cube(c.ratio); }

  std::optional<SlipPart> slip_part(StickRadius c) const override {
    const auto state = stick(c);
    return SlipPart{.twist = (state->twist() - state->moment() / bonded_stiffness(kFull)) / load(),
                    .energy_lost = 4 * state->energy_lost() / (load() * load())};
  }

 private:
  std::shared_ptr<const Stick> stick(StickRadius c) const {
    constexpr std::size_t kMaxKept = 200;  // a search for a load needs ten, which a history's branches use again
    const std::scoped_lock lock(mutex_);
    std::shared_ptr<const Stick>& known = sticks_[{c.ratio, c.complement}];
    if (known) return known;
    const auto made = std::make_shared<const Stick>(integrals_, torsion_, c);
    if (sticks_.size() > kMaxKept) sticks_.clear();
    return sticks_[{c.ratio, c.complement}] = made;
  }

  PressureIntegrals integrals_;
  std::shared_ptr<const CosineTransform> torsion_;
  mutable std::mutex mutex_;
  mutable std::map<std::pair<double, double>, std::shared_ptr<const Stick>> sticks_;
};

}  // namespace

std::unique_ptr<const Profile> layered_profile(const Pressure& pressure, const CosineTransform& torsion) {
  const auto shared = std::make_shared<const CosineTransform>(torsion);
  const PressureIntegrals integrals(pressure, torsion.thickness(), torsion.points());
  return std::make_unique<const LayeredProfile>(pressure, integrals, shared, Stick(integrals, shared, kFull));
}

}  // namespace slipstick::analytic::layered
