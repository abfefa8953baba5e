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

/// A linear condition on a field: c.q = load, over the contact cells. c is not owned.
struct Condition {
  const MotionField* c;
  double load;
};

/// Linear conditions on the projection P onto a product of small sets: finds x with
/// c_k.P(y + sum of x_l w_l) = load_k.
///
/// For w = c, x is the minimum of a convex function, which exists if the set can carry the loads.
/// 1. One condition: Newton's method in a bracket.
/// 2. Several: Newton's method with a line search, its matrix shifted towards a majorant where it overshoots.
template <class Set>
class LoadBalance {
 public:
  LoadBalance(const Set& set, const std::vector<Condition>& conditions);

  int count() const { return static_cast<int>(load_.size()); }
  /// Evaluations of the loads: passes over all cells.
  long evaluations() const { return evaluations_; }

  /// y += sum of x_k c_k in the contact cells
  void add(const Coefficients& x, Eigen::ArrayXd& y) const;

  /// Along w = c, from the guess x, or from the x that would balance y without P if the guess is too far off;
  /// false if no x is found.
  bool solve(const Eigen::ArrayXd& y, Coefficients& x) const;

  /// Along tangents w, near the elastic response to c; false if no x is found nearby.
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
