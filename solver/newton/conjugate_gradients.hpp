#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "solver/grid/packet.hpp"
#include "solver/grid/sweep.hpp"
#include "solver/newton/coefficients.hpp"

namespace slipstick::solver {

/// Why an iteration ended.
enum class CgStatus {
  reduced,     ///< the residual fell as far as asked
  iterations,  ///< it did not within as many as allowed
  indefinite,  ///< no positive curvature along a search direction
  not_finite   ///< the residual's square is not finite, or negative from the start
};

struct CgOptions {
  double reduction;  ///< of the residual, in the norm of the preconditioner
  int max_iterations;
  double known_step = 0.0;  ///< of the only step, along the first direction, which spares the map; 0: iterate
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

/// A condition preconditioned, in single precision: any field near it will do.
using CgTangent = Eigen::ArrayXf;

/// In single precision, where mirror images stay each other's in sign and size, whichever way is rounded.
inline float to_tangent(double value) {
  return static_cast<float>(std::copysign(static_cast<float>(std::abs(value)), value));
}

/// The system's matrix A, symmetric and positive definite on the cells of the iteration. Fields are zero in
/// other cells, which are not written. y = A x in two parts: transform(x, y), and store(first, last, x, y),
/// which shares a sweep over the cells with the dot products that follow.
template <class Map>
concept LinearMap = requires(Map& map, Index cell, const Eigen::ArrayXd& x, Eigen::ArrayXd& y) {
  { map.cells() } -> std::convertible_to<const Sweep&>;
  map.transform(x, y);
  map.store(cell, cell, x, y);
};

/// The preconditioner, y = M r in three parts: load(first, last, r, z) for all cells of a z that is zero
/// elsewhere, transform(z), and store(first, last, r, z, y), where y may be z. load and store share sweeps
/// with the operations before and after. project(first, last, y) projects y onto M's range, in which r lies.
template <class Map>
concept SplitMap = requires(Map& map, Index cell, const Eigen::ArrayXd& r, Eigen::ArrayXd& y) {
  { map.cells() } -> std::convertible_to<const Sweep&>;
  map.load(cell, cell, r, y);
  map.transform(y);
  map.store(cell, cell, r, y, y);
  map.project(cell, cell, y);
};

/// a.b in the cells [first, last) of `cells`, in all components; products are summed in double precision.
inline double dot(Index cells, Index first, Index last, const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  double sum = 0.0;
  for (Index start = first; start < a.size(); start += cells) {
    sum += (a.segment(start, last - first) * b.segment(start, last - first)).sum();
  }
  return sum;
}

/// Fields that an iteration overwrites; not owned.
struct CgWorkspace {
  Eigen::ArrayXd& d;
  Eigen::ArrayXd& Ad;
  Eigen::ArrayXd& y;
};

/// Dot products of one sweep: of two fields, of one with the conditions, and of one with their tangents.
struct CgProducts {
  using OfEach = std::array<double, kMaxConditions>;
  double fields = 0.0;
  OfEach conditions{}, tangents{};

  CgProducts& operator+=(const CgProducts& other) {
    fields += other.fields;
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      conditions[k] += other.conditions[k];
      tangents[k] += other.tangents[k];
    }
    return *this;
  }
};

/// Conditions c_k.x = const, which an iteration keeps. Each has a tangent w_k, about M c_k: with W = (w_1
/// ...) and C = (c_1 ...), residuals are projected to r - C (W^T C)^-1 W^T r and directions to y - W (C^T
/// W)^-1 C^T y. For any tangents these are projections and each other's transpose, so that the preconditioner
/// between them stays symmetric; with w_k = M c_k no direction is changed (Gould, Hribar and Nocedal 2001).
/// So the tangents of a nearby problem, in single precision, suffice.
///
/// Condition: a type with MotionField's dot() and add_to(). Conditions are not owned.
template <class Condition>
class CgConstraints {
 public:
  using Conditions = std::span<const Condition* const>;

  /// None.
  CgConstraints() = default;
  /// storage: a field for each condition there will be; not owned.
  explicit CgConstraints(std::span<CgTangent> storage) : tangents_(storage) {}

  /// Tangents w_k = M c_k. False if they are linearly dependent; then they must not be used. y, z: overwritten.
  template <SplitMap Preconditioner>
  bool prepare(Preconditioner& preconditioner, Conditions conditions, Eigen::ArrayXd& y, Eigen::ArrayXd& z) {
    count_ = conditions.size();
    std::ranges::copy(conditions, conditions_.begin());
    const Sweep& cells = preconditioner.cells();
    CoefficientMatrix products(count(), count());
    for (std::size_t k = 0; k < count_; ++k) {
      clear(cells, y);
      clear(cells, z);
      clear(cells, tangents_[k]);
      cells.each([&](Index first, Index last) {
        for_components(cells, y, first, last,
                       [&](Index start, Index n) { conditions_[k]->add_to(y.segment(start, n), start, 1.0); });
        preconditioner.project(first, last, y);
        preconditioner.load(first, last, y, z);
      });
      preconditioner.transform(z);
      const auto with_z = cells.sum<CgProducts>([&](Index first, Index last, CgProducts& sum) {
        preconditioner.store(first, last, y, z, z);
        add_products(cells, first, last, z, sum);
        for_components(cells, z, first, last, [&](Index start, Index n) {
          tangents_[k].segment(start, n) =
              z.segment(start, n).unaryExpr([](double value) { return to_tangent(value); });
        });
      });
      products.col(static_cast<Index>(k)) = first(with_z.conditions);
    }
    if (count_ == 0) return true;
    const SmallCholesky factor(products);
    if (!factor.is_definite()) return false;
    // The part of each condition that is left when those before it are taken out.
    if (!((factor.diagonal().array().square() / products.diagonal().array()) > kDependent).all()) return false;
    return factorise(preconditioner, z);
  }

  /// The same tangents projected onto the range of another preconditioner. all: the contact cells. z:
  /// overwritten. False as above.
  template <SplitMap Preconditioner>
  bool restrict_tangents(const Preconditioner& preconditioner, const Sweep& all, Eigen::ArrayXd& z) {
    for (CgTangent& w : tangents_.first(count_)) {
      all.each([&](Index first, Index last) {
        for_components(all, z, first, last,
                       [&](Index start, Index n) { z.segment(start, n) = w.segment(start, n).cast<double>(); });
        preconditioner.project(first, last, z);
        for_components(all, z, first, last, [&](Index start, Index n) {
          w.segment(start, n) = z.segment(start, n).unaryExpr([](double value) { return to_tangent(value); });
        });
      });
    }
    return count_ == 0 || factorise(preconditioner, z);
  }

  /// sum += c_k.y in some cells
  void add_products(const Sweep& cells, Index first, Index last, const Eigen::ArrayXd& y, CgProducts& sum) const {
    for (std::size_t k = 0; k < count_; ++k) {
      for_components(cells, y, first, last, [&](Index start, Index n) {
        sum.conditions[k] += conditions_[k]->dot(start, y.segment(start, n));
      });
    }
  }
  /// sum += w_k.r in some cells
  void add_products_of_tangents(const Sweep& cells, Index first, Index last, const Eigen::ArrayXd& r,
                                CgProducts& sum) const {
    for_components(cells, r, first, last, [&](Index start, Index n) {
      with_tangents(start, [&](const auto& w) { add_dots(w, r.data() + start, n, sum.tangents.data()); });
    });
  }

  /// As many as there are conditions.
  Coefficients first(const CgProducts::OfEach& products) const {
    return Eigen::Map<const Eigen::VectorXd>(products.data(), count());
  }
  /// (W^T C)^-1 with_tangents: the multiples of c_k to subtract from a residual.
  Coefficients multipliers(const Coefficients& with_tangents) const {
    return count_ == 0 ? Coefficients() : Coefficients(of_conditions_ * with_tangents);
  }
  /// (C^T W)^-1 with_conditions: the multiples of w_k to subtract from a direction.
  Coefficients parts(const Coefficients& with_conditions) const {
    return count_ == 0 ? Coefficients() : Coefficients(of_tangents_ * with_conditions);
  }

  /// r -= the sum of multiplier_k c_k in some cells
  void take_conditions_out(const Sweep& cells, Index first, Index last, const Coefficients& multipliers,
                           Eigen::ArrayXd& r) const {
    for (Index k = 0; k < count(); ++k) {
      for_components(cells, r, first, last, [&](Index start, Index n) {
        conditions_[at(k)]->add_to(r.segment(start, n), start, -multipliers[k]);
      });
    }
  }
  /// y -= the sum of part_k w_k in some cells
  void take_tangents_out(const Sweep& cells, Index first, Index last, const Coefficients& parts,
                         Eigen::ArrayXd& y) const {
    for_components(cells, y, first, last, [&](Index start, Index n) {
      with_tangents(start, [&](const auto& w) { take_out(w, parts.data(), y.data() + start, n); });
    });
  }

  /// x += the combination of tangents with these values of c_k.x.
  template <SplitMap Preconditioner>
  void add_with_values(const Preconditioner& preconditioner, const Coefficients& values, Eigen::ArrayXd& x) const {
    const Coefficients parts = -(of_tangents_ * values);
    const Sweep& cells = preconditioner.cells();
    cells.each([&](Index first, Index last) {
      take_tangents_out(cells, first, last, parts, x);
      preconditioner.project(first, last, x);
    });
  }

  std::span<const CgTangent> tangents() const { return tangents_.first(count_); }

 private:
  /// Conditions count as dependent if the part of one that is orthogonal to the others is below this: for a
  /// single stick cell rotation and translation are the same.
  static constexpr double kDependent = 1e-12;

  static std::size_t at(Index k) { return static_cast<std::size_t>(k); }
  Index count() const { return static_cast<Index>(count_); }
  /// work(pointers to the tangents' values from `first` on), compiled for each number of tangents.
  template <std::size_t K = kMaxConditions, typename Work>
  void with_tangents(Index first, const Work& work) const {
    if (count_ < K) {
      if constexpr (K > 1) with_tangents<K - 1>(first, work);
      return;
    }
    std::array<const float*, K> w;
    for (std::size_t k = 0; k < K; ++k) w[k] = tangents_[k].data() + first;
    work(w);
  }
  template <typename Field, typename Work>
  static void for_components(const Sweep& cells, const Field& field, Index first, Index last, const Work& work) {
    for (Index start = first; start < field.size(); start += cells.size()) work(start, last - first);
  }
  /// (C^T W)^-1 and its transpose, with the tangents projected onto the preconditioner's range, which
  /// rounding to single precision has left; false if the inverse does not exist.
  template <class Preconditioner>
  bool factorise(const Preconditioner& preconditioner, Eigen::ArrayXd& z) {
    const Sweep& cells = preconditioner.cells();
    CoefficientMatrix products(count(), count());
    for (std::size_t k = 0; k < count_; ++k) {
      const auto column = cells.sum<CgProducts>([&](Index first, Index last, CgProducts& sum) {
        for_components(cells, z, first, last, [&](Index start, Index n) {
          z.segment(start, n) = tangents_[k].segment(start, n).cast<double>();
        });
        preconditioner.project(first, last, z);
        add_products(cells, first, last, z, sum);
      });
      products.col(static_cast<Index>(k)) = first(column.conditions);
    }
    of_tangents_ = products.inverse();
    of_conditions_ = of_tangents_.transpose();
    return of_tangents_.allFinite();
  }

  std::array<const Condition*, kMaxConditions> conditions_{};
  std::size_t count_ = 0;
  std::span<CgTangent> tangents_;
  CoefficientMatrix of_tangents_, of_conditions_;
};

/// The state of projected_cg() between its iterations. It owns no field.
template <LinearMap Map, SplitMap Preconditioner, class Condition>
class ProjectedCg {
 public:
  ProjectedCg(Map& map, Preconditioner& preconditioner, const CgConstraints<Condition>& constraints, Eigen::ArrayXd& r,
              const CgWorkspace& work, Eigen::ArrayXd& x)
      : map_(map),
        preconditioner_(preconditioner),
        constraints_(constraints),
        cells_(map.cells()),
        r_(r),
        x_(x),
        d_(work.d),
        Ad_(work.Ad),
        y_(work.y) {}

  CgSummary run(const CgOptions& options) {
    CgSummary summary;
    double square = begin(summary);
    const double first_square = square;
    while (square > 0.0) {
      if (options.known_step > 0.0) {
        step_along_direction(options.known_step);
        break;
      }
      if (summary.iterations == options.max_iterations) {
        summary.status = CgStatus::iterations;
        break;
      }
      ++summary.iterations;
      if (!advance(square, summary)) return summary;
      // With reduction 0 the last residual need not be preconditioned.
      if (options.reduction == 0.0 && summary.iterations == options.max_iterations) {
        summary.status = CgStatus::iterations;
        break;
      }
      const double last = std::exchange(square, precondition());
      turn(square / last);
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

 private:
  /// The first direction; returns the square of the residual.
  double begin(CgSummary& summary) {
    const auto products = cells_.sum<CgProducts>([&](Index first, Index last, CgProducts& sum) {
      preconditioner_.project(first, last, r_);
      constraints_.add_products_of_tangents(cells_, first, last, r_, sum);
    });
    summary.multipliers = constraints_.multipliers(constraints_.first(products.tangents));
    clear_elsewhere(y_);
    cells_.each([&](Index first, Index last) { load(first, last, summary.multipliers); });
    const double square = precondition();
    clear(cells_, d_);
    turn(0);
    return square;
  }

  void clear_elsewhere(Eigen::ArrayXd& y) const {
    if (cells_.count() < cells_.size()) clear(cells_, y);
  }

  /// Takes conditions out of the residual and begins to precondition it.
  void load(Index first, Index last, const Coefficients& multipliers) {
    constraints_.take_conditions_out(cells_, first, last, multipliers, r_);
    preconditioner_.project(first, last, r_);
    preconditioner_.load(first, last, r_, y_);
  }

  /// y = M r and the multiples of tangents to subtract from it; returns r.y after that.
  double precondition() {
    preconditioner_.transform(y_);
    const auto products = cells_.sum<CgProducts>([&](Index first, Index last, CgProducts& sum) {
      preconditioner_.store(first, last, r_, y_, y_);
      sum.fields += dot(cells_.size(), first, last, r_, y_);
      constraints_.add_products(cells_, first, last, y_, sum);
      constraints_.add_products_of_tangents(cells_, first, last, r_, sum);
    });
    parts_ = constraints_.parts(constraints_.first(products.conditions));
    left_ = constraints_.first(products.tangents);
    return products.fields - (parts_.size() > 0 ? parts_.dot(left_) : 0.0);
  }

  /// The next direction, with this part of the last one.
  void turn(double kept) {
    cells_.each([&](Index first, Index last) {
      constraints_.take_tangents_out(cells_, first, last, parts_, y_);
      preconditioner_.project(first, last, y_);
      for (Index start = first; start < d_.size(); start += cells_.size()) {
        auto part = d_.segment(start, last - first);
        part = y_.segment(start, last - first) + kept * part;
      }
    });
  }

  void step_along_direction(double length) {
    cells_.each([&](Index first, Index last) {
      for (Index start = first; start < x_.size(); start += cells_.size())
        x_.segment(start, last - first) += length * d_.segment(start, last - first);
    });
  }

  /// A step along the direction. False, with its breakdown in the summary, where the curvature along it is
  /// not positive.
  bool advance(double square, CgSummary& summary) {
    map_.transform(d_, Ad_);
    const auto products = cells_.sum<CgProducts>([&](Index first, Index last, CgProducts& sum) {
      map_.store(first, last, d_, Ad_);
      sum.fields += dot(cells_.size(), first, last, d_, Ad_);
      constraints_.add_products_of_tangents(cells_, first, last, Ad_, sum);
    });
    const double curvature = products.fields;
    if (!(curvature > 0.0)) {
      summary.status = CgStatus::indefinite;
      summary.breakdown_at = curvature;
      return false;
    }
    const double step = square / curvature;
    const Coefficients multipliers = constraints_.multipliers(left_ - step * constraints_.first(products.tangents));
    summary.multipliers += multipliers;
    clear_elsewhere(y_);
    cells_.each([&](Index first, Index last) {
      for (Index start = first; start < x_.size(); start += cells_.size()) {
        x_.segment(start, last - first) += step * d_.segment(start, last - first);
        r_.segment(start, last - first) -= step * Ad_.segment(start, last - first);
      }
      load(first, last, multipliers);
    });
    return true;
  }

  Map& map_;
  Preconditioner& preconditioner_;
  const CgConstraints<Condition>& constraints_;
  const Sweep& cells_;
  Eigen::ArrayXd &r_, &x_, &d_, &Ad_, &y_;
  Coefficients parts_;  ///< of the tangents in y
  Coefficients left_;   ///< products of the tangents with the residual: rounding, which must not grow
};

/// Preconditioned conjugate gradients for A x = b - sum of multiplier_k c_k, where c_k.x keeps its first value.
///
/// 1. r = b - A x, projected; y = M r, projected; d = y.
/// 2. x += a d, r -= a A d with a = r.y / d.A d; a curvature d.A d <= 0 ends the iteration.
/// 3. r is projected, which adds to the multipliers; y = M r, projected.
/// 4. d = y + (r.y / last r.y) d; again from 2 until sqrt(r.y) has fallen by `reduction`.
///
/// r: the residual of the first x; overwritten by the last residual. Each iteration applies both maps once
/// and sweeps over the cells four times, twice within the maps. Allocates nothing. With a known step: 1, and
/// x += step d.
template <LinearMap Map, SplitMap Preconditioner, class Condition>
CgSummary projected_cg(Map& map, Preconditioner& preconditioner, const CgConstraints<Condition>& constraints,
                       Eigen::ArrayXd& r, const CgOptions& options, const CgWorkspace& work, Eigen::ArrayXd& x) {
  return ProjectedCg(map, preconditioner, constraints, r, work, x).run(options);
}

}  // namespace slipstick::solver
