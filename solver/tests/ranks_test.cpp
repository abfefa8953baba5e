#include <gtest/gtest.h>

#include "solver/elasticity/inverse_symbol.hpp"
#include "solver/grid/own_rows.hpp"
#include "solver/grid/sweep.hpp"
#include "solver/mpi/communicator.hpp"
#include "solver/newton/tangent_space.hpp"
#include "solver/tests/fields.hpp"

/// Started by mpirun on any number of ranks, which find the bits that each finds on its own; on one it is a
/// test like any other.
namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Joins the ranks before the tests and leaves them afterwards.
class RanksOfTheTests : public testing::Environment {
 public:
  void SetUp() override { joined_ = std::make_unique<JoinedRanks>(); }
  void TearDown() override { joined_.reset(); }
  Ranks ranks() const { return joined_->ranks(); }

 private:
  std::unique_ptr<JoinedRanks> joined_;
};
auto* const kJoined = new RanksOfTheTests;
const auto* const kEnvironment = testing::AddGlobalTestEnvironment(kJoined);

/// Odd, prime and fast lengths, fewer rows than ranks, rows for some of the ranks only.
std::vector<Grid> grids() {
  return {{1, 1, 1.0, 1.0},   {9, 2, 1.0, 0.7},   {23, 31, 1.0, 1.3},
          {45, 46, 1.0, 1.0}, {64, 48, 1.0, 1.0}, {130, 7, 1.0, 1.0}};
}

template <typename Field>
auto values(Field& field) {
  return std::span(field.data(), static_cast<std::size_t>(field.size()));
}

/// Results of work(grid) where this rank has the whole grid, and where all of them share it.
template <typename Work>
void expect_same_bits(const Work& work, const char* what, Grid grid) {
  const auto alone = work(grid);
  grid.ranks = kJoined->ranks();
  const auto together = work(grid);
  ASSERT_EQ(alone.size(), together.size());
  EXPECT_TRUE((alone == together).all())
      << what << " on " << grid.n1 << " x " << grid.n2 << (grid.quadrant ? ", a quadrant" : "");
}

auto applied_twice(LinearOperator& op, const ArrayXd& traction) {
  Eigen::ArrayXd displacement(static_cast<Index>(op.outputs()) * op.grid().cells());
  // Twice: the second time in buffers that the first has used.
  for (int again = 0; again < 2; ++again) op.apply(traction, displacement);
  return displacement;
}

TEST(Ranks, EveryRowBelongsToOneRank) {
  for (const Index count : {0, 1, 2, 5, 64, 1000}) {
    for (const int number : {1, 2, 3, 4, 7, 100}) {
      const PlannedRanks planned(number);
      const Index bands = (count + rows_of_band(count) - 1) / rows_of_band(count);
      EXPECT_LE(bands, kMaxBands);
      Index next = 0;
      for (int rank = 0; rank < number; ++rank) {
        const IndexRange share = Ranks::share(bands, rank, number);
        EXPECT_EQ(share.first, next);
        EXPECT_GE(share.count(), 0);
        next = share.last;
      }
      EXPECT_EQ(next, bands);
      EXPECT_GE(rows_of_rank(count, planned.ranks()) * number, count);
    }
  }
}

TEST(RanksOperator, HasTheBitsOfOneRank) {
  for (Grid cells : grids()) {
    for (const bool quadrant : {false, true}) {
      cells.quadrant = quadrant;
      for (const BlockKernel& kernel :
           {normal_kernel(), tangential_kernel(), coupling_kernel(), shear_kernel()}) {
        if (quadrant && kernel != normal_kernel() && kernel != tangential_kernel()) continue;
        const ArrayXd traction = random_field(static_cast<Index>(kernel.inputs) * cells.cells(), 7);
        expect_same_bits(
            [&](const Grid& grid) {
              const auto op = make_operator(OperatorKind::dcfft, grid, kernel, dissimilar_pair());
              return applied_twice(*op, traction);
            },
            "displacements", cells);
      }
    }
  }
}

TEST(RanksPreconditioner, HasTheBitsOfOneRank) {
  for (Grid cells : grids()) {
    for (const bool quadrant : {false, true}) {
      cells.quadrant = quadrant;
      for (const BlockKernel& kernel : {normal_kernel(), tangential_kernel()}) {
        expect_same_bits(
            [&](const Grid& grid) {
              ArrayXd field = random_field(static_cast<Index>(kernel.inputs) * grid.cells(), 5);
              const auto symbol = make_inverse_symbol(grid, kernel, dissimilar_pair());
              for (int again = 0; again < 2; ++again) symbol->apply(values(field));
              share_rows(grid, field);
              return field;
            },
            "preconditioned fields", cells);
      }
    }
  }
}

TEST(RanksExtension, HasTheBitsOfOneRank) {
  for (const Grid& cells : grids()) {
    expect_same_bits(
        [&](const Grid& grid) {
          ArrayXd contact = (random_field(grid.cells(), 3) > 0.0).cast<double>();
          const Packing packing(grid, Sweep(grid, contact), 2);
          TangentSpace space(2, packing.cells());
          ArrayXd field = packing.packed(random_field(2 * grid.cells(), 4));
          packing.cells().each([&](Index first, Index last) {
            for (Index i = first; i < last; ++i) {
              space.set(i, true);
              if (field[i] > 0.0) space.set_line(i, 0.6, 0.8, field[i], 1.0);
            }
            space.project(first, last, field);
          });
          field = packing.unpacked(field);
          Extension extension(grid, 2);
          extension.prepare(space, packing);
          extension.extend(field);
          extension.collect(field);
          share_rows(grid, field);
          return field;
        },
        "continued fields", cells);
  }
}

TEST(RanksSweep, CountsAndSumsAsOneRank) {
  for (const Grid& cells : grids()) {
    expect_same_bits(
        [&](const Grid& grid) {
          const ArrayXd field = random_field(grid.cells(), 9).max(0.0);
          const Sweep positive(grid, field);
          const double sum = positive.sum<double>([&](Index first, Index last, double& part) {
            part += field.segment(first, last - first).sum();
          });
          return ArrayXd{{static_cast<double>(positive.count()), sum}};
        },
        "sums", cells);
  }
}

/// Bytes that this rank has sent so far.
double sent_bytes() {
  const Ranks ranks = kJoined->ranks();
  return ranks.several() ? ranks.communicator().sent().bytes : 0.0;
}

double over_all_ranks(double own) {
  const std::vector<double> all = kJoined->ranks().of_each(own);
  return std::accumulate(all.begin(), all.end(), 0.0);
}

/// Between the passes goes the half of the padded plane that is not zero, there and back: 64 bytes a cell for
/// two fields, of whole grids with the Nyquist column besides.
TEST(RanksOperator, SendsWhatIsPredictedAndNoZeros) {
  for (const bool quadrant : {false, true}) {
    const Grid grid{128, 96, 1.0, 1.0, quadrant, kJoined->ranks()};
    const auto op = make_operator(OperatorKind::dcfft, grid, tangential_kernel(), dissimilar_pair());
    const ArrayXd traction = random_field(2 * grid.cells(), 3);
    ArrayXd displacement(traction.size());
    const double before = over_all_ranks(sent_bytes());
    const double after_asking = over_all_ranks(sent_bytes());
    op->apply_own(traction, displacement);
    const double sent = over_all_ranks(sent_bytes()) - after_asking - (after_asking - before);
    EXPECT_EQ(sent, predicted_sent_bytes(grid, tangential_kernel()));
    const double others = 1.0 - 1.0 / kJoined->ranks().number();
    EXPECT_LE(sent, 64.0 * static_cast<double>(grid.n1 * (grid.n2 + 1)) * others);
  }
}

}  // namespace
}  // namespace slipstick::solver
