#include "analytic/layered/fredholm.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "analytic/gsl.hpp"
#include "analytic/layered/panel_rule.hpp"

namespace slipstick::analytic::layered {
namespace {

using std::numbers::pi;

/// k h beyond which exp(-2 k h) times the powers of k h before it is below a rounding.
constexpr double kCut = 22;
/// Halvings from there on down; a base of a thousandth of the layer's modulus shows below k h = 1e-3.
constexpr int kHalvings = 26;

double transformed(const std::function<double(double)>& excess, double thickness, double x) {
  constexpr double kPhase = 16;  // radians that one rule of 20 points follows
  double sum = 0;
  double high = kCut / thickness;
  for (int i = 0; i <= kHalvings; ++i) {
    const double low = i == kHalvings ? 0 : high / 2;
    const double pieces = std::ceil(std::max(1.0, (high - low) * x / kPhase));
    const double step = (high - low) / pieces;
    for (double piece = 0; piece < pieces; ++piece) {
      sum += gsl::gauss_legendre([&](double k) { return excess(k) * std::cos(k * x); }, low + piece * step,
                                 low + (piece + 1) * step);
    }
    high = low;
  }
  return sum / pi;
}

}  // namespace

CosineTransform::CosineTransform(const std::function<double(double)>& excess, double thickness, double reach,
                                 double resolution)
    : thickness_(thickness), resolution_(resolution) {
  constexpr double kTerms =
      24;  // singular are x = +-2 i h, +-4 i h, ...: twice a panel's half or farther off
  std::vector<double> ends{0};
  while (!(ends.back() >= reach)) ends.push_back(std::min(reach, std::max(2 * thickness, 2 * ends.back())));
  table_ =
      std::make_shared<const ChebyshevPanels>([&](double x) { return transformed(excess, thickness, x); },
                                              ends, static_cast<std::size_t>(kTerms * resolution));
}

CosineTransform CosineTransform::over(double unit) const {
  CosineTransform result = *this;
  result.unit_ *= unit;
  return result;
}

double kernel(const CosineTransform& transform, Parity parity, double t, double s) {
  const double mirrored = transform(t + s);
  return transform(t - s) + (parity == Parity::even ? mirrored : -mirrored);
}

double Solution::operator()(double t) const {
  double value = right_side(t);
  for (const Node& node : nodes) value -= node.weight * kernel(*transform, parity, t, node.t) * node.value;
  return value;
}

double Solution::integral(const std::function<double(double)>& weight) const {
  double sum = 0;
  for (const Node& node : nodes) sum += node.weight * weight(node.t) * node.value;
  return sum;
}

std::vector<Solution> solve_fredholm(const std::shared_ptr<const CosineTransform>& transform, Parity parity,
                                     double radius,
                                     const std::vector<std::function<double(double)>>& right_sides) {
  const PanelRule rule(transform->thickness() / radius, transform->resolution());
  const auto& nodes = rule.nodes();
  const auto size = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size);
  Eigen::MatrixXd right(size, static_cast<Eigen::Index>(right_sides.size()));
  for (Eigen::Index i = 0; i < size; ++i) {
    const double t = radius * nodes[static_cast<std::size_t>(i)].fraction;
    for (Eigen::Index j = 0; j < size; ++j) {
      const auto& [fraction, weight] = nodes[static_cast<std::size_t>(j)];
      matrix(i, j) += radius * weight * kernel(*transform, parity, t, radius * fraction);
    }
    for (Eigen::Index k = 0; k < right.cols(); ++k) right(i, k) = right_sides[static_cast<std::size_t>(k)](t);
  }
  const Eigen::MatrixXd values = matrix.partialPivLu().solve(right);
  std::vector<Solution> solutions;
  for (Eigen::Index k = 0; k < right.cols(); ++k) {
    Solution solution{right_sides[static_cast<std::size_t>(k)], transform, parity, {}};
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto& [fraction, weight] = nodes[static_cast<std::size_t>(i)];
      solution.nodes.push_back({radius * fraction, radius * weight, values(i, k)});
    }
    solutions.push_back(std::move(solution));
  }
  return solutions;
}

}  // namespace slipstick::analytic::layered
