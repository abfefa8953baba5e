#include "solver/grid/sweep.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "solver/allocations/allocations.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// How often each cell is visited.
std::vector<int> visits(const Sweep& sweep) {
  std::vector<std::atomic<int>> counts(static_cast<std::size_t>(sweep.size()));
  sweep.each([&](Index first, Index last) {
    EXPECT_LT(first, last);
    for (Index i = first; i < last; ++i) ++counts[static_cast<std::size_t>(i)];
  });
  return {counts.begin(), counts.end()};
}

/// Cells here and there, neighbours and lone ones.
ArrayXd scattered(Index cells, unsigned seed, double part) {
  const ArrayXd random = random_field(cells, seed);
  return (random < part).select(random + 2.0, 0.0);
}

TEST(Sweep, VisitsEachOfItsCellsOnce) {
  for (const int threads : {1, 2, 3, 7}) {
    const ThreadPool pool(threads);
    for (const Index cells : {1, 2, 63, 64, 65, 1000, 20011}) {
      for (const double part : {-2.0, -0.98, 0.0, 0.9, 2.0}) {
        const ArrayXd field = scattered(cells, 3, part);
        const Sweep sweep(field);
        EXPECT_EQ(sweep.size(), cells);
        EXPECT_EQ(sweep.count(), (field != 0.0).count());
        const std::vector<int> counts = visits(sweep);
        for (Index i = 0; i < cells; ++i) EXPECT_EQ(counts[static_cast<std::size_t>(i)], field[i] != 0.0) << i;
      }
    }
  }
}

double sum_of(const Sweep& sweep, const ArrayXd& field) {
  return sweep.sum<double>([&](Index first, Index last, double& sum) {
    for (Index i = first; i < last; ++i) sum += field[i];
  });
}

/// A disc, a ring and two discs side by side are smooth; spots on every other cell, and scattered ones, are ragged.
TEST(Sweep, IsRaggedWhereItsCellsLieInSpots) {
  const Grid grid{64, 48, 1.0, 1.0};
  const auto ragged = [&](const auto& contains) {
    ArrayXd field(grid.cells());
    for (Index cell = 0; cell < grid.cells(); ++cell) {
      const double x1 = grid.x1(cell / grid.n2);
      const double x2 = grid.x2(cell % grid.n2);
      field[cell] = contains(cell, x1, x2) ? 1.0 : 0.0;
    }
    return Sweep(grid, field).is_ragged();
  };
  EXPECT_FALSE(ragged([](Index, double x1, double x2) { return std::hypot(x1, x2) < 20.0; }));
  EXPECT_FALSE(ragged([](Index, double x1, double x2) { return std::abs(std::hypot(x1, x2) - 18.0) < 4.0; }));
  EXPECT_FALSE(ragged([](Index, double x1, double x2) { return std::hypot(std::abs(x1) - 15.0, x2) < 12.0; }));
  EXPECT_TRUE(ragged([](Index cell, double, double) { return cell % 2 == 0; }));
  const ArrayXd spots = scattered(grid.cells(), 5, 0.0);
  EXPECT_TRUE(ragged([&](Index cell, double, double) { return spots[cell] != 0.0; }));
}

TEST(Sweep, SumsTheSameOnAnyNumberOfThreads) {
  constexpr Index kCells = 300007;
  const Sweep sweep(scattered(kCells, 5, 0.3));
  const ArrayXd values = random_field(kCells, 6).exp() * 1e3;
  const double alone = sum_of(sweep, values);
  EXPECT_NEAR(alone, (scattered(kCells, 5, 0.3) != 0.0).select(values, 0.0).sum(), 1e-12 * alone);
  for (const int threads : {2, 3, 4, 8, 64}) {
    const ThreadPool pool(threads);
    EXPECT_EQ(sum_of(sweep, values), alone) << threads;
  }
}

TEST(Sweep, AllocatesNothingInAPool) {
  const ThreadPool pool(2);
  const Sweep sweep(scattered(100000, 7, 0.5));
  const ArrayXd values = random_field(100000, 8);
  const long before = allocations();
  const double sum = sum_of(sweep, values);
  EXPECT_EQ(allocations(), before);
  EXPECT_NE(sum, 0.0);
}

/// A loop gets its number of parts whatever the size of the pool.
TEST(ThreadPool, RunsEachPartOnce) {
  for (const int size : {1, 2, 4}) {
    const ThreadPool pool(size);
    EXPECT_EQ(ThreadPool::available(), size);
    for (int round = 0; round < 200; ++round) {
      for (const int threads : {1, 2, 3, 5}) {
        std::vector<int> done(static_cast<std::size_t>(threads));
        std::atomic<Index> covered = 0;
        in_parts(threads, 17, [&](int thread, Index first, Index last) {
          ++done[static_cast<std::size_t>(thread)];
          covered += last - first;
        });
        EXPECT_EQ(done, std::vector<int>(static_cast<std::size_t>(threads), 1));
        EXPECT_EQ(covered, 17);
      }
    }
  }
  EXPECT_EQ(ThreadPool::available(), 1);
}

TEST(ThreadPool, StepsBackForAnotherOne) {
  const ThreadPool outer(3);
  {
    const ThreadPool inner(2);
    EXPECT_EQ(ThreadPool::available(), 2);
  }
  EXPECT_EQ(ThreadPool::available(), 3);
}

}  // namespace
}  // namespace slipstick::solver
