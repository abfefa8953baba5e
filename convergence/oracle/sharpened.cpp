#include "convergence/oracle/errors.hpp"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
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
constexpr std::int8_t kDeepest = 2 * kCut + 1;
using Depths = std::vector<std::int8_t>;
/// Whole cells for the six coefficients of a quadratic.
constexpr int kFewestFitted = 14;

// When a fit makes cut cells better. Set on 280 solves with exact answers, of all laws, on layers and not:
// fits that change more than this made tractions up to 29 times worse, others at most 1.07 times.
constexpr double kUnbalanced = 0.025;   ///< part of its sum over the cut cells by which it changes
constexpr double kUnpredicted = 2.0;    ///< error that it has where it is tried out, over what it changes
constexpr double kNarrowestRing = 3.5;  ///< cells across the slip ring beyond a stick front
constexpr double kFewestTried = 8.0;    ///< cells in which it is tried out

/// Depth of each cell in layers of cells: 1 for a cell of the set at its outline, kDeepest at most; -1 for
/// the first layer outside. Cells beyond the grid count as outside.
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

/// A quadratic's value at a cell, and how much of its points' scatter it has.
struct Fit {
  double value;
  double spread;
};

/// x^a y^b with a + b <= 4, by rising a + b and then b; the first six are the terms of a quadratic.
using Monomials = std::array<double, 15>;
constexpr std::size_t index_of(std::size_t a, std::size_t b) { return (a + b) * (a + b + 1) / 2 + b; }
constexpr int kReachedSide = 2 * kReach + 1;
constexpr std::array<std::array<std::size_t, 2>, 6> kTerms{{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};

/// The monomials of cells by their rows and columns from a cell, kReach at most; zeros beyond that distance.
const std::vector<Monomials>& monomials() {
  static const std::vector<Monomials> table = [] {
    std::vector<Monomials> all;
    for (int cell = 0; cell < kReachedSide * kReachedSide; ++cell) {
      const int row = cell / kReachedSide;
      const int column = cell % kReachedSide;
      const double x = static_cast<double>(row - kReach) / kReach;
      const double y = static_cast<double>(column - kReach) / kReach;
      Monomials& here = all.emplace_back();
      for (std::size_t degree = 0; degree <= 4 && x * x + y * y <= 1.0; ++degree) {
        for (std::size_t b = 0; b <= degree; ++b)
          here[index_of(degree - b, b)] =
              std::pow(x, static_cast<double>(degree - b)) * std::pow(y, static_cast<double>(b));
      }
    }
    return all;
  }();
  return table;
}

/// The quadratic that fits the squares of `roots` best in the cells around a cell that are more than `cut`
/// layers deep. None where they are few, or not all are like() the cell.
template <class Like>
std::optional<Fit> fit_at(const Grid& grid, Index cell, const Depths& depth, int cut, const ArrayXd& roots,
                          const Like& like) {
  Monomials moments{};
  std::array<double, kTerms.size()> sums{};
  const Monomials* const around = monomials().data();
  const Index i = cell / grid.n2;
  const Index j = cell % grid.n2;
  for (Index k = std::max<Index>(0, i - kReach); k <= std::min(grid.n1 - 1, i + kReach); ++k) {
    for (Index l = std::max<Index>(0, j - kReach); l <= std::min(grid.n2 - 1, j + kReach); ++l) {
      const Index other = k * grid.n2 + l;
      const Monomials& at = around[(k - i + kReach) * kReachedSide + l - j + kReach];
      if (at[0] == 0.0) continue;
      if (like(other) != like(cell)) return std::nullopt;
      if (depth[static_cast<std::size_t>(other)] <= cut) continue;
      const double value = roots[other] * roots[other];
      for (std::size_t m = 0; m < at.size(); ++m) moments[m] += at[m];
      for (std::size_t m = 0; m < sums.size(); ++m) sums[m] += at[m] * value;
    }
  }
  if (moments[0] < kFewestFitted) return std::nullopt;
  Eigen::Matrix<double, kTerms.size(), kTerms.size()> squares;
  for (std::size_t r = 0; r < kTerms.size(); ++r) {
    for (std::size_t c = 0; c < kTerms.size(); ++c) {
      squares(static_cast<Index>(r), static_cast<Index>(c)) =
          moments[index_of(kTerms[r][0] + kTerms[c][0], kTerms[r][1] + kTerms[c][1])];
    }
  }
  const Eigen::Vector<double, 6> weights = squares.ldlt().solve(Eigen::Vector<double, 6>::Unit(0));
  return Fit{weights.dot(Eigen::Map<const Eigen::Vector<double, 6>>(sums.data())), std::sqrt(weights[0])};
}

double root(double square) { return std::sqrt(std::max(0.0, square)); }

/// An edge towards which the square of a field falls linearly, and the fits that say how far in its cut cells.
class Edge {
 public:
  /// solved: the field, kept by reference.
  explicit Edge(const ArrayXd& solved) : solved_(solved) {}

  /// A cell within kCut layers of the edge takes the fit to whole cells; every other one as far again within
  /// those tries it out, by whole cells as far from it.
  template <class Like>
  void add(const Grid& grid, Index cell, const Depths& depth, const Like& like) {
    const bool is_cut = depth[static_cast<std::size_t>(cell)] <= kCut;
    if (!is_cut && (cell / grid.n2 + cell % grid.n2) % 2 != 0) return;
    const auto fit = fit_at(grid, cell, depth, is_cut ? kCut : 2 * kCut, solved_, like);
    if (!fit) return;
    if (is_cut) {
      cut_.push_back({cell, *fit, solved_[cell]});
    } else {
      missed_ += std::pow((fit->value - solved_[cell] * solved_[cell]) / fit->spread, 2);
      tried_ += 1.0;
    }
  }

  /// Why the fit may make the cut cells no better; empty where it does, or none is cut. A cell's solved
  /// number is a mean, so that their sum should stay; and the error that the fit has in cells which it can be
  /// compared with should be less than what it changes.
  std::string doubt() const {
    if (cut_.empty()) return "";
    if (!(tried_ >= kFewestTried)) return "too few whole cells to try the fit out";
    const double scatter = std::sqrt(missed_ / tried_);
    double sum = 0.0;
    double more = 0.0;
    double changes = 0.0;
    double errors = 0.0;
    for (const auto& [cell, fit, solved] : cut_) {
      const double sharp = root(fit.value);
      const double off = scatter * fit.spread;
      sum += solved;
      more += sharp - solved;
      changes += std::pow(sharp - solved, 2);
      errors += std::pow(std::max(root(fit.value + off) - sharp, sharp - root(fit.value - off)), 2);
    }
    if (!(std::abs(more) <= kUnbalanced * sum))
      return fmt::format("the fit changes the sum of its cells by {:.2g} %; allowed: {:.2g} %", 100.0 * more / sum,
                         100.0 * kUnbalanced);
    const double unpredicted = std::sqrt(errors / changes);
    if (!(unpredicted <= kUnpredicted))
      return fmt::format("where the fit is tried out it is off by {:.2g} times what it changes; allowed: {:.2g}",
                         unpredicted, kUnpredicted);
    return "";
  }

  /// The roots at the cut cells by the fit, in the order of cells.
  std::optional<double> at(Index cell) const {
    const auto found = std::ranges::lower_bound(cut_, cell, {}, &Cut::cell);
    return found != cut_.end() && found->cell == cell ? std::optional(root(found->fit.value)) : std::nullopt;
  }

  /// All cells stay as they are.
  void keep() { cut_.clear(); }

 private:
  struct Cut {
    Index cell;
    Fit fit;
    double solved;
  };
  const ArrayXd& solved_;
  std::vector<Cut> cut_;
  double missed_ = 0.0;  ///< sum of squares, over the fit's spread
  double tried_ = 0.0;   ///< how many cells
};

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

Sharpened sharpened(const solver::Solution& solution) {
  const Grid& grid = solution.grid;
  const ArrayXd& p = solution.pressure;
  const solver::FrictionLaw& law = solution.friction;
  const auto size = [&](Index cell) {
    return std::hypot(solution.traction[cell], solution.traction[cell + grid.cells()]);
  };
  const Depths contact = depths(grid, [&](Index cell) { return p[cell] > 0.0; });
  const Depths stick = depths(grid, [&](Index cell) { return solution.stick[cell] > 0.0; });
  const auto any = [](Index) { return true; };
  // The bound has a kink where its cap begins.
  const auto capped = [&](Index cell) {
    return law.kind == solver::FrictionKind::capped && law.coefficient * p[cell] > law.shear_strength;
  };
  const bool has_root = falls(p, contact);
  const double ring = solution.resolution.slip_width;
  const bool has_front = !law.factors && ring >= kNarrowestRing;
  Edge edge(p);
  const ArrayXd missing = ArrayXd::NullaryExpr(p.size(), [&](Index cell) { return law.bound(p, cell) - size(cell); });
  Edge front(missing);
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    const auto k = static_cast<std::size_t>(cell);
    // One layer outside carries what the fit leaves over.
    if (has_root && contact[k] >= -1 && contact[k] <= 2 * kCut) edge.add(grid, cell, contact, any);
    // Next to the edge the stick area is as narrow as the slip ring, and neither square is linear.
    if (has_front && contact[k] > kCut + 1 && stick[k] >= -kCut && stick[k] <= 2 * kCut)
      front.add(grid, cell, stick, capped);
  }
  Sharpened found;
  const auto keep = [&](Edge& at, const char* name, const std::string& why) {
    if (why.empty()) return;
    found.kept += fmt::format("{}{}: {}", found.kept.empty() ? "" : "; ", name, why);
    at.keep();
  };
  const std::string narrow = fmt::format("a slip ring of {:.2g} cells; allowed: {:.2g}", ring, kNarrowestRing);
  keep(edge, "contact's edge", has_root ? edge.doubt() : "the pressure does not fall towards it");
  keep(front, "stick front", has_front || ring == 0.0 ? front.doubt() : law.factors ? "on a friction map" : narrow);
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    const auto at_edge = p[cell] > 0.0 ? edge.at(cell) : std::nullopt;
    const auto at_front = front.at(cell);
    if (!at_edge && !at_front) continue;
    const double there = at_edge.value_or(p[cell]);
    const double most = (law.factors ? (*law.factors)[cell] : 1.0) * law.bound(there);
    const double solved = size(cell);
    double sharp = solution.stick[cell] > 0.0 ? std::min(solved, most) : most;
    if (at_front) sharp = std::max(0.0, most - *at_front);
    const double factor = solved > 0.0 ? sharp / solved : 0.0;
    found.cells.push_back(
        {cell, there, {factor * solution.traction[cell], factor * solution.traction[cell + grid.cells()]}});
  }
  return found;
}

}  // namespace slipstick::convergence
