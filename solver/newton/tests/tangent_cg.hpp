#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solver/newton/conjugate_gradients.hpp"
#include "solver/newton/tangent_space.hpp"

namespace slipstick::solver {

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
        work_(size),
        w_(conditions, Field(size)),
        constraints_(w_) {}

  Field& residual() { return r_; }
  const Field& solution() const { return x_; }
  const Field& tangent(std::size_t k) const { return w_[k]; }

  bool precondition(const TangentSpace<Real>& space, CgFields<Real> conditions) {
    TangentPreconditioner<Real> inverse{symbol_, space};
    return constraints_.prepare(inverse, conditions, work_.y);
  }
  CgSummary solve(const TangentSpace<Real>& space, double reduction, int max_iterations) {
    return run(space, {}, reduction, max_iterations);
  }
  /// Under the conditions of the last precondition().
  CgSummary solve_constrained(const TangentSpace<Real>& space, double reduction, int max_iterations) {
    return run(space, constraints_, reduction, max_iterations);
  }

 private:
  CgSummary run(const TangentSpace<Real>& space, const CgConstraints<Real>& constraints, double reduction,
                int max_iterations) {
    TangentOperator<Real> map{op_, space};
    TangentPreconditioner<Real> inverse{symbol_, space};
    x_.setZero();
    return projected_cg<Real>(map, inverse, constraints, r_, {reduction, max_iterations}, work_, x_);
  }

  Operator<Real>& op_;
  InverseSymbol<Real>& symbol_;
  Field r_, x_;
  CgWorkspace<Real> work_;
  std::vector<Field> w_;
  CgConstraints<Real> constraints_;
};

}  // namespace slipstick::solver
