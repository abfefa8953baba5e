#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
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
    part += (factor * values.segment(first, part.size()));
  }

  Eigen::ArrayXd values;
};

/// Solves on a tangent space, with everything that the iteration needs.
class TangentCg {
 public:
  using Field = Eigen::ArrayXd;

  TangentCg(LinearOperator& op, InverseSymbol& symbol, Index size, std::size_t conditions)
      : op_(op),
        symbol_(symbol),
        packing_(op.grid(), Sweep::whole(op.grid()), static_cast<Index>(op.inputs())),
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

  bool precondition(const TangentSpace& space, std::vector<FieldCondition> conditions) {
    conditions_ = std::move(conditions);
    std::array<const FieldCondition*, kMaxConditions> each{};
    std::ranges::transform(conditions_, each.begin(), [](const FieldCondition& c) { return &c; });
    TangentPreconditioner inverse{symbol_, space, packing_};
    return constraints_.prepare(inverse, std::span(each).first(conditions_.size()), d_, y_);
  }
  /// The tangents of the last precondition() on another tangent space.
  bool restrict_tangents(const TangentSpace& space) {
    const TangentPreconditioner inverse{symbol_, space, packing_};
    return constraints_.restrict_tangents(inverse, Sweep(Eigen::ArrayXd::Ones(space.f1.size())), y_);
  }
  CgSummary solve(const TangentSpace& space, double reduction, int max_iterations) {
    return run(space, {}, reduction, max_iterations);
  }
  /// Under the conditions of the last precondition().
  CgSummary solve_constrained(const TangentSpace& space, double reduction, int max_iterations) {
    return run(space, constraints_, reduction, max_iterations);
  }

 private:
  using Constraints = CgConstraints<FieldCondition>;
  CgSummary run(const TangentSpace& space, const Constraints& constraints, double reduction, int max_iterations) {
    TangentOperator map{op_, space, packing_};
    TangentPreconditioner inverse{symbol_, space, packing_};
    x_.setZero();
    return projected_cg(map, inverse, constraints, r_, {reduction, max_iterations}, {d_, Ad_, y_}, x_);
  }

  LinearOperator& op_;
  InverseSymbol& symbol_;
  Packing packing_;  ///< of all cells
  Field r_, x_;
  Field d_, Ad_, y_;
  std::vector<CgTangent> w_;
  std::vector<FieldCondition> conditions_;
  Constraints constraints_;
};

}  // namespace slipstick::solver
