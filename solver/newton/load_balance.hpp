#pragma once

#include <Eigen/Core>
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

/// A linear condition on a field: c.q = load, over the cells whose set is not zero alone. c is not owned.
struct Condition {
  const MotionField* c;
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
  LoadBalance(const Set& set, const std::vector<Condition>& conditions);

  int count() const { return static_cast<int>(load_.size()); }
  /// How often the set has been asked for its loads: passes over all cells.
  long evaluations() const { return evaluations_; }

  /// y += sum of x_k c_k in the cells whose set is not zero alone
  void add(const Coefficients& x, Eigen::ArrayXd& y) const;

  /// Along the conditions' own fields, from the guess x on, or from where y would do without the set if that
  /// is too far off; false if no x does.
  bool solve(const Eigen::ArrayXd& y, Coefficients& x) const;

  /// Along others close to what they turn into once the tractions answer; false if there is none near by.
  template <typename Direction>
  bool solve_along(const Eigen::ArrayXd& y, std::span<const Direction* const> w, Coefficients& x) const {
    return solve_along(y, w, x, false);
  }

 private:
  const MotionField& field(Eigen::Index k) const { return *c_[static_cast<std::size_t>(k)]; }

  template <typename Values>
  double product(Eigen::Index k, const Values& values) const;
  template <typename Direction>
  bool solve_along(const Eigen::ArrayXd& y, std::span<const Direction* const> w, Coefficients& x,
                   bool own) const;
  template <int M, typename Direction>
  LoadsAlong<M> evaluate(const Eigen::ArrayXd& y, std::span<const Direction* const> w,
                         const Eigen::Vector<double, M>& x) const;
  template <typename Direction>
  bool solve_one(const Eigen::ArrayXd& y, const Direction& w, double& x) const;
  template <int M, typename Direction>
  bool solve_several(const Eigen::ArrayXd& y, std::span<const Direction* const> w, Coefficients& x_out,
                     bool own) const;
  template <int M>
  double known_to(const LoadsAlong<M>& at, int k) const;
  template <int M>
  double imbalance(const LoadsAlong<M>& at) const;

  const Set& set_;
  std::vector<const MotionField*> c_;
  Coefficients load_;
  CoefficientMatrix majorant_;
  mutable long evaluations_ = 0;
};

}  // namespace slipstick::solver
