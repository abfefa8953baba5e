#include "solver/elasticity/elasticity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

namespace slipstick::solver {

namespace {

/// Only the tangential kernel uses the mirror at the diagonal.
OperatorOptions options_of(const Elasticity& elasticity, const BlockKernel& kernel, std::span<double> memory = {}) {
  return {.threads = elasticity.threads,
          .diagonal = elasticity.diagonal && kernel.inputs == 2,
          .at_edge = elasticity.at_edge,
          .memory = memory};
}

/// An operator with random rounding, drawn from the seed: each displacement changes by up to an ulp of the
/// largest one, and after each application the thread rounds either upward or downward until the next. Digits
/// that agree for many seeds do not depend on compiler, processor or order of sums (Parker 1997, Monte Carlo
/// arithmetic; Vignes 2004, random rounding).
class RandomlyRounded final : public LinearOperator {
 public:
  RandomlyRounded(std::unique_ptr<LinearOperator> op, const BlockKernel& kernel, std::uint64_t seed)
      : LinearOperator(op->grid(), kernel), op_(std::move(op)) {
    std::seed_seq sequence{static_cast<std::uint64_t>(grid().n1), static_cast<std::uint64_t>(grid().n2),
                           static_cast<std::uint64_t>(kernel.inputs), seed};
    generator_.seed(sequence);
  }

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override {
    op_->apply(traction, displacement);
    double largest = 0.0;
    for (const double u : displacement) largest = std::max(largest, std::abs(u));
    const double ulp = std::numeric_limits<double>::epsilon() * largest;
    for (double& u : displacement) u += ulp * (2.0 * drawn() - 1.0);
    std::fesetround(drawn() < 0.5 ? FE_UPWARD : FE_DOWNWARD);
  }

  /// From 0 to 1, the same with every library.
  double drawn() { return std::ldexp(static_cast<double>(generator_() >> 11U), -53); }

  std::unique_ptr<LinearOperator> op_;
  std::mt19937_64 generator_;
};

std::unique_ptr<LinearOperator> new_operator(const Elasticity& elasticity, const Grid& grid,
                                             const BlockKernel& kernel) {
  auto op = make_operator(elasticity.kind, grid, kernel, *elasticity.law, options_of(elasticity, kernel));
  if (elasticity.rounding_seed == 0) return op;
  return std::make_unique<RandomlyRounded>(std::move(op), kernel, elasticity.rounding_seed);
}

/// Doubles a cell of the padded grid, for each Part.
using Held = std::array<double, 3>;
/// Memory of an operator by FFT, and of Newton's method in addition: for all cells of the grid, and for the
/// contact cells. It does not depend on the law. Counted on 256 x 256 cells and rounded up;
/// convergence/solve/tests/memory_test.py measures it in processes.
struct HeldOf {
  Held op, newton, of_cells;
};
constexpr HeldOf kNormal{{0.8, 1.6, 1.6}, {0.5, 1.0, 1.0}, {3.0, 3.0, 3.0}};
constexpr HeldOf kTangential{{1.8, 4.15, 3.6}, {1.2, 1.4, 1.4}, {5.9, 5.9, 5.9}};
constexpr HeldOf kCoupling{{1.55, 0.0, 0.0}, {}, {}};
/// Shorter sides take as much memory as this many cells, since lines are transformed in groups.
constexpr Index kMinSide = 16;
/// Bytes of freed blocks that stay with the process, see prepare_heap(): the matrices of pressure and
/// coupling, which have this part of the size of the tractions' matrix.
constexpr double kKeptBlocks = 16.0 * 0x1p20;
constexpr double kPartOfKept = 0.5;

const HeldOf& held_of(const BlockKernel& kernel) {
  if (kernel.inputs != kernel.outputs) return kCoupling;
  return kernel.inputs == 1 ? kNormal : kTangential;
}

/// The entry of Held for a grid.
std::size_t place_of(const Elasticity& elasticity, const Grid& grid, const BlockKernel& kernel) {
  return static_cast<std::size_t>(part_of(grid, kernel, options_of(elasticity, kernel).diagonal));
}

/// This rank's bytes, for a number of doubles per padded cell.
double padded_bytes(double doubles, const Grid& grid) {
  const auto padded = [](Index cells) { return static_cast<double>(fast_length(2 * std::max(cells, kMinSide) - 1)); };
  const double part = static_cast<double>(own_rows(grid).count()) / static_cast<double>(grid.n1);
  return sizeof(double) * doubles * padded(grid.n1) * padded(grid.n2) * part;
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
  law->add_to(all);
  all.add(kind).add(threads).add(diagonal).add(at_edge);
  return all.add(grid.n1).add(grid.n2).add(grid.h1).add(grid.h2).add(grid.quadrant).add(grid.ranks.number());
}

double Elasticity::operator_bytes(const Grid& grid, const BlockKernel& kernel) const {
  switch (kind) {
    case OperatorKind::dcfft:
      return padded_bytes(held_of(kernel).op[place_of(*this, grid, kernel)], grid);
    case OperatorKind::direct:
      return padded_bytes(static_cast<double>(kernel.distinct().size()), grid);
    case OperatorKind::dense: {
      const double matrix = sizeof(double) * static_cast<double>(kernel.inputs * kernel.outputs) *
                            std::pow(static_cast<double>(grid.cells()), 2);
      return matrix + std::min(kPartOfKept * matrix, kKeptBlocks);
    }
  }
  throw std::logic_error("unknown operator kind");
}

double Elasticity::newton_bytes(const Grid& grid, const BlockKernel& kernel, double part) const {
  const HeldOf& held = held_of(kernel);
  const std::size_t place = place_of(*this, grid, kernel);
  return operator_bytes(grid, kernel) + padded_bytes(held.newton[place] + part * held.of_cells[place], grid);
}

Cached<LinearOperator> Elasticity::make(const Grid& grid, const BlockKernel& kernel) const {
  Cached<LinearOperator> op(
      usable_cache(), with_kernel(key("operator", grid), kernel), [&] { return new_operator(*this, grid, kernel); },
      operator_bytes(grid, kernel));
  op->restart_count();
  return op;
}

GridOperators::GridOperators(const Elasticity& elasticity, const Grid& grid, const BlockKernel& kernel)
    : op(new_operator(elasticity, grid, kernel)),
      symbol(make_inverse_symbol(grid, kernel, *elasticity.law, options_of(elasticity, kernel, op->idle_memory()))) {}

Cached<GridOperators> Elasticity::make_all(const Grid& grid, const BlockKernel& kernel) const {
  Cached<GridOperators> operators(
      usable_cache(), with_kernel(key("grid operators", grid), kernel),
      [&] { return std::make_unique<GridOperators>(*this, grid, kernel); }, newton_bytes(grid, kernel));
  operators->op->restart_count();
  return operators;
}

double finest_grid_applications(const std::vector<GridWork>& grids) {
  double sum = 0.0;
  for (const GridWork& work : grids) {
    sum += static_cast<double>(work.applications) * static_cast<double>(work.n1 * work.n2) /
           static_cast<double>(grids.back().n1 * grids.back().n2);
  }
  return sum;
}

}  // namespace slipstick::solver
