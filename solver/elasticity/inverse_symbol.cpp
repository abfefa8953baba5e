#include "solver/elasticity/inverse_symbol.hpp"

#include <numeric>
#include <stdexcept>
#include <type_traits>

#include "solver/elasticity/symbol_table.hpp"
#include "solver/fft/periodic_transform.hpp"

namespace slipstick::solver {
namespace {

/// Cells at least between opposite edges that fields reach. More lower no count of iterations.
constexpr Index kCellsBetweenEdges = 2;

Grid padded(const Grid& grid, bool at_edge) {
  const Index margin = at_edge ? kCellsBetweenEdges : 0;
  return {fast_length(grid.n1 + margin), fast_length(grid.n2 + margin), grid.h1, grid.h2};
}

PeriodicTransform::Shape shape(const Grid& grid, const Grid& periodic, bool tangential) {
  return {.n1 = periodic.n1, .n2 = periodic.n2, .fields = tangential ? 2 : 1, .samples = grid.n1, .ranks = grid.ranks};
}

std::vector<Index> frequencies(const IndexRange& columns) {
  std::vector<Index> result(static_cast<std::size_t>(columns.count()));
  std::iota(result.begin(), result.end(), columns.first);
  return result;
}

/// Complex numbers times real ones.
void scale_complex(Index count, const double* __restrict p, double* __restrict z) {
  for (Index k = 0; k < count; ++k) {
    z[2 * k] *= p[k];
    z[2 * k + 1] *= p[k];
  }
}

/// Multiplies pairs of complex numbers by symmetric real matrices, with sign times p12.
void mix(Index count, double sign, const double* __restrict p11, const double* __restrict p12,
         const double* __restrict p22, double* __restrict z1, double* __restrict z2) {
  for (Index k = 0; k < count; ++k) {
    const double cross = sign * p12[k];
    const double real1 = z1[2 * k];
    const double imaginary1 = z1[2 * k + 1];
    const double real2 = z2[2 * k];
    const double imaginary2 = z2[2 * k + 1];
    z1[2 * k] = p11[k] * real1 + cross * real2;
    z1[2 * k + 1] = p11[k] * imaginary1 + cross * imaginary2;
    z2[2 * k] = cross * real1 + p22[k] * real2;
    z2[2 * k + 1] = cross * imaginary1 + p22[k] * imaginary2;
  }
}

/// On a whole grid, padded with zeros to fast lengths.
class PeriodicInverseSymbol final : public InverseSymbol {
 public:
  PeriodicInverseSymbol(const Grid& grid, bool tangential, const ElasticLaw& law, const OperatorOptions& options)
      : grid_(grid),
        periodic_(padded(grid, options.at_edge)),
        fields_(tangential ? 2 : 1),
        diagonal_(mean_inverse_symbol(periodic_, law, tangential)),
        columns_(PeriodicTransform::own_columns(shape(grid, periodic_, tangential))),
        table_(periodic_, law, tangential ? 3 : 1, frequencies(columns_),
               1.0 / (static_cast<double>(periodic_.n1) * static_cast<double>(periodic_.n2))),
        transform_(shape(grid, periodic_, tangential), options.threads, options.memory) {}

  void apply(std::span<double> field) override {
    if (static_cast<Index>(field.size()) != fields_ * grid_.cells()) {
      throw std::invalid_argument("inverse symbol applied to a field of another size");
    }
    transform_.each_sample(fields_, [&](int t, Index f, Index i) { load(t, f, i, field.data()); });
    transform_.through_columns(fields_, fields_, [&](const PeriodicTransform::Columns& columns) {
      using Whole = std::integral_constant<Index, PeriodicTransform::kColumns>;
      columns.count == Whole::value ? multiply(columns, Whole()) : multiply(columns, columns.count);
    });
    transform_.each_sample(fields_, [&](int t, Index f, Index i) { store(t, f, i, field.data()); });
  }

  std::array<double, 2> diagonal() const override { return diagonal_; }
  std::span<double> idle_memory() const override { return transform_.idle_memory(); }

 private:
  /// Where row i of a field is transformed: where it is, if it needs no zeros.
  double* row(int thread, double* values) {
    const bool fits = grid_.n2 == periodic_.n2 && PeriodicTransform::is_aligned(values);
    return fits ? values : transform_.own_row(thread);
  }

  void load(int thread, Index f, Index i, double* fields) {
    double* const values = fields + (f * grid_.n1 + i) * grid_.n2;
    double* const row = this->row(thread, values);
    if (row != values) {
      std::copy_n(values, grid_.n2, row);
      std::fill(row + grid_.n2, row + periodic_.n2, 0.0);
    }
    transform_.forward_sample(row, f, i);
  }

  void store(int thread, Index f, Index i, double* fields) {
    double* const values = fields + (f * grid_.n1 + i) * grid_.n2;
    double* const row = this->row(thread, values);
    transform_.backward_sample(row, f, i);
    if (row != values) std::copy_n(row, grid_.n2, values);
  }

  template <typename Count>
  void multiply(const PeriodicTransform::Columns& columns, Count count) {
    const Index first = columns.first - columns_.first;
    for (Index k = 0; k < periodic_.n1; ++k) {
      const bool negative = 2 * k > periodic_.n1;
      const Index f = negative ? periodic_.n1 - k : k;
      const double* const p11 = table_.row(SymbolEntry::p11, f) + first;
      if (fields_ == 1) {
        scale_complex(count, p11, columns.row(0, k));
      } else {
        mix(count, negative ? -1.0 : 1.0, p11, table_.row(SymbolEntry::p12, f) + first,
            table_.row(SymbolEntry::p22, f) + first, columns.row(0, k), columns.row(1, k));
      }
    }
  }

  Grid grid_;
  Grid periodic_;
  Index fields_;
  std::array<double, 2> diagonal_;
  IndexRange columns_;  ///< of this rank
  SymbolTable table_;
  PeriodicTransform transform_;
};

}  // namespace

std::size_t scratch_size(const Grid& grid, const BlockKernel& kernel, const OperatorOptions& options) {
  if (part_of(grid, kernel, options.diagonal) != Part::whole || grid.ranks.several()) return 0;
  return PeriodicTransform::plane_size(shape(grid, padded(grid, options.at_edge), kernel.inputs == 2)) +
         count(static_cast<Index>(kernel.inputs) * grid.cells());
}

std::unique_ptr<InverseSymbol> make_inverse_symbol(const Grid& grid, const BlockKernel& kernel, const ElasticLaw& law,
                                                   const OperatorOptions& options) {
  const bool tangential = kernel == tangential_kernel();
  if (!tangential && kernel != normal_kernel()) {
    throw std::invalid_argument("only the normal and the tangential kernel have an inverse symbol");
  }
  if (part_of(grid, kernel, options.diagonal) == Part::whole) {
    return std::make_unique<PeriodicInverseSymbol>(grid, tangential, law, options);
  }
  return make_mirrored_inverse_symbol(grid, tangential, law, options);
}

}  // namespace slipstick::solver
