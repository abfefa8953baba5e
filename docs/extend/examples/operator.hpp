#pragma once

#include <memory>
#include <span>
#include <utility>

#include "solver/elasticity/linear_operator.hpp"

namespace example {

namespace solver = slipstick::solver;

/// Half-spaces under a thin layer that gives way where it is loaded, as Winkler's: u = K q + compliance q.
class CoatedHalfSpaces final : public solver::LinearOperator {
 public:
  /// compliance: displacement of the layer by a unit traction.
  CoatedHalfSpaces(std::unique_ptr<solver::LinearOperator> half_spaces, double compliance)
      : LinearOperator(half_spaces->grid(), solver::tangential_kernel()),
        half_spaces_(std::move(half_spaces)),
        compliance_(compliance) {}

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override {
    half_spaces_->apply(traction, displacement);
    for (std::size_t i = 0; i < traction.size(); ++i) displacement[i] += compliance_ * traction[i];
  }

  std::unique_ptr<solver::LinearOperator> half_spaces_;
  double compliance_;
};

}  // namespace example
