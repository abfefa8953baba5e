#include <gtest/gtest.h>

#include <memory>
#include <numeric>

#include "solver/grid/own_rows.hpp"
#include "solver/mpi/communicator.hpp"
#include "solver/tests/fields.hpp"

/// Started by mpirun on any number of ranks; on one it is a test like any other. Whole solves on several
/// ranks have the bits of one (convergence/solve/tests/ranks_test.py).
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

TEST(Ranks, EveryRowBelongsToOneRank) {
  for (const Index count : {0, 1, 2, 5, 64, 1000}) {
    for (const int number : {1, 2, 3, 4, 7, 100}) {
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
      EXPECT_GE(rows_of_rank(count, Ranks::planned(number)) * number, count);
    }
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
