#include "solver/elasticity/law/cell_integrals.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace slipstick::solver {
namespace {

/// Up to this many cells off, the closed form is used: it has lost at most a few eps there.
constexpr double kClosedFormOffset = 2.5;
constexpr int kMaxPoints = 10;

/// On a cell `offset` cells away the integrand is analytic inside a Bernstein ellipse whose half-axes sum to
/// about 4 offset - 2, so n points leave (4 offset - 2)^(-2n). (Trefethen, SIAM Review 50, 2008,
/// theorem 4.5.) The rule of fewest points that leaves 1e-16.
const GaussRule& gauss_rule(double offset) {
  struct Choice {
    double reach;  ///< the least offset
    GaussRule rule;
  };
  static const std::vector<Choice> choices = [] {
    std::vector<Choice> made;
    for (int n = 2; n < kMaxPoints; ++n) made.push_back({0.25 * (std::pow(10.0, 8.0 / n) + 2.0), make_gauss_rule(n)});
    made.push_back({0.0, make_gauss_rule(kMaxPoints)});
    return made;
  }();
  return std::find_if(choices.begin(), choices.end(), [&](const Choice& c) { return offset >= c.reach; })->rule;
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

/// Adds the integrals over kLanes cells at (x, y), in the `wanted` lanes only.
void add_quadrature(CellRow& row, Index block, double x, const Lanes& y, const Lanes& wanted, double h1, double h2,
                    const GaussRule& rule) {
  Lanes xx = Lanes::Zero();
  Lanes yy = xx, xy = xx, x_sum = xx, y_sum = xx;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double u = x + h1 * rule.node[i];
    for (std::size_t j = 0; j < rule.node.size(); ++j) {
      const Lanes v = y + h2 * rule.node[j];
      const Lanes inverse_square = (u * u + v.square()).inverse();
      const Lanes over_square = rule.weight[i] * rule.weight[j] * inverse_square;
      const Lanes over_cube = over_square * inverse_square.sqrt();
      xx += over_cube * (u * u);
      yy += over_cube * v.square();
      xy += over_cube * v * u;
      x_sum += over_square * u;
      y_sum += over_square * v;
    }
  }
  const Lanes area = h1 * h2 * wanted;
  row.xx.col(block) += area * xx;
  row.yy.col(block) += area * yy;
  row.xy.col(block) += area * xy;
  row.x.col(block) += area * x_sum;
  row.y.col(block) += area * y_sum;
}

/// Adds the integrals over the blocks of cells from the first one on; cell k is at (x, y + k step).
void add_cells(CellRow& row, Index first_block, double x, double y, double step, double h1, double h2) {
  for (Index block = first_block; block < row.xx.cols(); ++block) {
    const Lanes ys =
        y + step * Lanes::LinSpaced(static_cast<double>(block * kLanes), static_cast<double>((block + 1) * kLanes - 1));
    const Lanes offset = (ys.abs() / h2).max(std::abs(x) / h1);
    const Lanes far = (offset >= kClosedFormOffset).cast<double>();
    for (Index lane = 0; lane < kLanes; ++lane) {
      if (far[lane] == 0.0) row.add(block * kLanes + lane, closed_form(x, ys[lane], h1, h2));
    }
    if ((far == 0.0).all()) continue;
    // Near lanes, where quadrature would be poor or divide by zero, are moved off and not added.
    const Lanes moved = (far != 0.0).select(ys, kClosedFormOffset * h2);
    add_quadrature(row, block, x, moved, far, h1, h2, gauss_rule(std::max(offset.minCoeff(), kClosedFormOffset)));
  }
}

}  // namespace

GaussRule make_gauss_rule(int points) {
  const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
      gsl_integration_glfixed_table_alloc(static_cast<std::size_t>(points)), gsl_integration_glfixed_table_free);
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

void integrate_row(CellRow& row, Index first_block, double x, double y, double h1, double h2) {
  // An elongated cell is cut into nearly square parts, so that "near" means the same along both sides.
  const int parts1 = std::max(1, static_cast<int>(std::lround(h1 / h2)));
  const int parts2 = std::max(1, static_cast<int>(std::lround(h2 / h1)));
  const double part_h1 = h1 / parts1;
  const double part_h2 = h2 / parts2;
  for (CellRow::Values* const values : {&row.xx, &row.yy, &row.xy, &row.x, &row.y}) values->setZero();
  for (int i = 0; i < parts1; ++i) {
    for (int j = 0; j < parts2; ++j) {
      add_cells(row, first_block, x + (i - 0.5 * (parts1 - 1)) * part_h1, y + (j - 0.5 * (parts2 - 1)) * part_h2, h2,
                part_h1, part_h2);
    }
  }
  // Odd: exactly zero on the axes. A row can start on the other one only.
  if (x == 0.0) {
    row.xy.setZero();
    row.x.setZero();
  }
  if (y == 0.0) row.xy(0, 0) = row.y(0, 0) = 0.0;
}

CellIntegrals cell_integrals(double x, double y, double h1, double h2) {
  CellRow row(1);
  integrate_row(row, 0, x, y, h1, h2);
  return row[0];
}

}  // namespace slipstick::solver
