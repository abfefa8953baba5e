#include "convergence/oracle/errors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Grid;
using solver::Index;

constexpr int kCut = 2;    ///< layers of cells along an edge whose means it spoils
constexpr int kReach = 5;  ///< cells from a cut one within which whole ones are fitted
constexpr std::int8_t kDeepest = kCut + 2;
using Depths = std::vector<std::int8_t>;
/// Whole cells for the six coefficients of a quadratic.
constexpr int kFewestFitted = 14;

/// How many layers of cells each cell of a set lies deep in it, 1 at its outline, kDeepest at most; below
/// zero likewise, how deep outside. Nothing of the set lies beyond the grid.
template <class Inside>
Depths depths(const Grid& grid, const Inside& inside) {
  Depths depth(static_cast<std::size_t>(grid.cells()));
  for (Index cell = 0; cell < grid.cells(); ++cell)
    depth[static_cast<std::size_t>(cell)] = inside(cell) ? kDeepest : static_cast<std::int8_t>(-kDeepest);
  std::vector<Index> layer;
  const Depths none(static_cast<std::size_t>(grid.n2), std::int8_t{-1});
  for (Index i = 0; i < grid.n1; ++i) {
    const std::int8_t* const row = depth.data() + i * grid.n2;
    const std::int8_t* const above = i > 0 ? row - grid.n2 : none.data();
    const std::int8_t* const below = i + 1 < grid.n1 ? row + grid.n2 : none.data();
    // How many of three cells above each other are inside; of nine about each cell below.
    const auto of_three = [&](Index j) { return (above[j] > 0) + (row[j] > 0) + (below[j] > 0); };
    int before = 0;
    int here = of_three(0);
    for (Index j = 0; j < grid.n2; ++j) {
      const int after = j + 1 < grid.n2 ? of_three(j + 1) : 0;
      if (before + here + after != (row[j] > 0 ? 9 : 0)) layer.push_back(i * grid.n2 + j);
      before = here;
      here = after;
    }
  }
  const auto set = [&](Index cell, int deep) {
    std::int8_t& here = depth[static_cast<std::size_t>(cell)];
    here = static_cast<std::int8_t>(here > 0 ? deep : -deep);
  };
  for (const Index cell : layer) set(cell, 1);
  for (int deep = 2; deep < kDeepest; ++deep) {
    std::vector<Index> next;
    for (const Index cell : layer) {
      const int untouched = depth[static_cast<std::size_t>(cell)] > 0 ? kDeepest : -kDeepest;
      const Index i = cell / grid.n2;
      const Index j = cell % grid.n2;
      for (Index k = std::max<Index>(0, i - 1); k <= std::min(grid.n1 - 1, i + 1); ++k) {
        for (Index l = std::max<Index>(0, j - 1); l <= std::min(grid.n2 - 1, j + 1); ++l) {
          const Index other = k * grid.n2 + l;
          if (depth[static_cast<std::size_t>(other)] != untouched) continue;
          set(other, deep);
          next.push_back(other);
        }
      }
    }
    layer = std::move(next);
  }
  return depth;
}

/// The square root, at a cell, of the quadratic that fits values() best in the whole cells around it: those
/// more than kCut layers deep. None where they are few, or not all are like() the cell.
template <class Values, class Like>
std::optional<double> root_at(const Grid& grid, Index cell, const Depths& depth, const Values& values,
                              const Like& like) {
  Eigen::Matrix<double, 6, 6> squares = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector<double, 6> sums = Eigen::Vector<double, 6>::Zero();
  int fitted = 0;
  const Index i = cell / grid.n2;
  const Index j = cell % grid.n2;
  for (Index k = std::max<Index>(0, i - kReach); k <= std::min(grid.n1 - 1, i + kReach); ++k) {
    for (Index l = std::max<Index>(0, j - kReach); l <= std::min(grid.n2 - 1, j + kReach); ++l) {
      const Index other = k * grid.n2 + l;
      const double x = static_cast<double>(k - i) / kReach;
      const double y = static_cast<double>(l - j) / kReach;
      if (like(other) != like(cell)) return std::nullopt;
      if (x * x + y * y > 1.0 || depth[static_cast<std::size_t>(other)] <= kCut) continue;
      const Eigen::Vector<double, 6> terms{1.0, x, y, x * x, x * y, y * y};
      squares += terms * terms.transpose();
      sums += terms * values(other);
      ++fitted;
    }
  }
  if (fitted < kFewestFitted) return std::nullopt;
  return std::sqrt(std::max(0.0, squares.ldlt().solve(sums)[0]));
}

/// Whether a pressure falls towards the outline of its contact.
bool falls(const ArrayXd& pressure, const Depths& depth) {
  const Eigen::Map<const Eigen::Array<std::int8_t, Eigen::Dynamic, 1>> layer(depth.data(), pressure.size());
  const auto mean = [&](int of) {
    const auto there = (layer == static_cast<std::int8_t>(of)).cast<double>();
    return (there * pressure).sum() / there.sum();
  };
  return mean(1) < mean(kCut + 1);
}

}  // namespace

std::vector<SharpenedCell> sharpened(const solver::Solution& solution) {
  const Grid& grid = solution.grid;
  const ArrayXd& p = solution.pressure;
  const auto size = [&](Index cell) {
    return std::hypot(solution.traction[cell], solution.traction[cell + grid.cells()]);
  };
  const Depths contact = depths(grid, [&](Index cell) { return p[cell] > 0.0; });
  const Depths stick = depths(grid, [&](Index cell) { return solution.stick[cell] > 0.0; });
  std::vector<SharpenedCell> cells;
  const bool has_root = falls(p, contact);
  const solver::FrictionLaw& law = solution.friction;
  // The bound has a kink where its cap begins.
  const auto capped = [&](Index cell) {
    return law.kind == solver::FrictionKind::capped && law.coefficient * p[cell] > law.shear_strength;
  };
  const auto any = [](Index) { return true; };
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    const auto k = static_cast<std::size_t>(cell);
    const bool at_edge = has_root && contact[k] > 0 && contact[k] <= kCut;
    // Beside the edge the stick area is as narrow as the slip ring, and neither square is linear.
    const bool at_front = contact[k] > kCut + 1 && std::abs(stick[k]) <= kCut && !law.factors;
    if (!(at_edge || at_front)) continue;
    std::optional<double> root;
    if (at_edge)
      root = root_at(
          grid, cell, contact, [&](Index of) { return p[of] * p[of]; }, any);
    const double pressure = root.value_or(p[cell]);
    const double most = (law.factors ? (*law.factors)[cell] : 1.0) * law.bound(pressure);
    const double solved = size(cell);
    double sharp = solution.stick[cell] > 0.0 ? std::min(solved, most) : most;
    if (at_front) {
      const auto missing = root_at(
          grid, cell, stick, [&](Index of) { return std::pow(law.bound(p, of) - size(of), 2); }, capped);
      sharp = missing ? std::max(0.0, most - *missing) : solved;
    }
    const double factor = solved > 0.0 ? sharp / solved : 0.0;
    cells.push_back({cell,
                     pressure,
                     {factor * solution.traction[cell], factor * solution.traction[cell + grid.cells()]}});
  }
  return cells;
}

}  // namespace slipstick::convergence
