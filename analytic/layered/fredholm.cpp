#include "analytic/layered/fredholm.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "analytic/gsl.hpp"

namespace slipstick::analytic::layered {
namespace {

using std::numbers::pi;

double transformed(const RealFunction& excess, double thickness, double x) {
  constexpr double kCut = 22;    // k h beyond which exp(-2 k h), times powers, is below a rounding
  constexpr int kHalvings = 26;  // from there down to k h = 3e-7
  constexpr double kPhase = 16;  // radians that one rule of 20 points follows
  double total = 0;
  double high = kCut / thickness;
  for (int i = 0; i <= kHalvings; ++i) {
    const double low = i == kHalvings ? 0 : high / 2;
    const auto part = [&](double k) { return excess(k) * std::cos(k * x); };
    const std::vector<double> ends = panel_ends(high - low, x > 0 ? kPhase / x : high);
    for (std::size_t piece = 1; piece < ends.size(); ++piece)
      total += gsl::gauss_legendre(part, low + ends[piece - 1], low + ends[piece]);
    high = low;
  }
  return total / pi;
}

/// Singular are x = +-2 i h, +-4 i h, ...: at least twice a panel's half away from its middle.
std::vector<double> doubling_ends(double thickness, double reach) {
  std::vector<double> ends{0};
  while (ends.back() < reach) ends.push_back(std::min(reach, std::max(2 * thickness, 2 * ends.back())));
  return ends;
}

}  // namespace

std::vector<double> panel_ends(double length, double longest) {
  const auto panels = static_cast<int>(std::ceil(length / longest));
  std::vector<double> ends{0};
  for (int i = 1; i <= panels; ++i) ends.push_back(length * i / panels);
  return ends;
}

std::vector<Node> gauss_nodes(const std::vector<double>& ends, Points points) {
  static const gsl::GaussRule fine(20);
  static const gsl::GaussRule coarse(18);
  std::vector<Node> nodes;
  for (std::size_t i = 1; i < ends.size(); ++i)
    for (const auto& [fraction, weight] : (points == Points::fewer ? coarse : fine).nodes())
      nodes.push_back({std::lerp(ends[i - 1], ends[i], fraction), (ends[i] - ends[i - 1]) * weight});
  return nodes;
}

PiecewisePolynomial::PiecewisePolynomial(const RealFunction& f, std::vector<double> ends, Points points)
    : ends_(std::move(ends)) {
  const std::size_t n = points == Points::fewer ? 22 : 24;
  std::vector<double> values(n);
  for (std::size_t i = 1; i < ends_.size(); ++i) {
    const auto angle = [&](std::size_t j) { return pi * (static_cast<double>(j) + 0.5) / static_cast<double>(n); };
    // cos^2 of half the angle keeps the digits of small distances from the lower end.
    for (std::size_t j = 0; j < n; ++j)
      values[j] = f(ends_[i - 1] + (ends_[i] - ends_[i - 1]) * std::pow(std::cos(angle(j) / 2), 2));
    std::vector<double>& terms = coefficients_.emplace_back(n, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t j = 0; j < n; ++j) terms[k] += values[j] * std::cos(static_cast<double>(k) * angle(j));
      terms[k] *= (k == 0 ? 1.0 : 2.0) / static_cast<double>(n);
    }
  }
}

/// Clenshaw's recurrence.
double PiecewisePolynomial::operator()(double x) const {
  const auto above = std::upper_bound(ends_.begin() + 1, ends_.end() - 1, x);
  const auto& terms = coefficients_[static_cast<std::size_t>(above - ends_.begin()) - 1];
  const double low = *(above - 1);
  const double high = *above;
  const double y = 2 * ((x - low) - (high - x)) / (high - low);
  double next = 0;
  double total = 0;
  for (std::size_t k = terms.size(); k-- > 1;) next = std::exchange(total, terms[k] + y * total - next);
  return terms[0] + y / 2 * total - next;
}

PiecewisePolynomial PiecewisePolynomial::derivative() const {
  PiecewisePolynomial result = *this;
  for (std::size_t i = 0; i < coefficients_.size(); ++i) {
    const auto& terms = coefficients_[i];
    auto& slopes = result.coefficients_[i];
    slopes.assign(terms.size() + 1, 0.0);
    for (std::size_t k = terms.size() - 1; k > 0; --k)
      slopes[k - 1] = slopes[k + 1] + 4 * static_cast<double>(k) * terms[k] / (ends_[i + 1] - ends_[i]);
    slopes[0] /= 2;
  }
  return result;
}

CosineTransform::CosineTransform(const RealFunction& excess, double thickness, double reach, double unit, Points points)
    : thickness_(thickness / unit),
      points_(points),
      unit_(unit),
      table_([&](double x) { return transformed(excess, thickness, x); }, doubling_ends(thickness, reach), points) {}

double Solution::operator()(double t) const {
  double value = right_side(t);
  for (const Node& node : nodes) value -= node.weight * (transform->*kernel)(t, node.x) * node.value;
  return value;
}

double Solution::moment(int power) const {
  double total = 0;
  for (const Node& node : nodes) total += node.weight * std::pow(node.x, power) * node.value;
  return total;
}

std::vector<Solution> solve_fredholm(const CosineTransform& transform, Kernel kernel, double radius,
                                     const std::vector<RealFunction>& right_sides) {
  const std::vector<Node> nodes = gauss_nodes(panel_ends(radius, 4 * transform.thickness()), transform.points());
  const auto size = static_cast<Eigen::Index>(nodes.size());
  const auto node = [&](Eigen::Index i) { return nodes[static_cast<std::size_t>(i)]; };
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j) matrix(i, j) += node(j).weight * (transform.*kernel)(node(i).x, node(j).x);
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(matrix);
  std::vector<Solution> solutions;
  for (const auto& right_side : right_sides) {
    Solution& solution = solutions.emplace_back(Solution{right_side, &transform, kernel, nodes});
    Eigen::VectorXd values(size);
    for (Eigen::Index i = 0; i < size; ++i) values[i] = right_side(node(i).x);
    values = factors.solve(values).eval();
    for (Eigen::Index i = 0; i < size; ++i) solution.nodes[static_cast<std::size_t>(i)].value = values[i];
  }
  return solutions;
}

}  // namespace slipstick::analytic::layered
