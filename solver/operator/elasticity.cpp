#include "solver/operator/elasticity.hpp"

#include <type_traits>
#include <utility>

#include "solver/operator/random_rounding.hpp"

namespace slipstick::solver {

namespace {

/// The diagonal's mirror is of use to the tangential kernel alone.
OperatorOptions options_of(const Elasticity& elasticity, const BlockKernel& kernel) {
  return {.threads = elasticity.threads,
          .measure_plans = elasticity.measure_plans,
          .diagonal = elasticity.diagonal && kernel.inputs == 2};
}

template <typename Real>
std::unique_ptr<InverseSymbol<Real>> symbol_of(const Elasticity& elasticity, const Grid& grid,
                                               const BlockKernel& kernel) {
  return make_inverse_symbol<Real>(grid, kernel, elasticity.pair,
                                   options_of(elasticity, kernel).diagonal ? Diagonal::yes : Diagonal::no,
                                   elasticity.measure_plans, elasticity.threads);
}

}  // namespace

std::unique_ptr<LinearOperator> Elasticity::make(const Grid& grid, const BlockKernel& kernel) const {
  auto op = make_operator(kind, grid, kernel, pair, options_of(*this, kernel));
  return rounding_seed == 0 ? std::move(op) : rounded_at_random(std::move(op), kernel, rounding_seed);
}

template <>
GridOperators<double>::GridOperators(const Elasticity& elasticity, const Grid& grid,
                                     const BlockKernel& kernel)
    : op(elasticity.make(grid, kernel)), symbol(symbol_of<double>(elasticity, grid, kernel)) {}

template <>
GridOperators<float>::GridOperators(const Elasticity& elasticity, const Grid& grid, const BlockKernel& kernel)
    : op(elasticity.make(grid, kernel)),
      single(make_single_operator(grid, kernel, elasticity.pair, options_of(elasticity, kernel))),
      symbol(symbol_of<float>(elasticity, grid, kernel)) {}

template <>
Operator<double>& GridOperators<double>::inner() {
  return *op;
}

template <>
Operator<float>& GridOperators<float>::inner() {
  return *single;
}

template <typename Real>
double GridOperators<Real>::bytes() const {
  return static_cast<double>(op->bytes() + (single ? single->bytes() : 0) + symbol->bytes());
}

template <typename Real>
double GridOperators<Real>::predicted_bytes(const Elasticity& elasticity, const Grid& grid,
                                            const BlockKernel& kernel) {
  const OperatorOptions options = options_of(elasticity, kernel);
  const double inner = std::is_same_v<Real, double> ? 0.0 : predicted_single_bytes(grid, kernel, options);
  return solver::predicted_bytes(elasticity.kind, grid, kernel, options) + inner +
         predicted_inverse_symbol_bytes<Real>(grid, kernel, options.diagonal ? Diagonal::yes : Diagonal::no,
                                              options.threads);
}

template struct GridOperators<double>;
template struct GridOperators<float>;

double finest_grid_applications(const std::vector<GridWork>& grids) {
  double sum = 0.0;
  for (const GridWork& work : grids) {
    sum += static_cast<double>(work.applications) * static_cast<double>(work.n1 * work.n2) /
           static_cast<double>(grids.back().n1 * grids.back().n2);
  }
  return sum;
}

}  // namespace slipstick::solver
