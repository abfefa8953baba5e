#pragma once

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "solver/newton/load_balance.hpp"
#include "solver/newton/tangent_space.hpp"
#include "solver/operator/inverse_symbol.hpp"
#include "solver/operator/linear_operator.hpp"

namespace slipstick::solver {

/// What ended an inner iteration; a breakdown is named with its number.
struct CgSummary {
  int iterations = 0;
  double reduction = 1.0;  ///< of the residual, in the norm of the preconditioner
  std::string breakdown;   ///< empty: none
};

/// Preconditioned conjugate gradients for (K + stiffness) x = r + sum of multiplier_k c_k on a tangent space,
/// with c_k.x = 0, or given values, kept throughout (projected by the preconditioned c_k; Gould, Hribar and
/// Nocedal 2001), or without conditions. Owns its workspace; nothing is allocated in the iteration.
template <typename Real>
class ConjugateGradients {
 public:
  using Field = typename Operator<Real>::Field;
  using Fields = std::span<const Field* const>;

  /// conditions: the most that a solve will have, or a call of solve_for_conditions().
  ConjugateGradients(Operator<Real>& op, InverseSymbol<Real>& symbol, Index size, std::size_t conditions)
      : op_(op),
        symbol_(symbol),
        x_(size),
        r_(size),
        d_(size),
        Kd_(size),
        y_(size),
        tangents_(conditions, Field(size)) {
    for (const Field& tangent : tangents_) tangent_pointers_.push_back(&tangent);
  }

  /// Where the right-hand side is written before a solve; overwritten by it.
  Field& residual() { return r_; }
  const Field& solution() const { return x_; }
  /// After precondition(conditions): each c preconditioned; after solve_for_conditions():
  /// (K + stiffness)^-1 c.
  Fields tangents() const { return tangent_pointers_; }

  /// False if the conditions are not independent on the tangent space.
  bool precondition(const TangentSpace<Real>& space, Fields conditions) {
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      precondition(space, *conditions[k]);
      tangents_[k] = y_;
    }
    const CoefficientMatrix products = products_with(conditions);
    factor_.compute(products);
    if (conditions.empty()) return true;
    if (factor_.info() != Eigen::Success) return false;
    // What is left of each when those before are taken out.
    const Coefficients own = factor_.matrixLLT().diagonal();
    return ((own.array().square() / products.diagonal().array()) > kDependent).all();
  }

  /// Until the residual has fallen by `reduction`, or max_iterations. With conditions,
  /// precondition(conditions) must have come before. loads: c_k.x of each condition; empty: zero, which saves
  /// an application.
  CgSummary solve(const TangentSpace<Real>& space, Fields conditions, double reduction, int max_iterations,
                  const Coefficients& loads = {}) {
    CgSummary summary;
    x_.setZero();
    if (loads.size() > 0) start_with(space, loads);
    double square = next_direction(space, conditions, 0.0);
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
      square = next_direction(space, conditions, square);
      if (!(square > reduction * reduction * first) || summary.iterations >= max_iterations) {
        return finish(summary, square, first);
      }
    }
  }

  /// Some steps towards (K + stiffness) w = c for each condition; returns c_k.w_l, d(load)/d(motion) of the
  /// tangent problem. Its error is of second order in that of w.
  CoefficientMatrix solve_for_conditions(const TangentSpace<Real>& space, Fields conditions, int iterations) {
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      r_ = *conditions[k];
      solve(space, {}, 0.0, iterations);
      tangents_[k] = x_;
    }
    const CoefficientMatrix products = products_with(conditions);
    return 0.5 * (products + products.transpose());
  }

  /// Memory of the workspace for fields of so many values.
  static double bytes(double values, std::size_t conditions) {
    return (5.0 + static_cast<double>(conditions)) * sizeof(Real) * values;
  }

 private:
  /// x = the combination of preconditioned conditions that has these loads; the residual is what it leaves.
  void start_with(const TangentSpace<Real>& space, const Coefficients& loads) {
    const Coefficients parts = factor_.solve(loads);
    for (Eigen::Index k = 0; k < parts.size(); ++k) {
      x_ += static_cast<Real>(parts[k]) * tangents_[static_cast<std::size_t>(k)];
    }
    op_.apply(x_, Kd_);
    space.add_stiffness(x_, Kd_);
    r_ -= Kd_;
  }

  /// Conditions that depend on each other on the tangent space: one stick cell can be turned and pushed, but
  /// not told which.
  static constexpr double kDependent = 1e-12;

  static double dot(const Field& a, const Field& b) {
    return (a.template cast<double>() * b.template cast<double>()).sum();
  }

  void precondition(const TangentSpace<Real>& space, const Field& r) {
    space.restrict_to(r, y_);
    symbol_.apply(std::span(y_.data(), static_cast<std::size_t>(y_.size())));
    space.complete(r, y_);
  }

  CoefficientMatrix products_with(Fields conditions) const {
    const auto n = static_cast<Eigen::Index>(conditions.size());
    CoefficientMatrix products(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      for (Eigen::Index l = 0; l < n; ++l) {
        products(k, l) =
            dot(*conditions[static_cast<std::size_t>(k)], tangents_[static_cast<std::size_t>(l)]);
      }
    }
    return products;
  }

  /// d = preconditioned residual, conjugate to the last direction; its square in the preconditioner's norm.
  double next_direction(const TangentSpace<Real>& space, Fields conditions, double previous_square) {
    precondition(space, r_);
    double square = dot(r_, y_);
    if (!conditions.empty()) {
      Coefficients products(static_cast<Eigen::Index>(conditions.size()));
      for (std::size_t k = 0; k < conditions.size(); ++k) {
        products[static_cast<Eigen::Index>(k)] = dot(*conditions[k], y_);
      }
      const Coefficients multipliers = factor_.solve(products);
      square -= multipliers.dot(products);
      for (std::size_t k = 0; k < conditions.size(); ++k) {
        const auto multiplier = static_cast<Real>(multipliers[static_cast<Eigen::Index>(k)]);
        y_ -= multiplier * tangents_[k];
        r_ -= multiplier * *conditions[k];
      }
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
  Field x_, r_, d_, Kd_, y_;
  std::vector<Field> tangents_;
  std::vector<const Field*> tangent_pointers_;
  Eigen::LLT<CoefficientMatrix> factor_;
};

}  // namespace slipstick::solver
