#include "bench/work/work_counts.hpp"

#include <fftw3.h>

#include <unordered_map>

#include "solver/allocations/allocations.hpp"
#include "solver/elasticity/law/cell_integrals.hpp"

namespace slipstick::bench {
namespace {

/// The counts so far. Allocations of the counting itself only, as negative numbers.
WorkCounts counted;

/// Points that each plan transforms. A plan that is destroyed may leave its address to another.
std::unordered_map<const void*, long>& points_of_plans() {
  static std::unordered_map<const void*, long> points;
  return points;
}

template <typename Plan>
Plan count_plan(Plan plan, long points) {
  const WorkCounts before = work_counts();
  points_of_plans()[plan] = points;  // what that allocates is not the program's
  const WorkCounts remembering = work_counts() - before;
  counted.allocations -= remembering.allocations;
  counted.allocated_bytes -= remembering.allocated_bytes;
  ++counted.plans;
  return plan;
}

void count_transform(const void* plan) {
  ++counted.transforms;
  counted.transformed_points += points_of_plans().at(plan);
}

long product(int rank, const int* lengths) {
  long points = 1;
  for (int i = 0; i < rank; ++i) points *= lengths[i];
  return points;
}

}  // namespace

WorkCounts work_counts() {
  WorkCounts counts = counted;
  counts.allocations += solver::allocations();
  counts.allocated_bytes += solver::allocated_bytes();
  return counts;
}

WorkCounts operator-(const WorkCounts& after, const WorkCounts& before) {
  return {.plans = after.plans - before.plans,
          .transforms = after.transforms - before.transforms,
          .transformed_points = after.transformed_points - before.transformed_points,
          .allocations = after.allocations - before.allocations,
          .allocated_bytes = after.allocated_bytes - before.allocated_bytes,
          .kernel_evaluations = after.kernel_evaluations - before.kernel_evaluations};
}

}  // namespace slipstick::bench

using slipstick::bench::count_plan;
using slipstick::bench::count_transform;
using slipstick::bench::counted;
using slipstick::bench::product;
using slipstick::solver::CellRow;
using slipstick::solver::Index;

extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming): the linker's names
decltype(fftw_plan_dft_1d) __real_fftw_plan_dft_1d;
decltype(fftw_plan_many_dft) __real_fftw_plan_many_dft;
decltype(fftw_plan_many_dft_r2c) __real_fftw_plan_many_dft_r2c;
decltype(fftw_plan_many_dft_c2r) __real_fftw_plan_many_dft_c2r;

fftw_plan __wrap_fftw_plan_dft_1d(int n, fftw_complex* in, fftw_complex* out, int sign, unsigned flags) {
  return count_plan(__real_fftw_plan_dft_1d(n, in, out, sign, flags), n);
}
fftw_plan __wrap_fftw_plan_many_dft(int rank, const int* n, int many, fftw_complex* in, const int* inembed, int istride,
                                    int idist, fftw_complex* out, const int* onembed, int ostride, int odist, int sign,
                                    unsigned flags) {
  return count_plan(
      __real_fftw_plan_many_dft(rank, n, many, in, inembed, istride, idist, out, onembed, ostride, odist, sign, flags),
      many * product(rank, n));
}
fftw_plan __wrap_fftw_plan_many_dft_r2c(int rank, const int* n, int many, double* in, const int* inembed, int istride,
                                        int idist, fftw_complex* out, const int* onembed, int ostride, int odist,
                                        unsigned flags) {
  return count_plan(
      __real_fftw_plan_many_dft_r2c(rank, n, many, in, inembed, istride, idist, out, onembed, ostride, odist, flags),
      many * product(rank, n));
}
fftw_plan __wrap_fftw_plan_many_dft_c2r(int rank, const int* n, int many, fftw_complex* in, const int* inembed,
                                        int istride, int idist, double* out, const int* onembed, int ostride, int odist,
                                        unsigned flags) {
  return count_plan(
      __real_fftw_plan_many_dft_c2r(rank, n, many, in, inembed, istride, idist, out, onembed, ostride, odist, flags),
      many * product(rank, n));
}

decltype(fftw_execute_dft) __real_fftw_execute_dft;
decltype(fftw_execute_dft_r2c) __real_fftw_execute_dft_r2c;
decltype(fftw_execute_dft_c2r) __real_fftw_execute_dft_c2r;

void __wrap_fftw_execute_dft(fftw_plan plan, fftw_complex* in, fftw_complex* out) {
  count_transform(plan);
  __real_fftw_execute_dft(plan, in, out);
}
void __wrap_fftw_execute_dft_r2c(fftw_plan plan, double* in, fftw_complex* out) {
  count_transform(plan);
  __real_fftw_execute_dft_r2c(plan, in, out);
}
void __wrap_fftw_execute_dft_c2r(fftw_plan plan, fftw_complex* in, double* out) {
  count_transform(plan);
  __real_fftw_execute_dft_c2r(plan, in, out);
}

// slipstick::solver::integrate_row
decltype(slipstick::solver::integrate_row) __real__ZN9slipstick6solver13integrate_rowERNS0_7CellRowEldddd;
void __wrap__ZN9slipstick6solver13integrate_rowERNS0_7CellRowEldddd(CellRow& row, Index first_block, double x, double y,
                                                                    double h1, double h2) {
  counted.kernel_evaluations += (row.xx.cols() - first_block) * slipstick::solver::kLanes;
  __real__ZN9slipstick6solver13integrate_rowERNS0_7CellRowEldddd(row, first_block, x, y, h1, h2);
}
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)
}
