#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "solver/elasticity/law/elastic_law.hpp"
#include "solver/elasticity/operator_kind.hpp"
#include "solver/grid/grid.hpp"
#include "solver/grid/own_rows.hpp"
#include "solver/grid/packing.hpp"

namespace slipstick::solver {

/// The components of a block operator: outputs x inputs of them, row by row.
struct BlockKernel {
  std::size_t outputs;
  std::size_t inputs;
  std::vector<Component> components;
  std::vector<Component> distinct() const;
  bool operator==(const BlockKernel&) const = default;
};

/// u3 = K33 p; (u1, u2) = K (q1, q2); (u1, u2) = (K13, K23) p; K13 q1 + K23 q2, which is -u3 by shear.
BlockKernel normal_kernel();
BlockKernel tangential_kernel();
BlockKernel coupling_kernel();
BlockKernel shear_kernel();

/// The influence operator from tractions to displacements on one grid. Methods see elasticity only through
/// this class, so that the three ways of summation and all laws are interchangeable.
class LinearOperator {
 public:
  using Field = Eigen::ArrayXd;

  virtual ~LinearOperator() = default;
  LinearOperator(const LinearOperator&) = delete;
  LinearOperator& operator=(const LinearOperator&) = delete;

  /// displacement = K * traction: outputs()*cells and inputs()*cells values. They may be the same, but not
  /// overlap in part. Allocates nothing. Throws std::invalid_argument for other sizes.
  void apply(std::span<const double> traction, std::span<double> displacement) {
    apply_own(traction, displacement);
    share_rows(grid_, displacement);
  }

  /// The same in this rank's rows; tractions are read only there.
  void apply_own(std::span<const double> traction, std::span<double> displacement) {
    const auto cells = static_cast<std::size_t>(grid_.cells());
    if (traction.size() != inputs() * cells || displacement.size() != outputs() * cells) {
      throw std::invalid_argument("operator applied to fields of another size");
    }
    do_apply(traction, displacement);
    ++applications_;
  }

  void apply(const Field& traction, Field& displacement) {
    apply(std::span(traction.data(), static_cast<std::size_t>(traction.size())),
          std::span(displacement.data(), static_cast<std::size_t>(displacement.size())));
  }

  void apply_own(const Field& traction, Field& displacement) {
    apply_own(std::span(traction.data(), static_cast<std::size_t>(traction.size())),
              std::span(displacement.data(), static_cast<std::size_t>(displacement.size())));
  }

  /// The same in new memory.
  Field applied(const Field& traction) {
    Field displacement(static_cast<Index>(outputs()) * grid_.cells());
    apply(traction, displacement);
    return displacement;
  }

  /// The same with packed fields.
  void apply_own(const Field& traction, Field& displacement, Packing& packing) {
    packing.on_grid(traction, displacement, [&](const Field& x, Field& y) { apply_own(x, y); });
  }

  const Grid& grid() const { return grid_; }
  std::size_t inputs() const { return kernel_.inputs; }
  std::size_t outputs() const { return kernel_.outputs; }
  /// Applications so far.
  long applications() const { return applications_; }
  void restart_count() { applications_ = 0; }
  /// Its memory that may be overwritten between applications: of a convolution on a whole grid scratch_size() at least.
  virtual std::span<double> idle_memory() { return {}; }

 protected:
  LinearOperator(const Grid& grid, BlockKernel kernel) : grid_(grid), kernel_(std::move(kernel)) {}
  const BlockKernel& kernel() const { return kernel_; }

 private:
  virtual void do_apply(std::span<const double> traction, std::span<double> displacement) = 0;

  Grid grid_;
  BlockKernel kernel_;
  long applications_ = 0;
};

/// The part of a contact whose fields are stored: the whole grid; the quadrant x1, x2 > 0, whose mirror
/// images are the other three; a square quadrant with a mirror at the diagonal, q2(x1, x2) = -q1(x2, x1), so
/// that only q1 is read, and u2 is the image of u1.
enum class Part { whole, quadrant, diagonal };

/// The part of a kernel's fields on a grid. Pressures are even in both coordinates; q1 is even in x1 and odd
/// in x2, q2 odd in x1 and even in x2. diagonal: true if the diagonal is a mirror. Throws
/// std::invalid_argument if kernel or grid have no such mirrors.
Part part_of(const Grid& grid, const BlockKernel& kernel, bool diagonal);

/// Writes the second component of a field of Part::diagonal on n x n cells from rows of the first, while these are in
/// cache.
void mirror_rows(double* field, Index n, const IndexRange& rows);

/// Options of an operator and its preconditioner.
struct OperatorOptions {
  int threads = 1;
  bool diagonal = false;          ///< see part_of()
  bool at_edge = false;           ///< true if fields reach the edge of a whole grid
  std::span<double> memory = {};  ///< scratch for the preconditioner's applications; not owned
};

/// Numbers of `memory` that hold a field of a whole grid in addition to what applications of the preconditioner take.
std::size_t scratch_size(const Grid& grid, const BlockKernel& kernel, const OperatorOptions& options);
/// The operator for the fields of part_of(). Throws as that, and std::invalid_argument for a kind other than
/// dcfft on a part of a grid.
std::unique_ptr<LinearOperator> make_operator(OperatorKind kind, const Grid& grid, const BlockKernel& kernel,
                                              const ElasticLaw& law, const OperatorOptions& options = {});

/// Bytes that all ranks together send in one application by discrete convolution.
double predicted_sent_bytes(const Grid& grid, const BlockKernel& kernel);

}  // namespace slipstick::solver
