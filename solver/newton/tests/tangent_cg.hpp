#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "solver/newton/conjugate_gradients.hpp"
#include "solver/newton/tangent_space.hpp"

namespace slipstick::solver {

/// Any field as a condition.
struct FieldCondition {
  template <typename Values>
  double dot(Index first, const Values& with) const {
    return (values.segment(first, with.size()) * with).sum();
  }
  template <typename Part>
  void add_to(Part&& part, Index first, double factor) const {
    using Real = typename std::decay_t<Part>::Scalar;
    part += (factor * values.segment(first, part.size())).template cast<Real>();
  }

  Eigen::ArrayXd values;
};

/// Solves on a tangent space, with everything that the iteration needs.
template <typename Real>
class TangentCg {
 public:
  using Field = CgField<Real>;

  TangentCg(Operator<Real>& op, InverseSymbol<Real>& symbol, Index size, std::size_t conditions)
      : op_(op),
        symbol_(symbol),
        r_(size),
        x_(size),
        d_(size),
        Ad_(size),
        y_(size),
        w_(conditions, CgTangent(size)),
        constraints_(w_) {}

  Field& residual() { return r_; }
  const Field& solution() const { return x_; }
  const CgTangent& tangent(std::size_t k) const { return w_[k]; }

  bool precondition(const TangentSpace<Real>& space, std::vector<FieldCondition> conditions) {
    conditions_ = std::move(conditions);
    return precondition_again(space);
  }
  bool precondition_again(const TangentSpace<Real>& space) {
    std::array<const FieldCondition*, kMaxConditions> each{};
    std::ranges::transform(conditions_, each.begin(), [](const FieldCondition& c) { return &c; });
    TangentPreconditioner<Real> inverse{symbol_, space};
    return constraints_.prepare(inverse, std::span(each).first(conditions_.size()), d_, y_);
  }
  /// The tangents of the last precondition() on another tangent space.
  bool restrict_tangents(const TangentSpace<Real>& space) {
    const TangentPreconditioner<Real> inverse{symbol_, space};
    return constraints_.restrict_tangents(inverse, Sweep(Eigen::ArrayXd::Ones(space.f1.size())), y_);
  }
  CgSummary solve(const TangentSpace<Real>& space, double reduction, int max_iterations) {
    return run(space, {}, reduction, max_iterations);
  }
  /// Under the conditions of the last precondition().
  CgSummary solve_constrained(const TangentSpace<Real>& space, double reduction, int max_iterations) {
    return run(space, constraints_, reduction, max_iterations);
  }

 private:
  using Constraints = CgConstraints<Real, FieldCondition>;
  CgSummary run(const TangentSpace<Real>& space, const Constraints& constraints, double reduction,
                int max_iterations) {
    TangentOperator<Real> map{op_, space};
    TangentPreconditioner<Real> inverse{symbol_, space};
    x_.setZero();
    return projected_cg<Real>(map, inverse, constraints, r_, {reduction, max_iterations}, {d_, Ad_, y_}, x_);
  }

  Operator<Real>& op_;
  InverseSymbol<Real>& symbol_;
  Field r_, x_;
  Field d_, Ad_, y_;
  std::vector<CgTangent> w_;
  std::vector<FieldCondition> conditions_;
  Constraints constraints_;
};

}  // namespace slipstick::solver
