// One tangential application by each operator, beside the error against the dense matrix or, on grids too
// large for one, against direct summation. A wrong operator is reported and not timed.

#include <benchmark/benchmark.h>
#include <fftw3.h>

#include <Eigen/Core>
#include <random>

#include "solver/convolution.hpp"
#include "solver/linear_operator.hpp"

namespace {

using slipstick::solver::Grid;
using slipstick::solver::Index;
using slipstick::solver::LinearOperator;
using slipstick::solver::OperatorKind;

constexpr double kAllowedError = 1e-12;
constexpr Index kLargestReference = 128;  ///< direct summation beyond this takes longer than it is worth

Eigen::VectorXd random_field(Index size) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(generator); });
}

Eigen::VectorXd apply(LinearOperator& op, const Eigen::VectorXd& q) {
  Eigen::VectorXd u(q.size());
  op.apply({q.data(), static_cast<std::size_t>(q.size())}, {u.data(), static_cast<std::size_t>(u.size())});
  return u;
}

void tangential_application(benchmark::State& state, OperatorKind kind) {
  const Index n = state.range(0);
  const Grid grid{n, n, 1.0, 1.0};
  const auto pair = slipstick::solver::elastic_pair({2.0, 0.3}, {2.0, 0.3});
  const auto op = make_operator(kind, grid, slipstick::solver::tangential_kernel(), pair);
  const Eigen::VectorXd q = random_field(2 * grid.cells());
  Eigen::VectorXd u = apply(*op, q);
  if (n <= kLargestReference) {
    const auto reference_kind = kind == OperatorKind::direct ? OperatorKind::dcfft : OperatorKind::direct;
    const auto reference = make_operator(reference_kind, grid, slipstick::solver::tangential_kernel(), pair);
    const Eigen::VectorXd expected = apply(*reference, q);
    const double error = (u - expected).lpNorm<Eigen::Infinity>() / expected.lpNorm<Eigen::Infinity>();
    state.counters["error"] = error;
    if (!(error <= kAllowedError)) {
      state.SkipWithError("disagrees with its reference");
      return;
    }
  }
  const std::span<const double> in{q.data(), static_cast<std::size_t>(q.size())};
  const std::span<double> out{u.data(), static_cast<std::size_t>(u.size())};
  for ([[maybe_unused]] auto _ : state) {
    op->apply(in, out);
    benchmark::DoNotOptimize(out.data());
  }
  state.counters["bytes"] = static_cast<double>(op->bytes());
}

/// The least that two forward and two backward padded transforms cost by themselves.
void four_bare_transforms(benchmark::State& state) {
  const int padded = static_cast<int>(slipstick::solver::fast_length(2 * state.range(0) - 1));
  slipstick::solver::FftwBuffer real(static_cast<std::size_t>(padded) * static_cast<std::size_t>(padded));
  slipstick::solver::FftwBuffer spectrum(static_cast<std::size_t>(padded) *
                                         static_cast<std::size_t>(padded + 2));
  const slipstick::solver::FftwPlan forward(
      fftw_plan_dft_r2c_2d(padded, padded, real.data(), spectrum.complex(), FFTW_ESTIMATE));
  const slipstick::solver::FftwPlan backward(
      fftw_plan_dft_c2r_2d(padded, padded, spectrum.complex(), real.data(), FFTW_ESTIMATE));
  for ([[maybe_unused]] auto _ : state) {
    for (int i = 0; i < 2; ++i) {
      fftw_execute(forward.get());
      fftw_execute(backward.get());
    }
  }
}

BENCHMARK_CAPTURE(tangential_application, dense, OperatorKind::dense)->RangeMultiplier(2)->Range(8, 32);
BENCHMARK_CAPTURE(tangential_application, direct, OperatorKind::direct)->RangeMultiplier(2)->Range(8, 128);
BENCHMARK_CAPTURE(tangential_application, dcfft, OperatorKind::dcfft)->RangeMultiplier(2)->Range(8, 1024);
BENCHMARK(four_bare_transforms)->RangeMultiplier(2)->Range(8, 1024);

}  // namespace
