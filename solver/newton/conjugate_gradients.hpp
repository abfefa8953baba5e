#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>

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
  double reduction = 1.0;   ///< reached
  double breakdown_at = 0;  ///< the curvature, or the square, that ended an iteration which broke down

  bool broke_down() const { return status == CgStatus::indefinite || status == CgStatus::not_finite; }
  /// The breakdown with its number; empty: none.
  std::string message() const;
};

template <typename Real>
using CgField = Eigen::Array<Real, Eigen::Dynamic, 1>;
template <typename Real>
using CgFields = std::span<const CgField<Real>* const>;

/// y = A x: the system's matrix, or its preconditioner, symmetric and positive definite where the iteration
/// moves. Does not change x.
template <class Map, typename Real>
concept LinearMap = requires(Map& map, const CgField<Real>& x, CgField<Real>& y) {
  map.apply(x, y);
};

/// Products are summed in double precision.
template <typename Real>
double dot(const CgField<Real>& a, const CgField<Real>& b) {
  return (a.template cast<double>() * b.template cast<double>()).sum();
}

template <typename Real>
struct CgWorkspace {
  explicit CgWorkspace(Index size) : d(size), Ad(size), y(size) {}
  CgField<Real> d, Ad, y;
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
  /// not be used.
  template <LinearMap<Real> Preconditioner>
  bool prepare(Preconditioner& preconditioner, CgFields<Real> conditions) {
    count_ = conditions.size();
    std::ranges::copy(conditions, conditions_.begin());
    const auto n = static_cast<Index>(conditions.size());
    for (std::size_t k = 0; k < conditions.size(); ++k)
      preconditioner.apply(*conditions[k], preconditioned_[k]);
    const CoefficientMatrix products = products_with(conditions, preconditioned_.first(conditions.size()));
    factor_.compute(products);
    if (n == 0) return true;
    if (!factor_.is_definite()) return false;
    // What is left of each when those before are taken out.
    return ((factor_.diagonal().array().square() / products.diagonal().array()) > kDependent).all();
  }

  /// c_k.w_l
  static CoefficientMatrix products_with(CgFields<Real> conditions, std::span<const CgField<Real>> w) {
    const auto n = static_cast<Index>(conditions.size());
    CoefficientMatrix products(n, n);
    for (Index k = 0; k < n; ++k) {
      for (Index l = 0; l < n; ++l) {
        products(k, l) = dot(*conditions[static_cast<std::size_t>(k)], w[static_cast<std::size_t>(l)]);
      }
    }
    return products;
  }

  /// Takes out of y, the preconditioned r, and of r what violates the conditions. r.y: before and after.
  double project(CgField<Real>& r, CgField<Real>& y, double square) const {
    const auto n = static_cast<Index>(count_);
    if (n == 0) return square;
    Coefficients products(n);
    for (Index k = 0; k < n; ++k) products[k] = dot(*conditions_[static_cast<std::size_t>(k)], y);
    const Coefficients multipliers = factor_.solve(products);
    for (Index k = 0; k < n; ++k) {
      const auto multiplier = static_cast<Real>(multipliers[k]);
      y -= multiplier * preconditioned_[static_cast<std::size_t>(k)];
      r -= multiplier * *conditions_[static_cast<std::size_t>(k)];
    }
    return square - multipliers.dot(products);
  }

  /// x += the combination of preconditioned conditions with these values of c_k.x.
  void add_with_values(const Coefficients& values, CgField<Real>& x) const {
    const Coefficients parts = factor_.solve(values);
    for (Index k = 0; k < parts.size(); ++k) {
      x += static_cast<Real>(parts[k]) * preconditioned_[static_cast<std::size_t>(k)];
    }
  }

  /// Each condition preconditioned.
  std::span<const CgField<Real>> preconditioned() const { return preconditioned_.first(count_); }

 private:
  /// Conditions that depend on each other: one stick cell can be turned and pushed, but not told which.
  static constexpr double kDependent = 1e-12;

  std::array<const CgField<Real>*, kMaxConditions> conditions_{};
  std::size_t count_ = 0;
  std::span<CgField<Real>> preconditioned_;
  SmallCholesky factor_;
};

/// Preconditioned conjugate gradients for A x = r + sum of multiplier_k c_k with the constraints' c_k.x as x
/// has them at the start. r: the residual of x, its start; overwritten by what is left. Stops when r has
/// fallen by `reduction`. Allocates nothing.
template <typename Real, LinearMap<Real> Map, LinearMap<Real> Preconditioner>
CgSummary projected_cg(Map& map, Preconditioner& preconditioner, const CgConstraints<Real>& constraints,
                       CgField<Real>& r, const CgOptions& options, CgWorkspace<Real>& work,
                       CgField<Real>& x) {
  CgField<Real>& d = work.d;
  CgField<Real>& Ad = work.Ad;
  CgField<Real>& y = work.y;
  CgSummary summary;
  // y = r preconditioned and within the constraints; r.y.
  const auto precondition = [&] {
    preconditioner.apply(r, y);
    return constraints.project(r, y, dot(r, y));
  };
  double square = precondition();
  const double first = square;
  if (square > 0.0) d = y;
  while (square > 0.0) {
    ++summary.iterations;
    map.apply(d, Ad);
    const double curvature = dot(d, Ad);
    if (!(curvature > 0.0)) {
      summary.status = CgStatus::indefinite;
      summary.breakdown_at = curvature;
      return summary;
    }
    const auto step = static_cast<Real>(square / curvature);
    x += step * d;
    r -= step * Ad;
    const double last = std::exchange(square, precondition());
    if (!(square > options.reduction * options.reduction * first)) break;
    if (summary.iterations >= options.max_iterations) {
      summary.status = CgStatus::iterations;
      break;
    }
    d = y + static_cast<Real>(square / last) * d;
  }
  // Below zero only by rounding, once converged.
  if (!std::isfinite(square) || first < 0.0) {
    summary.status = CgStatus::not_finite;
    summary.breakdown_at = first < 0.0 ? first : square;
  }
  summary.reduction = first > 0.0 ? std::sqrt(std::max(square, 0.0) / first) : 0.0;
  return summary;
}

}  // namespace slipstick::solver
