#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "solver/grid/motion_field.hpp"
#include "solver/newton/coefficients.hpp"

namespace slipstick::solver {

/// c_k.P(y + sum of x_l w_l), its derivatives by x_l, and the potential whose gradient it is where w = c.
template <int M, int Directions = M>
struct LoadsAlong {
  Eigen::Vector<double, M> load = Eigen::Vector<double, M>::Zero();
  Eigen::Matrix<double, M, Directions> slope = Eigen::Matrix<double, M, Directions>::Zero();
  double potential = 0.0;
  /// Sum of |P(y + sum of x_l w_l)|^2, where cells may carry a load against each other; else 0.
  double carried = 0.0;
  double square = 0.0;  ///< sum of |y + sum of x_l w_l|^2, in each cell at least its bound's

  LoadsAlong& operator+=(const LoadsAlong& other) {
    load += other.load;
    slope += other.slope;
    potential += other.potential;
    carried += other.carried;
    square += other.square;
    return *this;
  }
};

/// A linear condition on a field: c.q = load, over the contact cells. c is not owned.
struct Condition {
  const MotionField* c;
  double load;
};

inline constexpr double kLoadRounding = 1e-14;
/// Where rounding allows no better.
inline constexpr double kPoorRounding = 1e-12;
inline constexpr int kBracketIterations = 200;
inline constexpr int kNewtonIterations = 200;
/// Parts of the majorant.
inline constexpr double kMinDamping = 1e-12;
inline constexpr double kMoreDamping = 100.0;
/// The longest step, over the size of the field.
inline constexpr double kMaxStride = 2.0;
/// A step is accepted if it reduces the imbalance by a twentieth, or the potential by this part of the linear
/// prediction. Near the limit load Newton steps reduce by a quarter only, and rounding hides the decrease.
inline constexpr double kGoodReduction = 0.95;
inline constexpr double kArmijo = 1e-4;

/// Linear conditions on the projection P onto a product of small sets: finds x with
/// c_k.P(y + sum of x_l w_l) = load_k.
///
/// For w = c, x is the minimum of a convex function, which exists if the set can carry the loads.
/// 1. One condition: Newton's method in a bracket.
/// 2. Several: Newton's method with a line search, its matrix shifted towards a majorant where it overshoots.
template <class Set>
class LoadBalance {
 public:
  LoadBalance(const Set& set, const std::vector<Condition>& conditions) : set_(set) {
    for (const auto& [c, load] : conditions) {
      c_.push_back(c);
      load_.conservativeResize(load_.size() + 1);
      load_[load_.size() - 1] = load;
    }
    majorant_.resize(load_.size(), load_.size());
    for (Eigen::Index k = 0; k < load_.size(); ++k) {
      for (Eigen::Index l = 0; l < load_.size(); ++l) majorant_(k, l) = product(k, field(l));
    }
  }

  int count() const { return static_cast<int>(load_.size()); }
  /// Evaluations of the loads: passes over all cells.
  long evaluations() const { return evaluations_; }

  /// y += sum of x_k c_k in the contact cells
  void add(const Coefficients& x, Eigen::ArrayXd& y) const {
    set_.sweep().each([&](Eigen::Index first, Eigen::Index last) {
      for (Eigen::Index k = 0; k < load_.size(); ++k) {
        for (Eigen::Index start = first; start < y.size(); start += set_.cells()) {
          field(k).add_to(y.segment(start, last - first), start, x[k]);
        }
      }
    });
  }

  /// Along w = c, from the guess x, or from the x that would balance y without P if the guess is too far off;
  /// false if no x is found.
  bool solve(const Eigen::ArrayXd& y, Coefficients& x) const {
    const std::span<const MotionField* const> c(c_);
    if (solve_along(y, c, x, true)) return true;
    Coefficients missing = load_;
    for (Eigen::Index k = 0; k < load_.size(); ++k) missing[k] -= product(k, y);
    x = least_solution(majorant_, missing);
    return solve_along(y, c, x, true);
  }

  /// Along tangents w, near the elastic response to c; false if no x is found nearby.
  template <typename Direction>
  bool solve_along(const Eigen::ArrayXd& y, std::span<const Direction* const> w, Coefficients& x) const {
    return solve_along(y, w, x, false);
  }

 private:
  const MotionField& field(Eigen::Index k) const { return *c_[static_cast<std::size_t>(k)]; }

  /// The product of the k-th condition's field with values.
  template <typename Values>
  double product(Eigen::Index k, const Values& values) const {
    return set_.sweep().template sum<double>([&](Eigen::Index first, Eigen::Index last, double& sum) {
      for (Eigen::Index start = first; start < Set::kComponents * set_.cells(); start += set_.cells()) {
        sum += field(k).dot(start, values.segment(start, last - first));
      }
    });
  }

  template <typename Direction>
  bool solve_along(const Eigen::ArrayXd& y, std::span<const Direction* const> w, Coefficients& x, bool own) const {
    if (count() == 0) return true;
    if (count() == 1) return solve_one(y, *w[0], x[0]);
    if constexpr (Set::kComponents == 2) {  // scalar fields have one condition
      return count() == 2 ? solve_several<2>(y, w, x, own) : solve_several<3>(y, w, x, own);
    }
    return false;
  }

  template <int M, typename Direction>
  LoadsAlong<M> evaluate(const Eigen::ArrayXd& y, std::span<const Direction* const> w,
                         const Eigen::Vector<double, M>& x) const {
    ++evaluations_;
    std::array<const Direction*, M> directions;
    std::array<const MotionField*, M> fields;
    for (std::size_t k = 0; k < M; ++k) {
      directions[k] = w[k];
      fields[k] = c_[k];
    }
    return set_.template loads_along<M>(y, directions, x, fields);
  }

  /// Newton's method in a bracket.
  template <typename Direction>
  bool solve_one(const Eigen::ArrayXd& y, const Direction& w, double& x) const {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    double stride = 0.0;
    double last = std::numeric_limits<double>::infinity();
    const Direction* const direction = &w;
    for (int i = 0; i < kBracketIterations; ++i) {
      const LoadsAlong<1> at =
          evaluate<1>(y, std::span<const Direction* const>(&direction, 1), Eigen::Vector<double, 1>(x));
      const double excess = at.load[0] - load_[0];
      if (std::abs(excess) <= kLoadRounding * known_to(at, 0)) return true;
      // Where rounding allows no better: a bracket would be halved as often as its numbers have bits.
      if (std::abs(excess) <= kPoorRounding * known_to(at, 0) && !(std::abs(excess) < kGoodReduction * last))
        return true;
      last = std::abs(excess);
      if (!std::isfinite(excess)) return false;
      (excess < 0.0 ? low : high) = x;
      const double slope = at.slope(0, 0);
      double next = x - excess / slope;
      if (slope > 0.0) stride = std::max(stride, std::abs(next - x));
      if (!(slope > 0.0) || !(next > low && next < high)) {
        const bool bracketed = std::isfinite(low) && std::isfinite(high);
        stride = stride > 0.0 ? 2.0 * stride : 1.0;
        next = bracketed ? 0.5 * (low + high) : x + (excess < 0.0 ? stride : -stride);
      }
      if (next == x || !(high - low > std::numeric_limits<double>::epsilon() * std::abs(x))) return true;
      x = next;
    }
    return false;
  }

  /// Newton's method with a line search. Far out, where the load hardly changes with x, steps overshoot: they
  /// are limited to the size of the field, and a part of the majorant is added to the matrix, if necessary
  /// all of it, with which a step always descends.
  template <int M, typename Direction>
  bool solve_several(const Eigen::ArrayXd& y, std::span<const Direction* const> w, Coefficients& x_out,
                     bool own) const {
    using Vector = Eigen::Vector<double, M>;
    using Matrix = Eigen::Matrix<double, M, M>;
    const Matrix majorant = majorant_;
    const Vector load = load_;
    Vector x = x_out;
    LoadsAlong<M> at = evaluate<M>(y, w, x);
    double damping = kMinDamping;
    for (int i = 0; i < kNewtonIterations; ++i) {
      const double missing = imbalance(at);
      if (missing <= kLoadRounding) break;
      if (!std::isfinite(missing)) return false;
      const Vector r = load - at.load;
      bool accepted = false;
      for (; !accepted && damping <= 1.0; damping *= kMoreDamping) {
        Vector step = least_solution(at.slope + damping * majorant, r);
        const double stride = step.dot(majorant * step) / (kMaxStride * kMaxStride * at.square);
        if (stride > 1.0) step /= std::sqrt(stride);
        const LoadsAlong<M> next = evaluate<M>(y, w, Vector(x + step));
        const double decrease = at.potential - next.potential + load.dot(step);
        const double rounding = kLoadRounding * (std::abs(at.potential) + std::abs(next.potential));
        accepted = imbalance(next) < kGoodReduction * missing || (own && decrease > kArmijo * r.dot(step) + rounding);
        if (!accepted) continue;
        x += step;
        at = next;
      }
      if (!accepted) break;
      damping = std::max(damping / (kMoreDamping * kMoreDamping), kMinDamping);
    }
    x_out = x;
    if (imbalance(at) <= kPoorRounding) return true;
    // Where y is all but taken away, as when a load returns to nothing, what is left is its rounding.
    const double square = set_.sweep().template sum<double>([&](Eigen::Index first, Eigen::Index last, double& sum) {
      for (Eigen::Index start = first; start < y.size(); start += set_.cells())
        sum += y.segment(start, last - first).square().sum();
    });
    const double known = kLoadRounding * std::sqrt(square);
    return ((load - at.load).cwiseAbs().array() <= known * majorant.diagonal().array().sqrt()).all();
  }

  /// The scale of a load's rounding: |load|, or the cells' contributions of both signs, whose sum |c_k.P| is
  /// bounded by Cauchy's inequality.
  template <int M>
  double known_to(const LoadsAlong<M>& at, int k) const {
    return std::max(std::abs(load_[k]), std::sqrt(majorant_(k, k) * at.carried));
  }

  /// The largest part of a load that is missing.
  template <int M>
  double imbalance(const LoadsAlong<M>& at) const {
    double worst = 0.0;
    for (int k = 0; k < M; ++k) {
      const double missing = std::abs(load_[k] - at.load[k]);
      // A single cell on the axis carries no moment, and need not.
      const double part = missing == 0.0 ? 0.0 : missing / known_to(at, k);
      worst = part <= worst ? worst : part;  // keeps NaN
    }
    return worst;
  }

  const Set& set_;
  std::vector<const MotionField*> c_;
  Coefficients load_;
  CoefficientMatrix majorant_;
  mutable long evaluations_ = 0;
};

}  // namespace slipstick::solver
