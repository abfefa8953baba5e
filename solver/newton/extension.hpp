#pragma once

#include <Eigen/Core>
#include <array>

#include "solver/grid/own_rows.hpp"
#include "solver/grid/packing.hpp"
#include "solver/grid/sweep.hpp"

namespace slipstick::solver {

struct TangentSpace;

/// Continues a field smoothly from the cells that are free into those beside them, and its adjoint.
///
/// With S the operator's inverse on the whole plane, the inverse on the free cells alone is the least of E^T
/// S E over all E that leave a field as it is there. E = 0 elsewhere, as a projector has it, cuts residuals
/// off at the edges of the free cells and answers them several times too strongly. On a half-plane the best
/// E is a mean with weights that fall as the square of the distance. Here the mean is over a few neighbours,
/// and over a few of blocks of cells, and of blocks of these.
///
/// A vector that slips is free along a line. Across it is continued into as beyond the contact, and along it
/// by as much as its stiffness holds it fast.
class Extension {
 public:
  using Field = Eigen::ArrayXd;

  /// For fields of one or two components on a grid.
  Extension(const Grid& grid, Index components);

  /// What is free, once its preconditioner is known. Fields that are given here need be known in the grid's
  /// own rows alone; the rows beside them are filled in. packing: of the space.
  void prepare(const TangentSpace& space, const Packing& packing);
  /// free: 1 in the cells that are, 0 elsewhere. Components are continued alike.
  void prepare(const Field& free);
  /// y, zero where no cell is free: its continuation is added there. Allocates nothing.
  void extend(Field& y);
  /// The adjoint: to y in the free cells it adds what it has where extend() writes. Allocates nothing.
  void collect(Field& y);

  /// Pressures below zero, and those of cells that are not free, go to the free cells beside them, by the
  /// adjoint: it is close to what these answer once the others carry nothing. Clipping negative pressures
  /// without handing them on would open the neighbourhood too far, and the next state would hold too few
  /// cells. packing: of all of these fields. Overwrites the last two, and what prepare() left.
  void hand_on(Packing& packing, const Field& free, Eigen::ArrayXd& p, Field& stays, Field& leaves);

 private:
  static constexpr Index kReach = 2;
  /// Cells of a row that are summed at once.
  static constexpr Index kChunk = 256;
  using Line = Eigen::Array<double, kChunk + 2 * kReach, 1>;
  /// The blocks of a field's cells, each with the field's sum there, and what reaches it from blocks near by.
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
  static void add_means(const Level& blocks, Index component, Index row, Index column, Index count,
                        Line& sums);
  void fill_blocks(const double* in, Index component);
  void spread_blocks(Index component);
  template <std::size_t components, typename Take>
  void spread(const Field& in, const Take& take);
  template <std::size_t components>
  void multiply(Index first, Index count, std::array<Line, components>& values) const;
  template <std::size_t components>
  void extend_all(Field& y);
  template <std::size_t components>
  void collect_all(Field& y);

  Grid grid_;
  std::array<Level, 2> blocks_;
  Eigen::ArrayXf weights_;      ///< a matrix each cell, of the sums near by: entry by entry
  Field work_;                  ///< 0 but in mixed_
  Sweep mixed_;                 ///< over the blocks of cells that reach each other, and are not all free
  bool knows_contact_ = false;  ///< of vectors, which stays
};

}  // namespace slipstick::solver
