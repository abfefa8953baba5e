// Counts of work: against what the program's structure says must be done, and against themselves.

#include "bench/work/work_counts.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <new>

#include "bench/work/work_counts_cases.hpp"
#include "bench/work/work_counts_instructions.hpp"
#include "convergence/programs/temporary_folder.hpp"

namespace slipstick::bench {
namespace {

using namespace testing;

WorkCase case_named(const std::string& name) {
  for (const WorkCase& known : work_cases()) {
    if (known.name == name) return known;
  }
  throw std::logic_error(name);
}

std::vector<double> numbers(const CaseCounts& found) {
  const WorkCounts& counts = found.counts;
  std::vector<double> all{found.solve.applications, found.solve.pressure_applications,
                          static_cast<double>(found.solve.iterations)};
  for (const long count : {counts.plans, counts.transforms, counts.transformed_points, counts.allocations,
                           counts.allocated_bytes, counts.kernel_evaluations}) {
    all.push_back(static_cast<double>(count));
  }
  return all;
}

TEST(WorkCounts, SeeEveryWayToAllocate) {
  const WorkCounts before = work_counts();
  void* const one = ::operator new(8);  // which, unlike a new expression, compilers may not leave out
  void* const several = ::operator new[](80);
  void* volatile plain = malloc(100);
  void* volatile zeroed = calloc(3, 7);
  const WorkCounts counts = work_counts() - before;
  ::operator delete(one);
  ::operator delete[](several);
  free(plain);
  free(zeroed);
  EXPECT_EQ(counts.allocations, 4);
  EXPECT_EQ(counts.allocated_bytes, 8 + 80 + 100 + 21);
}

constexpr long kCells = 64;
/// Rows go through in pairs; of the columns of a real field's spectrum one more than half are distinct, the
/// padded field's 2 x 64. Each is transformed in two halves of 64 points.
constexpr long kTransformsOfAField = 2 * (kCells / 2 + kCells + 1);

TEST(WorkCounts, OneApplicationTransformsTwoFieldsThereAndBack) {
  const WorkCounts counts = count_work(case_named("application-64")).counts;
  EXPECT_EQ(counts.transforms, 2 * 2 * kTransformsOfAField);
  EXPECT_EQ(counts.transformed_points, kCells * counts.transforms);
  EXPECT_EQ(counts.allocations, 0);
  EXPECT_EQ(counts.plans, 0);
  EXPECT_EQ(counts.kernel_evaluations, 0);
}

TEST(WorkCounts, SetUpIntegratesOneSideOfTheDiagonal) {
  constexpr long rows_at_a_time = 8;  // which begin where the first of them meets the diagonal
  long evaluations = 0;
  for (long row = 0; row < kCells; ++row) evaluations += kCells - row / rows_at_a_time * rows_at_a_time;
  const WorkCounts counts = count_work(case_named("setup-64")).counts;
  EXPECT_EQ(counts.kernel_evaluations, evaluations);
  EXPECT_EQ(counts.transforms, 3 * kTransformsOfAField) << "K11, K12, K22";
  EXPECT_GE(counts.allocated_bytes, static_cast<long>(3 * kCells * kCells * sizeof(double)));
}

TEST(WorkCounts, AreTheSameAgainAndAfterOthers) {
  for (const char* name : {"dense-16", "ellipse-64"}) {
    const std::vector<double> first = numbers(count_work(case_named(name)));
    count_work(case_named("direct-16"));
    EXPECT_EQ(numbers(count_work(case_named(name))), first) << name;
  }
}

TEST(WorkCounts, SummationTransformsNothingButItsPreconditioner) {
  const CaseCounts direct = count_work(case_named("direct-16"));
  const CaseCounts dense = count_work(case_named("dense-16"));
  EXPECT_EQ(direct.solve.applications, dense.solve.applications);
  EXPECT_EQ(direct.counts.transforms, dense.counts.transforms);
  EXPECT_GT(direct.solve.applications, 1.0);
}

Instructions read(const std::string& text) {
  const convergence::TemporaryFolder folder;
  std::ofstream(folder / "out") << text;
  return read_callgrind(folder / "out");
}

/// A call's line has the inclusive cost, which is repeated at the lines of the callee.
constexpr const char* kCallgrind = R"(# callgrind format
version: 1
events: Ir
summary: 1111

ob=(1) /somewhere/program
fl=(1) ???
fn=(1) main
10 100
+2 1
cob=(2) /lib/libm.so.6
cfi=(2) ???
cfn=(2) exp
calls=7 0
* 1000
ob=(2)
fl=(2)
fn=(2)
0 1000

ob=(1)
fn=(3) other
-3 10
)";

TEST(Callgrind, IsReadByObject) {
  const Instructions found = read(std::string(kCallgrind) + "totals: 1111\n");
  EXPECT_THAT(found, Contains(Pair("program", 111)));
  EXPECT_THAT(found, Contains(Pair("libm.so.6", 1000)));
  EXPECT_EQ(found.size(), 2);
}

TEST(Callgrind, RefusesWhatDoesNotAddUp) {
  EXPECT_THROW(read(std::string(kCallgrind) + "totals: 1112\n"), std::runtime_error);
  EXPECT_THROW(read(kCallgrind), std::runtime_error);
  EXPECT_THROW(read(""), std::runtime_error);
  EXPECT_THROW(read("events: Ir\ntotals: 0\n"), std::runtime_error);
}

}  // namespace
}  // namespace slipstick::bench
