#include "analytic/spence.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>

#include "analytic/elliptic.hpp"
#include "analytic/gsl.hpp"
#include "analytic/out_of_range.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;

void require_dissimilar_bodies(double friction, double beta, double least, double most) {
  constexpr double kMaxBeta = 0.5;  // nu = 0 against a rigid body
  require_positive("friction", friction);
  if (!(std::abs(beta) > 0 && std::abs(beta) <= kMaxBeta))
    out_of_range("beta", beta, fmt::format("0 < |beta| <= {}", kMaxBeta));
  const double ratio = friction / std::abs(beta);
  if (!(ratio >= least && ratio <= most))
    out_of_range("friction/|beta|", ratio, fmt::format("{:.6g} to {:.6g}", least, most));
}

/// By x = artanh(c), which holds the digits of both ends.
StickRadius stick_at(double x) { return {.ratio = std::tanh(x), .complement = 2 / (std::exp(2 * x) + 1)}; }

double goodman_artanh(double friction_over_beta) {
  constexpr double kMinLog = -650;  // x is c there, and c above 4 exp(-600)
  constexpr double kMaxK = 1.81;    // above K at c = tanh(1), from where on x/tanh(x) > x
  const double high = std::max(1.0, kMaxK * friction_over_beta);
  const auto excess = [&](double log_x) {
    const double x = std::exp(log_x);
    const double c = std::tanh(x);
    return x / c - friction_over_beta * complete_elliptic(c).k;
  };
  return std::exp(gsl::root(excess, kMinLog, std::log(high)));
}

/// Gauss's rule on a panel, with the polynomials through its nodes.
class GaussPanel {
 public:
  explicit GaussPanel(std::size_t points) : rule_(points) {
    for (const auto& node : rule_.nodes()) {
      double product = 1;
      for (const auto& other : rule_.nodes())
        if (&other != &node) product *= node.fraction - other.fraction;
      barycentric_.push_back(1 / product);
    }
  }

  std::size_t points() const { return rule_.nodes().size(); }
  double fraction(std::size_t node) const { return rule_.nodes()[node].fraction; }
  double weight(std::size_t node) const { return rule_.nodes()[node].weight; }

  /// The slope at `at` of the polynomial that is 1 at `of` and 0 at the other nodes.
  double slope(std::size_t of, std::size_t at) const {
    if (of != at) return barycentric_[of] / barycentric_[at] / (fraction(at) - fraction(of));
    double sum = 0;
    for (std::size_t k = 0; k < points(); ++k)
      if (k != at) sum += 1 / (fraction(at) - fraction(k));
    return sum;
  }

  /// That polynomial itself, at a fraction of the panel that is no node.
  double polynomial(std::size_t of, double fraction_at) const {
    double sum = 0;
    for (std::size_t k = 0; k < points(); ++k) sum += barycentric_[k] / (fraction_at - fraction(k));
    return barycentric_[of] / (fraction_at - fraction(of)) / sum;
  }

 private:
  gsl::GaussRule rule_;
  std::vector<double> barycentric_;
};

/// A radius, with its distances from the singular points.
struct Node {
  double radius;
  double beyond_front;  ///< s - c
  double inside_edge;   ///< 1 - s
  double weight = 0;
  double panel_length = 0;
};

/// Nodes on [0, 1], panels shrinking towards the front from either side and towards the edge.
class Mesh {
 public:
  Mesh(StickRadius stick, const GaussPanel& rule) : stick_(stick), rule_(rule) {
    // g is bounded in the last panels, so that their width does not matter.
    constexpr double kFinestAtFront = 1e-10;
    constexpr double kFinestAtEdge = 1e-10;
    const double slip = stick.complement;
    const double finest = kFinestAtFront * std::min(stick.ratio, slip);
    const auto add_panels = [&](std::vector<double> distances, bool outwards, auto node_at) {
      if (outwards) std::reverse(distances.begin(), distances.end());
      for (std::size_t i = 1; i < distances.size(); ++i) add(distances[i - 1], distances[i], node_at);
    };
    const auto by_front = [&](double sign) {
      return [this, sign](double d) {
        return Node{
            .radius = stick_.ratio + sign * d, .beyond_front = sign * d, .inside_edge = stick_.complement - sign * d};
      };
    };
    add_panels(shrinking(stick.ratio, finest), false, by_front(-1));
    stick_nodes_ = nodes_.size();
    add_panels(shrinking(slip / 2, finest), true, by_front(1));
    add_panels(shrinking(slip / 2, kFinestAtEdge * slip), false, [this](double d) {
      return Node{.radius = 1 - d, .beyond_front = stick_.complement - d, .inside_edge = d};
    });
  }

  const GaussPanel& rule() const { return rule_; }
  std::size_t size() const { return nodes_.size(); }
  /// Earlier ones stick.
  std::size_t stick_nodes() const { return stick_nodes_; }
  const Node& operator[](std::size_t i) const { return nodes_[i]; }
  std::size_t panel_start(std::size_t i) const { return i - i % rule_.points(); }

  /// s_to - s_from.
  double distance(std::size_t from, std::size_t to) const {
    const Node& a = nodes_[from];
    const Node& b = nodes_[to];
    const double half = stick_.complement / 2;
    return a.inside_edge < half && b.inside_edge < half ? a.inside_edge - b.inside_edge
                                                        : b.beyond_front - a.beyond_front;
  }

 private:
  /// Distances from a singular point, from the farthest to 0.
  static std::vector<double> shrinking(double farthest, double finest) {
    constexpr double kShrink = 0.2;
    std::vector<double> distances{farthest};
    while (distances.back() * kShrink > finest) distances.push_back(distances.back() * kShrink);
    distances.push_back(0);
    return distances;
  }

  template <class NodeAt>
  void add(double from, double to, const NodeAt& node_at) {
    for (std::size_t i = 0; i < rule_.points(); ++i) {
      Node node = node_at(std::lerp(from, to, rule_.fraction(i)));
      node.panel_length = std::abs(to - from);
      node.weight = node.panel_length * rule_.weight(i);
      nodes_.push_back(node);
    }
  }

  StickRadius stick_;
  const GaussPanel& rule_;
  std::vector<Node> nodes_;
  std::size_t stick_nodes_ = 0;
};

/// Flat punch, a = 1, with a given stick radius. Pressure and radial traction are, in Hankel's space,
/// integral_0^1 f(s) cos(ks) ds and integral_0^1 g(s) sin(ks) ds. With A for the approach, continued to
/// s < 0 as f even, g odd, and H Hilbert's transform over [-1, 1], (1/pi) PV integral g(t)/(t - s) dt,
///   f = A + beta H g (the surface stays flat); stick: g = -beta H f (no radial displacement);
///   slip: q = mu p, by Abel's equation mu f = g + (2/pi) integral_s^1 g(t) u(s/t)/t dt,
/// u(x) = E(k) - x^2 D(k), k^2 = 1 - x^2. Without f (H H g by Poincare and Bertrand), and for A = 1:
///   stick: (1 - beta^2) g(s) + (beta/pi)^2 integral_{-1}^1 g(t) (l(t) - l(s))/(t - s) dt = beta l(s)/pi,
///   slip: g(s) - mu beta H g(s) + (2/pi) integral_s^1 g(t) u(s/t)/t dt = mu,  l(s) = ln((1 + s)/(1 - s)).
/// Its square-integrable solution goes beyond the front like (s - c)^(-arctan(mu beta)/pi) unless c is the
/// one at which the traction is bounded.
class FrictionalPunch {
 public:
  FrictionalPunch(const Mesh& mesh, double friction, double beta) : mesh_(mesh), friction_(friction), beta_(beta) {
    const auto size = static_cast<Eigen::Index>(mesh.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right_side(size);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const bool sticks = i < mesh.stick_nodes();
      sticks ? write_stick(i, matrix.row(row)) : write_slip(i, matrix.row(row));
      right_side[row] = sticks ? beta_ / pi * logarithm(i) : friction_;
    }
    g_ = matrix.partialPivLu().solve(right_side);
  }

  /// The jump of g at the front.
  double jump() const {
    const auto front = static_cast<Eigen::Index>(mesh_.stick_nodes());
    return g_[front] - g_[front - 1];
  }

  /// integral_0^1 f ds over integral_0^1 A ds.
  double stiffness_ratio() const {
    double sum = 0;
    for (std::size_t i = 0; i < mesh_.size(); ++i)
      sum += mesh_[i].weight * g_[static_cast<Eigen::Index>(i)] * logarithm(i);
    return 1 + beta_ / pi * sum;
  }

 private:
  using Row = Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>>;
  static double& entry(Row& row, std::size_t k) { return row[static_cast<Eigen::Index>(k)]; }

  double logarithm(std::size_t i) const { return std::log((1 + mesh_[i].radius) / mesh_[i].inside_edge); }

  void write_stick(std::size_t i, Row row) const {
    const Node& node = mesh_[i];
    const double share = beta_ * beta_ / (pi * pi);
    for (std::size_t k = 0; k < mesh_.size(); ++k) {
      const double same_side =
          k == i ? 2 / ((1 + node.radius) * node.inside_edge) : (logarithm(k) - logarithm(i)) / mesh_.distance(i, k);
      const double other_side = (logarithm(k) + logarithm(i)) / (mesh_[k].radius + node.radius);
      entry(row, k) = share * mesh_[k].weight * (same_side - other_side);
    }
    entry(row, i) += 1 - beta_ * beta_;
  }

  void write_slip(std::size_t i, Row row) const {
    add_hilbert(i, -friction_ * beta_ / pi, row);
    add_abel(i, row);
    entry(row, i) += 1;
  }

  /// pi H, by (g(t) - g(s))/(t - s), which is smooth on each panel.
  void add_hilbert(std::size_t i, double factor, Row row) const {
    const Node& node = mesh_[i];
    for (std::size_t k = 0; k < mesh_.size(); ++k) {
      entry(row, k) += factor * mesh_[k].weight / (mesh_[k].radius + node.radius);
      if (k == i) continue;
      const double weight = factor * mesh_[k].weight / mesh_.distance(i, k);
      entry(row, k) += weight;
      entry(row, i) -= weight;
    }
    entry(row, i) += factor * std::log(node.inside_edge / node.radius);
    // At t = s it is the slope.
    const std::size_t start = mesh_.panel_start(i);
    for (std::size_t k = 0; k < mesh_.rule().points(); ++k)
      entry(row, start + k) += factor * node.weight / node.panel_length * mesh_.rule().slope(k, i - start);
  }

  static double abel_kernel(double s, double t) {
    const double ratio = std::min(1.0, s / t);
    const CompleteElliptic elliptic = complete_elliptic(ratio);
    return 2 / pi * (elliptic.e - ratio * ratio * elliptic.d) / t;
  }

  void add_abel(std::size_t i, Row row) const {
    const GaussPanel& rule = mesh_.rule();
    const double s = mesh_[i].radius;
    const std::size_t start = mesh_.panel_start(i);
    for (std::size_t k = start + rule.points(); k < mesh_.size(); ++k)
      entry(row, k) += mesh_[k].weight * abel_kernel(s, mesh_[k].radius);
    // The rest of its own panel.
    const double from = rule.fraction(i - start);
    for (std::size_t j = 0; j < rule.points(); ++j) {
      const double at = std::lerp(from, 1, rule.fraction(j));
      const double length = mesh_[i].panel_length;
      const double weight = (1 - from) * length * rule.weight(j) * abel_kernel(s, s + (at - from) * length);
      for (std::size_t k = 0; k < rule.points(); ++k) entry(row, start + k) += weight * rule.polynomial(k, at);
    }
  }

  const Mesh& mesh_;
  double friction_;
  double beta_;
  Eigen::VectorXd g_;
};

/// x = artanh(c) at which the traction is bounded, and how stiff the contact is then.
struct Solution {
  double x;
  double stiffness_ratio;
};

/// By the secant method, from two guesses, x0 the larger, neither too small by much.
Solution solve(double friction, double beta, const GaussPanel& rule, double x0, double x1) {
  constexpr int kMaxSteps = 50;        // about six are usual
  constexpr double kConverged = 1e-8;  // the error left is of the order of a power between 1 and 2 of it
  const auto punch_at = [&](double x) {
    const Mesh mesh(stick_at(x), rule);
    const FrictionalPunch punch(mesh, friction, beta);
    return std::pair(punch.jump(), punch.stiffness_ratio());
  };
  const double highest = 1.1 * x0;
  double before = punch_at(x0).first;
  for (int i = 0; i < kMaxSteps; ++i) {
    const auto [jump, stiffness] = punch_at(x1);
    const double step = -jump * (x1 - x0) / (jump - before);
    if (!std::isfinite(step)) break;
    if (std::abs(step) <= kConverged * x1) return {.x = x1 + step, .stiffness_ratio = stiffness};
    x0 = x1;
    before = jump;
    x1 = std::clamp(x1 + step, x1 / 2, highest);
  }
  throw std::runtime_error(fmt::format("no stick radius found for friction = {}, beta = {}", friction, beta));
}

}  // namespace

StickRadius goodman_stick_radius(double friction, double beta) {
  require_dissimilar_bodies(friction, beta, 1.0 / 600, 200);
  return stick_at(goodman_artanh(friction / std::abs(beta)));
}

FrictionalContact spence_contact(double friction, double beta) {
  require_dissimilar_bodies(friction, beta, 1.0 / 7, 10);
  const double contrast = std::abs(beta);
  static const GaussPanel coarse(10);
  static const GaussPanel fine(13);
  // Goodman's stick radius is too large, and so is the one at which a contact that sticks everywhere has
  // q = mu p.
  constexpr double kNearby = 0.9;
  const double guess =
      std::min(goodman_artanh(friction / contrast), pi / 2 * std::atan(friction) / std::atanh(contrast));
  const Solution first = solve(friction, contrast, coarse, guess, kNearby * guess);
  const Solution second = solve(friction, contrast, fine, first.x * (1 + 1e-5), first.x);
  const double stick = stick_at(second.x).ratio;
  return {.stick_ratio = stick,
          .stick_error = std::abs(stick - stick_at(first.x).ratio),
          .stiffness_ratio = second.stiffness_ratio};
}

}  // namespace slipstick::analytic
