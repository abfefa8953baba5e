#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <span>
#include <string>
#include <utility>

#include "solver/grid/sweep.hpp"
#include "solver/newton/coefficients.hpp"

namespace slipstick::solver {

/// What ended an iteration.
enum class CgStatus {
  reduced,     ///< the residual fell as far as asked
  iterations,  ///< it did not within as many as allowed
  indefinite,  ///< no positive curvature along a search direction
  not_finite   ///< the residual's square is not finite, or negative from the start
};

struct CgOptions {
  double reduction;  ///< of the residual, in the norm of the preconditioner
  int max_iterations;
};

struct CgSummary {
  CgStatus status = CgStatus::reduced;
  int iterations = 0;
  double reduction = 1.0;    ///< reached
  double breakdown_at = 0;   ///< the curvature, or the square, that ended an iteration which broke down
  Coefficients multipliers;  ///< of the constraints' conditions: as the residual that is left has them

  bool broke_down() const { return status == CgStatus::indefinite || status == CgStatus::not_finite; }
  /// The breakdown with its number; empty: none.
  std::string message() const;
};

template <typename Real>
using CgField = Eigen::Array<Real, Eigen::Dynamic, 1>;
template <typename Real>
using CgFields = std::span<const CgField<Real>* const>;

/// The system's matrix, symmetric and positive definite where the iteration moves: fields are zero elsewhere,
/// and only these cells of them are written. apply(x, y): y = A x; returns x.y.
template <class Map, typename Real>
concept LinearMap = requires(Map& map, const CgField<Real>& x, CgField<Real>& y) {
  { map.cells() } -> std::convertible_to<const Sweep&>;
  { map.apply(x, y) } -> std::same_as<double>;
};

/// y = M r likewise, in three parts, so that the first and the last share a sweep over the cells with what
/// is done before and after: load(first, last, r, z) for all cells of a z that is zero, transform(z), and
/// store(first, last, r, z, y), where y may be z.
template <class Map, typename Real>
concept SplitMap = requires(Map& map, Index cell, const CgField<Real>& r, CgField<Real>& y) {
  { map.cells() } -> std::convertible_to<const Sweep&>;
  map.load(cell, cell, r, y);
  map.transform(y);
  map.store(cell, cell, r, y, y);
};

/// a.b in the cells [first, last) of `cells`, in all components; products are summed in double precision.
template <typename Real>
double dot(Index cells, Index first, Index last, const CgField<Real>& a, const CgField<Real>& b) {
  double sum = 0.0;
  for (Index start = first; start < a.size(); start += cells) {
    sum += (a.segment(start, last - first).template cast<double>() *
            b.segment(start, last - first).template cast<double>())
               .sum();
  }
  return sum;
}

template <typename Real>
struct CgWorkspace {
  explicit CgWorkspace(Index size) : d(size), Ad(size), y(size) {}
  CgField<Real> d, Ad, y;
};

/// With the conditions' fields, and with the residual.
struct CgProducts {
  double residual = 0.0;
  std::array<double, kMaxConditions> conditions{};

  CgProducts& operator+=(const CgProducts& other) {
    residual += other.residual;
    for (std::size_t k = 0; k < conditions.size(); ++k) conditions[k] += other.conditions[k];
    return *this;
  }
};

/// Conditions c_k.x = 0, or given values, that an iteration keeps throughout: the preconditioned c_k take out
/// of each direction what would violate them (Gould, Hribar and Nocedal 2001). Fields are not owned.
template <typename Real>
class CgConstraints {
 public:
  /// None.
  CgConstraints() = default;
  /// storage: a field for each condition there will be; not owned.
  explicit CgConstraints(std::span<CgField<Real>> storage) : preconditioned_(storage) {}

  /// False if the conditions are not independent where the preconditioner lets fields move; then they must
  /// not be used. z: overwritten.
  template <SplitMap<Real> Preconditioner>
  bool prepare(Preconditioner& preconditioner, CgFields<Real> conditions, CgField<Real>& z) {
    count_ = conditions.size();
    std::ranges::copy(conditions, conditions_.begin());
    const Sweep& cells = preconditioner.cells();
    for (std::size_t k = 0; k < count_; ++k) {
      clear(cells, z);
      cells.each([&](Index first, Index last) { preconditioner.load(first, last, *conditions[k], z); });
      preconditioner.transform(z);
      clear(cells, preconditioned_[k]);
      cells.each([&](Index first, Index last) {
        preconditioner.store(first, last, *conditions[k], z, preconditioned_[k]);
      });
    }
    const CoefficientMatrix products = products_with(cells, conditions, preconditioned());
    factor_.compute(products);
    if (count_ == 0) return true;
    if (!factor_.is_definite()) return false;
    // What is left of each when those before are taken out.
    return ((factor_.diagonal().array().square() / products.diagonal().array()) > kDependent).all();
  }

  /// c_k.w_l
  static CoefficientMatrix products_with(const Sweep& cells, CgFields<Real> conditions,
                                         std::span<const CgField<Real>> w) {
    const auto n = static_cast<Index>(conditions.size());
    CoefficientMatrix products(n, n);
    for (Index l = 0; l < n; ++l) {
      const auto column = cells.sum<CgProducts>([&](Index first, Index last, CgProducts& sum) {
        add_products(cells.size(), first, last, conditions, w[static_cast<std::size_t>(l)], sum);
      });
      for (Index k = 0; k < n; ++k) products(k, l) = column.conditions[static_cast<std::size_t>(k)];
    }
    return products;
  }

  /// sum += c_k.y in some cells
  void add_products(Index cells, Index first, Index last, const CgField<Real>& y, CgProducts& sum) const {
    add_products(cells, first, last, std::span(conditions_).first(count_), y, sum);
  }

  /// Of the conditions' fields, what has to be taken out of a residual whose preconditioned field has these
  /// products with them.
  Coefficients multipliers(const CgProducts& products) const {
    if (count_ == 0) return Coefficients();
    return factor_.solve(Eigen::Map<const Eigen::VectorXd>(products.conditions.data(), count()));
  }

  /// The same of a residual that is not preconditioned.
  Coefficients multipliers(const Sweep& cells, const CgField<Real>& r) const {
    return multipliers(cells.sum<CgProducts>([&](Index first, Index last, CgProducts& sum) {
      for (std::size_t k = 0; k < count_; ++k) {
        sum.conditions[k] += dot(cells.size(), first, last, preconditioned_[k], r);
      }
    }));
  }

  /// Takes it out of r and of the preconditioned y, in some cells.
  void take_out(Index cells, Index first, Index last, const Coefficients& multipliers, CgField<Real>& r,
                CgField<Real>& y) const {
    const Index n = last - first;
    for (Index k = 0; k < count(); ++k) {
      const auto multiplier = static_cast<Real>(multipliers[k]);
      const auto at = static_cast<std::size_t>(k);
      for (Index start = first; start < y.size(); start += cells) {
        y.segment(start, n) -= multiplier * preconditioned_[at].segment(start, n);
        r.segment(start, n) -= multiplier * conditions_[at]->segment(start, n);
      }
    }
  }

  /// x += the combination of preconditioned conditions with these values of c_k.x.
  void add_with_values(const Sweep& cells, const Coefficients& values, CgField<Real>& x) const {
    const Coefficients parts = factor_.solve(values);
    cells.each([&](Index first, Index last) {
      for (Index k = 0; k < parts.size(); ++k) {
        const auto& w = preconditioned_[static_cast<std::size_t>(k)];
        for (Index start = first; start < x.size(); start += cells.size()) {
          x.segment(start, last - first) += static_cast<Real>(parts[k]) * w.segment(start, last - first);
        }
      }
    });
  }

  /// Each condition preconditioned.
  std::span<const CgField<Real>> preconditioned() const { return preconditioned_.first(count_); }

 private:
  /// Conditions that depend on each other: one stick cell can be turned and pushed, but not told which.
  static constexpr double kDependent = 1e-12;

  Index count() const { return static_cast<Index>(count_); }
  static void add_products(Index cells, Index first, Index last, CgFields<Real> conditions,
                           const CgField<Real>& y, CgProducts& sum) {
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      sum.conditions[k] += dot(cells, first, last, *conditions[k], y);
    }
  }

  std::array<const CgField<Real>*, kMaxConditions> conditions_{};
  std::size_t count_ = 0;
  std::span<CgField<Real>> preconditioned_;
  SmallCholesky factor_;
};

/// Preconditioned conjugate gradients for A x = r - sum of multiplier_k c_k with the constraints' c_k.x as x
/// has them at the start. r: the residual of x, its start; overwritten by what is left. Stops when r has
/// fallen by `reduction`. The multipliers that are found go up with each iteration's residual: they are wrong
/// by its part that the preconditioner and the exact inverse see differently. Each iteration applies both
/// maps once and sweeps over the cells four times, twice of them within the maps. Allocates nothing.
template <typename Real, LinearMap<Real> Map, SplitMap<Real> Preconditioner>
CgSummary projected_cg(Map& map, Preconditioner& preconditioner, const CgConstraints<Real>& constraints,
                       CgField<Real>& r, const CgOptions& options, CgWorkspace<Real>& work,
                       CgField<Real>& x) {
  CgField<Real>& d = work.d;
  CgField<Real>& Ad = work.Ad;
  CgField<Real>& y = work.y;
  const Sweep& cells = map.cells();
  CgSummary summary;
  summary.multipliers = constraints.multipliers(CgProducts{});
  Coefficients multipliers;
  // y = r preconditioned; r.y once both are within the constraints.
  const auto precondition = [&] {
    preconditioner.transform(y);
    const auto products = cells.sum<CgProducts>([&](Index first, Index last, CgProducts& sum) {
      preconditioner.store(first, last, r, y, y);
      sum.residual += dot(cells.size(), first, last, r, y);
      constraints.add_products(cells.size(), first, last, y, sum);
    });
    multipliers = constraints.multipliers(products);
    double square = products.residual;
    for (Index k = 0; k < multipliers.size(); ++k) {
      square -= multipliers[k] * products.conditions[static_cast<std::size_t>(k)];
    }
    summary.multipliers += multipliers;
    return square;
  };
  // r and y within the constraints; the next direction.
  const auto turn = [&](Real kept) {
    cells.each([&](Index first, Index last) {
      constraints.take_out(cells.size(), first, last, multipliers, r, y);
      for (Index start = first; start < d.size(); start += cells.size()) {
        auto part = d.segment(start, last - first);
        part = y.segment(start, last - first) + kept * part;
      }
    });
  };

  clear(cells, y);
  cells.each([&](Index first, Index last) { preconditioner.load(first, last, r, y); });
  double square = precondition();
  const double first_square = square;
  clear(cells, d);
  turn(0);
  while (square > 0.0) {
    if (summary.iterations == options.max_iterations) {
      summary.status = CgStatus::iterations;
      break;
    }
    ++summary.iterations;
    const double curvature = map.apply(d, Ad);
    if (!(curvature > 0.0)) {
      summary.status = CgStatus::indefinite;
      summary.breakdown_at = curvature;
      return summary;
    }
    const auto step = static_cast<Real>(square / curvature);
    clear(cells, y);
    cells.each([&](Index first, Index last) {
      for (Index start = first; start < x.size(); start += cells.size()) {
        x.segment(start, last - first) += step * d.segment(start, last - first);
        r.segment(start, last - first) -= step * Ad.segment(start, last - first);
      }
      preconditioner.load(first, last, r, y);
    });
    // What is left of a residual that is not asked for is not measured.
    if (options.reduction == 0.0 && summary.iterations == options.max_iterations) {
      summary.multipliers += constraints.multipliers(cells, r);
      summary.status = CgStatus::iterations;
      break;
    }
    const double last = std::exchange(square, precondition());
    turn(static_cast<Real>(square / last));
    if (!(square > options.reduction * options.reduction * first_square)) break;
  }
  // Below zero only by rounding, once converged.
  if (!std::isfinite(square) || first_square < 0.0) {
    summary.status = CgStatus::not_finite;
    summary.breakdown_at = first_square < 0.0 ? first_square : square;
  }
  summary.reduction = first_square > 0.0 ? std::sqrt(std::max(square, 0.0) / first_square) : 0.0;
  return summary;
}

}  // namespace slipstick::solver
