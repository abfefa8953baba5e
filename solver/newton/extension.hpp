#pragma once

#include <Eigen/Core>
#include <array>

#include "solver/grid/own_rows.hpp"
#include "solver/grid/packing.hpp"
#include "solver/grid/sweep.hpp"

namespace slipstick::solver {

struct TangentSpace;

/// A smooth continuation E of fields from the free cells to their neighbours, and its adjoint E^T.
///
/// With S the inverse of the operator on the whole plane, the inverse on the free cells is the least E^T S E
/// over all E that keep the field there. E = 0 elsewhere, a plain projector, cuts residuals off at the edges
/// of the free cells, and the preconditioned residual is several times too large. On a half-plane the best E
/// is a mean with weights that fall as the square of the distance. Here:
///
/// 1. prepare(): the matrix of weights of each cell, from the free parts of its neighbours.
/// 2. extend(): each cell takes its weights times a sum over few neighbours, over few blocks of cells, and
///    over few blocks of blocks.
/// 3. collect(): the same sums of the weighted values, added to the free cells.
///
/// A slipping vector is free along a line. Across the line it is continued as outside the contact, along it
/// in proportion to its stiffness.
class Extension {
 public:
  using Field = Eigen::ArrayXd;

  /// For fields of one or two components on a grid. memory: scratch, used if it holds such a field; not owned.
  Extension(const Grid& grid, Index components, std::span<double> memory = {});

  /// From a space whose preconditioner is set; packing: the space's. Fields of the functions here need be
  /// known only in this rank's rows; adjacent rows are exchanged.
  void prepare(const TangentSpace& space, const Packing& packing);
  /// free: 1 in the cells that are, 0 elsewhere. Components are continued alike.
  void prepare(const Field& free);
  /// Adds to y, which is zero where no cell is free, its continuation. Allocates nothing.
  void extend(Field& y);
  /// The adjoint: adds to y in the free cells. Allocates nothing.
  void collect(Field& y);

  /// Moves negative pressures, and pressures of cells that are not free, to nearby free cells by the adjoint,
  /// which approximates the elastic response to their removal. Clipping them would open the neighbourhood too
  /// far, and the next active set would be too small. packing: of all these fields. stays, leaves:
  /// overwritten. prepare() is due before the next extend().
  void redistribute(Packing& packing, const Field& free, Eigen::ArrayXd& p, Field& stays, Field& leaves);

 private:
  static constexpr Index kReach = 2;
  /// Cells of a row that are summed at once.
  static constexpr Index kChunk = 256;
  using Line = Eigen::Array<double, kChunk + 2 * kReach, 1>;
  /// Blocks of cells, the sum of a field over each, and the weighted sum over nearby blocks.
  struct Level {
    Index n1, n2;
    Field sums, means;
  };
  /// A symmetric matrix of vectors; of scalars its first entry.
  using Matrix = std::array<double, 3>;

  template <typename IsFree>
  void prepare_scalars(const IsFree& is_free);
  template <typename IsFree>
  void find_mixed(const IsFree& is_free, bool free_is_whole);
  template <typename FreePart, typename Weights>
  void prepare_with(const FreePart& free_part, const Weights& weights);
  static Line near_sums(const double* in, Index n1, Index n2, Index row, Index first, Index last);
  static void add_means(const Level& blocks, Index component, Index row, Index column, Index count, Line& sums);
  void fill_blocks(const double* in, Index component);
  void spread_blocks(Index component);
  template <std::size_t components, typename Take>
  void spread(const double* in, const Take& take);
  template <std::size_t components>
  void multiply(Index first, Index count, std::array<Line, components>& values) const;
  template <std::size_t components>
  void extend_all(Field& y);
  template <std::size_t components>
  void collect_all(Field& y);

  Grid grid_;
  std::array<Level, 2> blocks_;
  Eigen::ArrayXf weights_;      ///< a matrix each cell, of the sums near by: entry by entry
  Field own_work_;              ///< empty where memory is given
  Eigen::Map<Field> work_;      ///< of a field
  Sweep mixed_;                 ///< over the blocks of cells that reach each other, and are not all free
  Sweep around_;                ///< over the other blocks next to these
  bool knows_contact_ = false;  ///< of vectors, which stays
};

}  // namespace slipstick::solver
