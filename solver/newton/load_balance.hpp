#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// The rigid motions of a body on a surface: two translations and a turn.
inline constexpr int kMostConditions = 3;

/// One value a condition, and a matrix of them; nothing is allocated.
using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostConditions, 1>;
using CoefficientMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostConditions, kMostConditions>;

/// The x of least length among those that solve matrix x = right, or come closest: of motions that do the
/// same to the contact, as of a single cell, the least.
Coefficients least_solution(const CoefficientMatrix& matrix, const Coefficients& right);

/// c_k.P(y + sum of x_l w_l), its derivatives by x_l, and the potential whose gradient it is where w = c.
template <int M>
struct LoadsAlong {
  Eigen::Vector<double, M> load = Eigen::Vector<double, M>::Zero();
  Eigen::Matrix<double, M, M> slope = Eigen::Matrix<double, M, M>::Zero();
  double potential = 0.0;
  /// Sum of |P(y + sum of x_l w_l)|^2, where cells may carry a load against each other; else 0.
  double carried = 0.0;
  double square = 0.0;  ///< sum of |y + sum of x_l w_l|^2, in each cell at least its bound's
};

/// A linear condition on a field: c.q = load. c is not owned.
struct Condition {
  const Eigen::ArrayXd* c;
  double load;
};

/// Linear conditions on the projection onto a product of small sets: finds x with
/// c_k.P(y + sum of x_l w_l) = load_k.
///
/// Along c itself that is the minimum of a convex function, which has one if the load is within what the set
/// can carry, and Newton's method with a line search finds it; a single condition is found in a bracket.
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
      for (Eigen::Index l = 0; l < load_.size(); ++l) majorant_(k, l) = (field(k) * field(l)).sum();
    }
  }

  int count() const { return static_cast<int>(load_.size()); }

  /// y += sum of x_k c_k
  void add(const Coefficients& x, Eigen::ArrayXd& y) const {
    for (Eigen::Index k = 0; k < load_.size(); ++k) y += x[k] * field(k);
  }

  /// Along the conditions' own fields, from the guess x on, or from where y would do without the set if that
  /// is too far off; false if no x does.
  bool solve(const Eigen::ArrayXd& y, Coefficients& x) const {
    const std::span<const Eigen::ArrayXd* const> c(c_);
    if (solve_along(y, c, x, true)) return true;
    Coefficients missing = load_;
    for (Eigen::Index k = 0; k < load_.size(); ++k) missing[k] -= (field(k) * y).sum();
    x = least_solution(majorant_, missing);
    return solve_along(y, c, x, true);
  }

  /// Along others close to what they turn into once the tractions answer; false if there is none near by.
  template <typename Direction>
  bool solve_along(const Eigen::ArrayXd& y, std::span<const Direction* const> w, Coefficients& x) const {
    return solve_along(y, w, x, false);
  }

 private:
  static constexpr double kLoadRounding = 1e-14;
  /// Where rounding allows no better.
  static constexpr double kPoorRounding = 1e-12;
  static constexpr int kBracketIterations = 60;
  static constexpr int kNewtonIterations = 100;
  /// Parts of the majorant.
  static constexpr double kLeastDamping = 1e-12;
  static constexpr double kMoreDamping = 100.0;
  /// Of a step, over the size of the field.
  static constexpr double kMostStride = 2.0;
  /// A step is good that halves what is missing, or brings this part of the decrease that its slope promises.
  static constexpr double kGoodReduction = 0.5;
  static constexpr double kArmijo = 1e-4;

  const Eigen::ArrayXd& field(Eigen::Index k) const { return *c_[static_cast<std::size_t>(k)]; }

  template <typename Direction>
  bool solve_along(const Eigen::ArrayXd& y, std::span<const Direction* const> w, Coefficients& x,
                   bool own) const {
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
    std::array<const Direction*, M> directions;
    std::array<const Eigen::ArrayXd*, M> fields;
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
    const Direction* const direction = &w;
    for (int i = 0; i < kBracketIterations; ++i) {
      const LoadsAlong<1> at =
          evaluate<1>(y, std::span<const Direction* const>(&direction, 1), Eigen::Vector<double, 1>(x));
      const double excess = at.load[0] - load_[0];
      if (std::abs(excess) <= kLoadRounding * known_to(at, 0)) return true;
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

  /// The size that the rounding of a load goes with: its own, or that of what cells carry against each other
  /// (by Cauchy's inequality no less than the sum of |c_k.P|).
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

  /// Newton's method. Far out, where the load hardly changes with x, its steps overshoot: they are kept to
  /// the size of the field itself, and the matrix takes up as much of the majorant as it needs. With all of
  /// it a step always descends.
  template <int M, typename Direction>
  bool solve_several(const Eigen::ArrayXd& y, std::span<const Direction* const> w, Coefficients& x_out,
                     bool own) const {
    using Vector = Eigen::Vector<double, M>;
    using Matrix = Eigen::Matrix<double, M, M>;
    const Matrix majorant = majorant_;
    const Vector load = load_;
    Vector x = x_out;
    LoadsAlong<M> at = evaluate<M>(y, w, x);
    double damping = kLeastDamping;
    for (int i = 0; i < kNewtonIterations; ++i) {
      const double missing = imbalance(at);
      if (missing <= kLoadRounding) break;
      if (!std::isfinite(missing)) return false;
      const Vector r = load - at.load;
      bool accepted = false;
      for (; !accepted && damping <= 1.0; damping *= kMoreDamping) {
        Vector step = least_solution(at.slope + damping * majorant, r);
        const double stride = step.dot(majorant * step) / (kMostStride * kMostStride * at.square);
        if (stride > 1.0) step /= std::sqrt(stride);
        const LoadsAlong<M> next = evaluate<M>(y, w, Vector(x + step));
        const double decrease = at.potential - next.potential + load.dot(step);
        const double rounding = kLoadRounding * (std::abs(at.potential) + std::abs(next.potential));
        accepted = imbalance(next) < kGoodReduction * missing ||
                   (own && decrease > kArmijo * r.dot(step) + rounding);
        if (!accepted) continue;
        x += step;
        at = next;
      }
      if (!accepted) break;
      damping = std::max(damping / (kMoreDamping * kMoreDamping), kLeastDamping);
    }
    x_out = x;
    return imbalance(at) <= kPoorRounding;
  }

  const Set& set_;
  std::vector<const Eigen::ArrayXd*> c_;
  Coefficients load_;
  CoefficientMatrix majorant_;
};

}  // namespace slipstick::solver
