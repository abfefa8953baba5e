#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "solver/inverse_symbol.hpp"
#include "solver/linear_operator.hpp"
#include "solver/tangent_space.hpp"

namespace slipstick::solver {

/// What ended an inner iteration; a breakdown is named with its number.
struct CgSummary {
  int iterations = 0;
  double reduction = 1.0;  ///< of the residual, in the norm of the preconditioner
  std::string breakdown;   ///< empty: none
};

/// Preconditioned conjugate gradients for (K + stiffness) x = r + multiplier c on a tangent space, with c.x =
/// 0 kept throughout (projected by the preconditioned c; Gould, Hribar and Nocedal 2001), or without a
/// condition. Owns its workspace; nothing is allocated in the iteration.
template <typename Real>
class ConjugateGradients {
 public:
  using Field = typename Operator<Real>::Field;

  ConjugateGradients(Operator<Real>& op, InverseSymbol<Real>& symbol, Index size)
      : op_(op), symbol_(symbol), x_(size), r_(size), d_(size), Kd_(size), y_(size), w_(size) {}

  /// Where the right-hand side is written before a solve; overwritten by it.
  Field& residual() { return r_; }
  const Field& solution() const { return x_; }
  /// After precondition_condition(): the preconditioned c; after solve_for_condition(): (K + stiffness)^-1 c.
  const Field& tangent() const { return w_; }

  /// w = preconditioned c. False if c has no part in the tangent space.
  bool precondition_condition(const TangentSpace<Real>& space, const Field& c) {
    precondition(space, c);
    w_ = y_;
    c_w_ = dot(c, w_);
    return c_w_ > 0.0;
  }

  /// Until the residual has fallen by `reduction`, or max_iterations. condition: c, or null. With one,
  /// precondition_condition() must have come before.
  CgSummary solve(const TangentSpace<Real>& space, const Field* condition, double reduction,
                  int max_iterations) {
    CgSummary summary;
    x_.setZero();
    double square = next_direction(space, condition, 0.0);
    const double first = square;
    if (!(square > 0.0)) return finish(summary, square, first);
    for (summary.iterations = 1;; ++summary.iterations) {
      op_.apply(d_, Kd_);
      space.add_stiffness(d_, Kd_);
      const double curvature = dot(d_, Kd_);
      if (!(curvature > 0.0)) {
        summary.breakdown = fmt::format("curvature {:.3g} along a search direction", curvature);
        return summary;
      }
      const auto step = static_cast<Real>(square / curvature);
      x_ += step * d_;
      r_ -= step * Kd_;
      square = next_direction(space, condition, square);
      if (!(square > reduction * reduction * first) || summary.iterations >= max_iterations) {
        return finish(summary, square, first);
      }
    }
  }

  /// Some steps towards (K + stiffness) w = c; returns c.w, dM/dphi of the tangent problem. Its error is of
  /// second order in that of w.
  double solve_for_condition(const TangentSpace<Real>& space, const Field& c, int iterations) {
    r_ = c;
    solve(space, nullptr, 0.0, iterations);
    w_ = x_;
    return c_w_ = dot(c, w_);
  }

  /// Memory of the workspace for fields of so many values.
  static double bytes(double values) { return 6.0 * sizeof(Real) * values; }

 private:
  static double dot(const Field& a, const Field& b) {
    return (a.template cast<double>() * b.template cast<double>()).sum();
  }

  void precondition(const TangentSpace<Real>& space, const Field& r) {
    space.restrict_to(r, y_);
    symbol_.apply(std::span(y_.data(), static_cast<std::size_t>(y_.size())));
    space.complete(r, y_);
  }

  /// d = preconditioned residual, conjugate to the last direction; its square in the preconditioner's norm.
  double next_direction(const TangentSpace<Real>& space, const Field* condition, double previous_square) {
    precondition(space, r_);
    double square = dot(r_, y_);
    if (condition != nullptr) {
      const double multiplier = dot(*condition, y_) / c_w_;
      square -= multiplier * multiplier * c_w_;
      y_ -= static_cast<Real>(multiplier) * w_;
      r_ -= static_cast<Real>(multiplier) * *condition;
    }
    if (previous_square == 0.0) {
      d_ = y_;
    } else {
      d_ = y_ + static_cast<Real>(square / previous_square) * d_;
    }
    return square;
  }

  static CgSummary finish(CgSummary& summary, double square, double first) {
    // Below zero only by rounding, once converged.
    if (!std::isfinite(square) || first < 0.0) {
      summary.breakdown = fmt::format("a residual whose square is {:.3g}", first < 0.0 ? first : square);
    }
    summary.reduction = first > 0.0 ? std::sqrt(std::max(square, 0.0) / first) : 0.0;
    return summary;
  }

  Operator<Real>& op_;
  InverseSymbol<Real>& symbol_;
  Field x_, r_, d_, Kd_, y_, w_;
  double c_w_ = 0.0;
};

}  // namespace slipstick::solver
