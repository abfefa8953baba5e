#pragma once

#include <vector>

#include "solver/elasticity/linear_operator.hpp"
#include "solver/fft/fftw.hpp"
#include "solver/fft/half_sample_transform.hpp"
#include "solver/fft/rank_transpose.hpp"

namespace slipstick::solver {

/// The influence operator of a contact with two mirror axes, on the quadrant x1, x2 > 0 of its grid: what
/// Convolution gives on the whole grid for fields that are the quadrant's mirror images,
///
///     normal:      p and u3 are even in x1 and x2;
///     tangential:  as in torsion, q1 and u1 are even in x1 and odd in x2, q2 and u2 odd in x1 and even in
///     x2.
///
/// 1. Rows, padded to half of Convolution's period, by cosine or sine transforms (half_sample_transform.hpp).
/// 2. Columns in the same way, kLines of them together.
/// 3. The product with the kernel's transform: for these transforms, too, convolution is a product (Martucci,
///    IEEE Transactions on Signal Processing 42, 1994).
/// 4. Columns and rows back.
///
/// It takes a quarter of Convolution's work and half its memory. Transforms are stored in blocks of the
/// kLines columns that are transformed together, so that memory is read and written in order.
///
/// With `diagonal`, for a square quadrant of square cells, q2(x1, x2) = -q1(x2, x1): only q1 is transformed,
/// and u2 is the image of u1, for half the work.
class MirroredConvolution final : public LinearOperator {
 public:
  /// Throws what part_of() throws for the grid of a quadrant.
  MirroredConvolution(const Grid& quadrant, BlockKernel kernel, const ElasticLaw& law, const OperatorOptions& options);
  static double sent_bytes(const Grid& quadrant, const BlockKernel& kernel);

 private:
  using Transform = HalfSampleTransform;
  using Workspace = typename Transform::Workspace;
  static constexpr Index kLines = Transform::kLines;

  void do_apply(std::span<const double> traction, std::span<double> displacement) override;
  /// values: its influence table.
  FftwBuffer kernel_spectrum(Component component, std::vector<double> values) const;
  void rows_forward(int thread, Index field, Index group, const double* values);
  void rows_backward(int thread, Index field, Index group, double* values);
  void convolve_columns(int thread, Index group);
  void multiply(int thread, Index group);
  void columns_forward_diagonal(int thread, Index group);
  void columns_backward_diagonal(int thread, Index group);

  Index fields() const { return diagonal_ ? 1 : static_cast<Index>(inputs()); }
  Parity parity_of(Index field) const;
  Workspace& column_workspace(int thread, Index field) {
    return column_workspaces_[static_cast<std::size_t>(thread * fields() + field)];
  }
  static RankTranspose shared_matrix(const Grid& quadrant, Index column_groups);
  static IndexRange own_row_groups(const Grid& quadrant);
  double* of_field(Index field) { return half_transformed_.data() + field * shared_.size(); }
  double* half_transformed(Index field, Index row_group) {
    return of_field(field) + (row_group - own_row_groups_.first) * shared_.row_step();
  }
  /// One of this rank's groups of columns of half_transformed_.
  template <typename Value>
  Transform::Lines<Value> columns(Index field, Index group) {
    constexpr Index block = kLines * kLines;
    Transform::Lines<Value> lines{of_field(field) + group * block, kLines, shared_.row_step()};
    lines.run = shared_.rows_of_rank;
    lines.run_stride = shared_.columns_of_rank() * block;
    return lines;
  }

  bool diagonal_;
  int threads_;
  Transform along1_;
  Transform along2_;
  Index column_groups_;              ///< groups of kLines frequencies along x2
  std::vector<FftwBuffer> spectra_;  ///< of the distinct components: h1 rows for each group of columns
  IndexRange own_row_groups_;        ///< of this rank
  IndexRange own_column_groups_{};
  RankTranspose shared_;                      ///< a block of kLines rows by kLines columns is an entry
  FftwBuffer half_transformed_;               ///< along x2 only: h2 rows for each field and group of rows
  FftwBuffer transformed_;                    ///< diagonal only: h1 rows for each group of columns
  std::vector<Workspace> row_workspaces_;     ///< one for each thread
  std::vector<Workspace> column_workspaces_;  ///< one for each thread and field
};

}  // namespace slipstick::solver
