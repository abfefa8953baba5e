#include "solver/operator/elasticity.hpp"

#include <type_traits>
#include <utility>

#include "solver/operator/random_rounding.hpp"

namespace slipstick::solver {

namespace {

/// The diagonal's mirror is of use to the tangential kernel alone.
OperatorOptions options_of(const Elasticity& elasticity, const BlockKernel& kernel) {
  return {.threads = elasticity.threads, .diagonal = elasticity.diagonal && kernel.inputs == 2};
}

template <typename Real>
std::unique_ptr<InverseSymbol<Real>> symbol_of(const Elasticity& elasticity, const Grid& grid,
                                               const BlockKernel& kernel) {
  return make_inverse_symbol<Real>(grid, kernel, elasticity.pair,
                                   options_of(elasticity, kernel).diagonal ? Diagonal::yes : Diagonal::no,
                                   elasticity.threads, elasticity.at_edge);
}

std::unique_ptr<LinearOperator> new_operator(const Elasticity& elasticity, const Grid& grid,
                                             const BlockKernel& kernel) {
  auto op = make_operator(elasticity.kind, grid, kernel, elasticity.pair, options_of(elasticity, kernel));
  return elasticity.rounding_seed == 0 ? std::move(op)
                                       : rounded_at_random(std::move(op), kernel, elasticity.rounding_seed);
}

CacheKey with_kernel(CacheKey key, const BlockKernel& kernel) {
  key.add(kernel.outputs).add(kernel.inputs);
  for (const Component component : kernel.components) key.add(component);
  return key;
}

}  // namespace

std::shared_ptr<SolveCache> Elasticity::usable_cache() const { return rounding_seed != 0 ? nullptr : cache; }

CacheKey Elasticity::key(const char* what, const Grid& grid) const {
  CacheKey all(what);
  all.add(pair.shear_compliance).add(pair.poisson_compliance).add(pair.normal_compliance).add(pair.mismatch);
  all.add(pair.cell_traction).add(kind).add(threads).add(precision).add(diagonal).add(at_edge);
  return all.add(grid.n1).add(grid.n2).add(grid.h1).add(grid.h2).add(grid.quadrant);
}

Cached<LinearOperator> Elasticity::make(const Grid& grid, const BlockKernel& kernel) const {
  Cached<LinearOperator> op(
      usable_cache(), with_kernel(key("operator", grid), kernel),
      [&] { return new_operator(*this, grid, kernel); },
      [](const LinearOperator& made) { return static_cast<double>(made.bytes()); });
  op->restart_count();
  return op;
}

template <>
GridOperators<double>::GridOperators(const Elasticity& elasticity, const Grid& grid,
                                     const BlockKernel& kernel)
    : op(new_operator(elasticity, grid, kernel)), symbol(symbol_of<double>(elasticity, grid, kernel)) {}

template <>
GridOperators<float>::GridOperators(const Elasticity& elasticity, const Grid& grid, const BlockKernel& kernel)
    : op(new_operator(elasticity, grid, kernel)),
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
Cached<GridOperators<Real>> Elasticity::make_all(const Grid& grid, const BlockKernel& kernel) const {
  Cached<GridOperators<Real>> operators(
      usable_cache(), with_kernel(key("grid operators", grid), kernel),
      [&] { return std::make_unique<GridOperators<Real>>(*this, grid, kernel); },
      [](const GridOperators<Real>& made) { return made.bytes(); });
  operators->op->restart_count();
  operators->inner().restart_count();
  return operators;
}

template Cached<GridOperators<double>> Elasticity::make_all(const Grid&, const BlockKernel&) const;
template Cached<GridOperators<float>> Elasticity::make_all(const Grid&, const BlockKernel&) const;

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
                                              options.threads, elasticity.at_edge);
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
