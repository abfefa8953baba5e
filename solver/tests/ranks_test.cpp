#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "solver/grid/ranks.hpp"
#include "solver/operator/linear_operator.hpp"
#include "solver/tests/fields.hpp"

/// Started by mpirun on any number of ranks; on one it is a test like any other.
namespace slipstick::solver {
namespace {

/// Starts MPI before the tests and ends it after them.
class RanksOfTheTests : public testing::Environment {
 public:
  void SetUp() override { ranks_ = std::make_unique<Ranks>(); }
  void TearDown() override { ranks_.reset(); }

 private:
  std::unique_ptr<Ranks> ranks_;
};
const auto* const kRanks = testing::AddGlobalTestEnvironment(new RanksOfTheTests);

/// Transforms and sums round by a few eps of the largest displacement.
constexpr double kOfTwoWays = 1e-13;
constexpr double kOfSinglePrecision = 1e-5;

std::vector<BlockKernel> kernels() {
  return {normal_kernel(), tangential_kernel(), coupling_kernel(), shear_kernel()};
}

/// Odd, prime and fast lengths; of the first ones some of the ranks have no rows or no columns.
std::vector<Grid> grids() {
  return {{1, 1, 1.0, 1.0}, {9, 2, 1.0, 0.7}, {23, 31, 1.0, 1.3}, {64, 48, 1.0, 1.0}};
}

double sum_over_ranks(double own) {
  const std::vector<double> all = Ranks::of_each(own);
  return std::accumulate(all.begin(), all.end(), 0.0);
}

TEST(RanksShare, EveryRowBelongsToOneRank) {
  for (const Index count : {0, 1, 2, 5, 64}) {
    for (const int number : {1, 2, 3, 4, 7}) {
      Index next = 0;
      for (int rank = 0; rank < number; ++rank) {
        const Share share = Ranks::share(count, rank, number);
        EXPECT_EQ(share.first, next);
        EXPECT_GE(share.count(), 0);
        next = share.last;
      }
      EXPECT_EQ(next, count);
    }
  }
}

TEST(RanksOperator, IsThePlainSumOnAnyNumberOfRanks) {
  for (const BlockKernel& kernel : kernels()) {
    for (const Grid& grid : grids()) {
      const Eigen::ArrayXd traction = random_field(static_cast<Index>(kernel.inputs) * grid.cells(), 7);
      Eigen::ArrayXd expected(static_cast<Index>(kernel.outputs) * grid.cells());
      Eigen::ArrayXd found(expected.size());
      make_operator(OperatorKind::direct, grid, kernel, dissimilar_pair())->apply(traction, expected);
      const auto shared = make_operator(OperatorKind::dcfft, grid, kernel, dissimilar_pair());
      for (int again = 0; again < 2; ++again) {
        shared->apply(traction, found);
        EXPECT_LE((found - expected).abs().maxCoeff(), kOfTwoWays * traction.abs().sum())
            << grid.n1 << " x " << grid.n2;
      }
      Eigen::ArrayXf single(expected.size());
      make_single_operator(grid, kernel, dissimilar_pair())->apply(traction.cast<float>().eval(), single);
      EXPECT_LE((single.cast<double>() - expected).abs().maxCoeff(),
                kOfSinglePrecision * traction.abs().sum())
          << grid.n1 << " x " << grid.n2;
    }
  }
}

/// Between the passes goes the half of the padded plane that is not zero, there and back: 64 bytes a cell
/// for two fields, and the Nyquist column. What makes fields whole again comes on top, 16 bytes a cell to
/// each other rank.
TEST(RanksOperator, SendsNoZeros) {
  const Grid grid{64, 48, 1.0, 1.0};
  const auto shared = make_operator(OperatorKind::dcfft, grid, tangential_kernel(), dissimilar_pair());
  const Eigen::ArrayXd traction = random_field(2 * grid.cells(), 3);
  Eigen::ArrayXd displacement(traction.size());
  const double before = sum_over_ranks(Ranks::sent());
  shared->apply(traction, displacement);
  const double others = Ranks::number() - 1;
  const double whole = 16.0 * static_cast<double>(grid.cells()) * others;
  const double between_passes = sum_over_ranks(Ranks::sent()) - before - whole;
  EXPECT_LE(between_passes, 64.0 * static_cast<double>(grid.n1 * (grid.n2 + 1)) * others / (others + 1.0));
  EXPECT_GE(between_passes, 32.0 * static_cast<double>(grid.cells()) * others / (others + 1.0));
}

TEST(RanksOperator, HoldsItsShareAsPredicted) {
  const Grid grid{256, 256, 1.0, 1.0};
  const auto shared = make_operator(OperatorKind::dcfft, grid, tangential_kernel(), dissimilar_pair());
  const double predicted = predicted_bytes(OperatorKind::dcfft, grid, tangential_kernel());
  for (const double bytes : Ranks::of_each(static_cast<double>(shared->bytes()))) {
    EXPECT_LE(bytes, 1.1 * predicted);
  }
  const double held = sum_over_ranks(static_cast<double>(shared->bytes()));
  const double one = 112.0 * static_cast<double>(grid.cells());  // three spectra, two half planes
  EXPECT_LE(held, 1.3 * one);
}

}  // namespace
}  // namespace slipstick::solver
