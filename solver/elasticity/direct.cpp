#include "solver/elasticity/direct.hpp"

#include <algorithm>
#include <cstdlib>

#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

/// The loop that the time goes into, in which nothing overlaps.
inline void add(Index count, double factor, const double* __restrict from, double* __restrict to) {
  for (Index j = 0; j < count; ++j) to[j] += factor * from[j];
}

/// A quadrant of coefficients unfolded by parity to offsets of both signs.
std::vector<double> all_offsets(Component component, const ElasticLaw& law, const Grid& grid) {
  const Index n1 = grid.n1;
  const Index n2 = grid.n2;
  const std::vector<double> quadrant = law.influence_coefficients(component, grid);
  const Parity sign = parity(component);
  std::vector<double> all;
  all.reserve(static_cast<std::size_t>((2 * n1 - 1) * (2 * n2 - 1)));
  for (Index k1 = 1 - n1; k1 < n1; ++k1) {
    for (Index k2 = 1 - n2; k2 < n2; ++k2) {
      const int factor = (k1 < 0 ? sign.x1 : 1) * (k2 < 0 ? sign.x2 : 1);
      all.push_back(factor * quadrant[static_cast<std::size_t>(std::abs(k1) * n2 + std::abs(k2))]);
    }
  }
  return all;
}

}  // namespace

DirectSum::DirectSum(const Grid& grid, BlockKernel kernel, const ElasticLaw& law, const OperatorOptions& options)
    : LinearOperator(grid, std::move(kernel)),
      source_(inputs() * static_cast<std::size_t>(grid.cells())),
      threads_(std::max(options.threads, 1)) {
  for (const Component component : this->kernel().distinct()) {
    coefficients_.emplace(component, all_offsets(component, law, grid));
  }
}

void DirectSum::do_apply(std::span<const double> traction, std::span<double> displacement) {
  const Index n1 = grid().n1;
  const Index n2 = grid().n2;
  const Index cells = grid().cells();
  std::ranges::copy(traction, source_.begin());
  std::fill(displacement.begin(), displacement.end(), 0.0);
  const auto rows = [&](int, Index first, Index last) {
    for (Index i = first; i < last; ++i) {
      for (std::size_t a = 0; a < outputs(); ++a) {
        double* const out = displacement.data() + static_cast<Index>(a) * cells + i * n2;
        for (std::size_t b = 0; b < inputs(); ++b) {
          const double* const coefficient = coefficients_.at(kernel().components[a * inputs() + b]).data();
          const double* const in = source_.data() + static_cast<Index>(b) * cells;
          for (Index k = 0; k < n1; ++k) {
            const double* const row = coefficient + (i - k + n1 - 1) * (2 * n2 - 1);
            for (Index l = 0; l < n2; ++l) {
              const double source = in[k * n2 + l];
              if (source == 0.0) continue;
              add(n2, source, row + (n2 - 1 - l), out);
            }
          }
        }
      }
    }
  };
  in_parts(threads_, n1, rows);
}

DenseMatrix::DenseMatrix(const Grid& grid, BlockKernel kernel, const ElasticLaw& law)
    : LinearOperator(grid, std::move(kernel)) {
  const Index cells = grid.cells();
  matrix_.resize(static_cast<Index>(outputs()) * cells, static_cast<Index>(inputs()) * cells);
  source_.resize(matrix_.cols());
  for (std::size_t a = 0; a < outputs(); ++a) {
    for (std::size_t b = 0; b < inputs(); ++b) {
      const std::vector<double> all = all_offsets(this->kernel().components[a * inputs() + b], law, grid);
      for (Index source = 0; source < cells; ++source) {
        for (Index point = 0; point < cells; ++point) {
          const Index k1 = point / grid.n2 - source / grid.n2 + grid.n1 - 1;
          const Index k2 = point % grid.n2 - source % grid.n2 + grid.n2 - 1;
          matrix_(static_cast<Index>(a) * cells + point, static_cast<Index>(b) * cells + source) =
              all[static_cast<std::size_t>(k1 * (2 * grid.n2 - 1) + k2)];
        }
      }
    }
  }
}

void DenseMatrix::do_apply(std::span<const double> traction, std::span<double> displacement) {
  std::ranges::copy(traction, source_.begin());
  Eigen::Map<Eigen::VectorXd> out(displacement.data(), static_cast<Index>(displacement.size()));
  out.noalias() = matrix_ * source_;
}

}  // namespace slipstick::solver
