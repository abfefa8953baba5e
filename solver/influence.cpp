#include "solver/influence.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace slipstick::solver {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Up to this many cells off, the closed form is used: it has lost at most a few eps there.
constexpr double kClosedFormOffset = 2.5;
constexpr int kMaxPoints = 10;

struct GaussRule {
  std::vector<double> node;  // in (-1/2, 1/2)
  std::vector<double> weight;
};

GaussRule make_gauss_rule(int points) {
  const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
      gsl_integration_glfixed_table_alloc(static_cast<std::size_t>(points)),
      gsl_integration_glfixed_table_free);
  GaussRule rule;
  for (int i = 0; i < points; ++i) {
    double node = 0.0;
    double weight = 0.0;
    gsl_integration_glfixed_point(-0.5, 0.5, static_cast<std::size_t>(i), &node, &weight, table.get());
    rule.node.push_back(node);
    rule.weight.push_back(weight);
  }
  return rule;
}

/// On a cell `offset` cells away the integrand is analytic inside a Bernstein ellipse whose half-axes sum to
/// about 4 offset - 2, so n points leave (4 offset - 2)^(-2n). (Trefethen, SIAM Review 50, 2008,
/// theorem 4.5.)
const GaussRule& gauss_rule(double offset) {
  static const std::array<GaussRule, kMaxPoints + 1> rules = [] {
    std::array<GaussRule, kMaxPoints + 1> made;
    for (int n = 1; n <= kMaxPoints; ++n) made[static_cast<std::size_t>(n)] = make_gauss_rule(n);
    return made;
  }();
  const double points = std::ceil(18.0 / (2.0 * std::log10(4.0 * offset - 2.0)));
  return rules[static_cast<std::size_t>(std::clamp(points, 2.0, static_cast<double>(kMaxPoints)))];
}

/// F(++) - F(-+) - F(+-) + F(--) over the cell's corners.
template <typename Function>
double corner_difference(const Function& f, double x, double y, double h1, double h2) {
  const double left = x - 0.5 * h1;
  const double right = x + 0.5 * h1;
  const double low = y - 0.5 * h2;
  const double high = y + 0.5 * h2;
  return (f(right, high) - f(left, high)) - (f(right, low) - f(left, low));
}

double y_asinh(double x, double y) { return y == 0.0 ? 0.0 : y * std::asinh(x / std::abs(y)); }

double log_arctan(double x, double y) {
  const double logarithm = y == 0.0 ? 0.0 : 0.5 * y * std::log(x * x + y * y);
  const double arctan = x == 0.0 ? 0.0 : x * std::atan(y / x);
  return logarithm + arctan;
}

CellIntegrals closed_form(double x, double y, double h1, double h2) {
  const auto exchanged = [](const auto& f) { return [&f](double u, double v) { return f(v, u); }; };
  return {
      .xx = corner_difference(y_asinh, x, y, h1, h2),
      .yy = corner_difference(exchanged(y_asinh), x, y, h1, h2),
      .xy = corner_difference([](double u, double v) { return -std::hypot(u, v); }, x, y, h1, h2),
      .x = corner_difference(log_arctan, x, y, h1, h2),
      .y = corner_difference(exchanged(log_arctan), x, y, h1, h2),
  };
}

CellIntegrals by_quadrature(double x, double y, double h1, double h2, const GaussRule& rule) {
  CellIntegrals sum{};
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double u = x + h1 * rule.node[i];
    for (std::size_t j = 0; j < rule.node.size(); ++j) {
      const double v = y + h2 * rule.node[j];
      const double inverse_square = 1.0 / (u * u + v * v);
      const double weight = rule.weight[i] * rule.weight[j] * inverse_square;
      const double over_rho = weight * std::sqrt(inverse_square);
      sum.xx += over_rho * u * u;
      sum.yy += over_rho * v * v;
      sum.xy += over_rho * u * v;
      sum.x += weight * u;
      sum.y += weight * v;
    }
  }
  const double area = h1 * h2;
  return {sum.xx * area, sum.yy * area, sum.xy * area, sum.x * area, sum.y * area};
}

}  // namespace

ElasticPair elastic_pair(const HalfSpace& lower, const HalfSpace& upper) {
  const double lower_compliance = 1.0 / lower.shear_modulus;
  const double upper_compliance = 1.0 / upper.shear_modulus;
  return {
      .shear_compliance = lower_compliance + upper_compliance,
      .poisson_compliance = lower.poisson_ratio * lower_compliance + upper.poisson_ratio * upper_compliance,
      .normal_compliance =
          (1.0 - lower.poisson_ratio) * lower_compliance + (1.0 - upper.poisson_ratio) * upper_compliance,
      .mismatch = (1.0 - 2.0 * lower.poisson_ratio) * lower_compliance -
                  (1.0 - 2.0 * upper.poisson_ratio) * upper_compliance,
  };
}

Parity parity(Component component) {
  switch (component) {
    case Component::k12:
      return {-1, -1};
    case Component::k13:
      return {-1, 1};
    case Component::k23:
      return {1, -1};
    case Component::k11:
    case Component::k22:
    case Component::k33:
      return {1, 1};
  }
  throw std::logic_error("unknown component");
}

CellIntegrals cell_integrals(double x, double y, double h1, double h2) {
  // An elongated cell is cut into nearly square parts, so that "near" means the same along both sides.
  const int parts1 = std::max(1, static_cast<int>(std::lround(h1 / h2)));
  const int parts2 = std::max(1, static_cast<int>(std::lround(h2 / h1)));
  const double part_h1 = h1 / parts1;
  const double part_h2 = h2 / parts2;
  CellIntegrals sum{};
  for (int i = 0; i < parts1; ++i) {
    for (int j = 0; j < parts2; ++j) {
      const double part_x = x + (i - 0.5 * (parts1 - 1)) * part_h1;
      const double part_y = y + (j - 0.5 * (parts2 - 1)) * part_h2;
      const double offset = std::max(std::abs(part_x) / part_h1, std::abs(part_y) / part_h2);
      const CellIntegrals part = offset < kClosedFormOffset
                                     ? closed_form(part_x, part_y, part_h1, part_h2)
                                     : by_quadrature(part_x, part_y, part_h1, part_h2, gauss_rule(offset));
      sum.xx += part.xx;
      sum.yy += part.yy;
      sum.xy += part.xy;
      sum.x += part.x;
      sum.y += part.y;
    }
  }
  if (x == 0.0) sum.xy = sum.x = 0.0;  // odd: exactly zero on the axis
  if (y == 0.0) sum.xy = sum.y = 0.0;
  return sum;
}

std::vector<double> influence_coefficients(Component component, const ElasticPair& pair, double h1, double h2,
                                           Index m1, Index m2) {
  const double shear = pair.shear_compliance / kTwoPi;
  const double poisson = pair.poisson_compliance / kTwoPi;
  const double normal = pair.normal_compliance / kTwoPi;
  const double mismatch = pair.mismatch / (2.0 * kTwoPi);
  const auto compose = [&](const CellIntegrals& c) {
    switch (component) {
      case Component::k11:
        return shear * c.xx + (shear - poisson) * c.yy;
      case Component::k12:
        return poisson * c.xy;
      case Component::k22:
        return shear * c.yy + (shear - poisson) * c.xx;
      case Component::k13:
        return -mismatch * c.x;
      case Component::k23:
        return -mismatch * c.y;
      case Component::k33:
        return normal * (c.xx + c.yy);
    }
    throw std::logic_error("unknown component");
  };
  std::vector<double> coefficients(static_cast<std::size_t>(m1 * m2));
  for (Index k1 = 0; k1 < m1; ++k1) {
    for (Index k2 = 0; k2 < m2; ++k2) {
      coefficients[static_cast<std::size_t>(k1 * m2 + k2)] =
          compose(cell_integrals(static_cast<double>(k1) * h1, static_cast<double>(k2) * h2, h1, h2));
    }
  }
  return coefficients;
}

}  // namespace slipstick::solver
