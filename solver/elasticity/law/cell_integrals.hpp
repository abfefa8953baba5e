#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Gauss-Legendre quadrature over (-1/2, 1/2).
struct GaussRule {
  std::vector<double> node;
  std::vector<double> weight;
};
GaussRule make_gauss_rule(int points);

/// Integrals over the cell h1 x h2 centred at offset (x, y), rho^2 = x^2 + y^2, from which every component is
/// composed: of x^2/rho^3, y^2/rho^3, x y/rho^3, x/rho^2, y/rho^2.
struct CellIntegrals {
  double xx;
  double yy;
  double xy;
  double x;
  double y;
};

/// Relative error below 1e-13 for offsets up to 8,192 cells; of xx and yy relative to their sum, since far off on an
/// axis one is less than the other by the square of the distance in cells, and every component contains both. By the
/// closed form nearby, and further off, where that cancels, by Gauss-Legendre quadrature, whose terms have one sign.
CellIntegrals cell_integrals(double x, double y, double h1, double h2);

/// Neighbouring cells that are integrated together, to fill vector registers.
constexpr Index kLanes = 4;
using Lanes = Eigen::Array<double, kLanes, 1>;

/// Integrals over a row of cells, kLanes of them in each column.
struct CellRow {
  using Values = Eigen::Array<double, kLanes, Eigen::Dynamic>;
  explicit CellRow(Index cells) : xx(kLanes, (cells + kLanes - 1) / kLanes), yy(xx), xy(xx), x(xx), y(xx) {}
  CellIntegrals operator[](Index k) const {
    return {xx.data()[k], yy.data()[k], xy.data()[k], x.data()[k], y.data()[k]};
  }
  void add(Index k, const CellIntegrals& c) {
    xx.data()[k] += c.xx;
    yy.data()[k] += c.yy;
    xy.data()[k] += c.xy;
    x.data()[k] += c.x;
    y.data()[k] += c.y;
  }

  Values xx, yy, xy, x, y;
};

/// The integrals over the cells of a row from a block of kLanes of them on, cell k at (x, y + k h2).
void integrate_row(CellRow& row, Index first_block, double x, double y, double h1, double h2);

}  // namespace slipstick::solver
