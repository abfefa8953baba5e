// One tangential application by each operator, beside its error against another operator and its time over
// that of four bare padded transforms. A wrong operator is reported and not timed.

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <memory>
#include <random>
#include <type_traits>

#include "bench/four_transforms.hpp"
#include "bench/side_by_side.hpp"
#include "solver/convolution.hpp"
#include "solver/linear_operator.hpp"

namespace {

using slipstick::bench::FourTransforms;
using slipstick::bench::seconds;
using slipstick::solver::Grid;
using slipstick::solver::Index;
using slipstick::solver::Operator;
using slipstick::solver::OperatorKind;
using slipstick::solver::OperatorOptions;

template <typename Real>
constexpr double kAllowedError = std::is_same_v<Real, double> ? 1e-12 : 1e-6;
/// Direct summation of a full field takes longer than it is worth beyond this: there, cells far apart are
/// loaded.
constexpr Index kLargestFullReference = 128;

slipstick::solver::ElasticPair pair() { return slipstick::solver::elastic_pair({2.0, 0.3}, {2.0, 0.3}); }

Eigen::ArrayXd random_field(const Grid& grid) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::ArrayXd field = Eigen::ArrayXd::NullaryExpr(2 * grid.cells(), [&] { return uniform(generator); });
  const Index apart = grid.n1 <= kLargestFullReference ? 1 : 2 * grid.cells() / 255;
  for (Index i = 0; i < field.size(); ++i) {
    if (i % apart != 0) field[i] = 0.0;
  }
  return field;
}

template <typename Real>
std::unique_ptr<Operator<Real>> make(OperatorKind kind, const Grid& grid, const OperatorOptions& options) {
  if constexpr (std::is_same_v<Real, double>) {
    return make_operator(kind, grid, slipstick::solver::tangential_kernel(), pair(), options);
  } else {
    return make_single_operator(grid, slipstick::solver::tangential_kernel(), pair(), options);
  }
}

template <typename Real>
Eigen::ArrayXd apply(Operator<Real>& op, const Eigen::ArrayXd& traction) {
  using Field = typename Operator<Real>::Field;
  Field displacement(traction.size());
  op.apply(Field(traction.cast<Real>()), displacement);
  return displacement.template cast<double>();
}

/// Against direct summation; direct summation against convolution.
template <typename Real>
double error(Operator<Real>& op, OperatorKind kind) {
  const auto reference =
      make<double>(kind == OperatorKind::direct ? OperatorKind::dcfft : OperatorKind::direct, op.grid(), {});
  const Eigen::ArrayXd traction = random_field(op.grid());
  const Eigen::ArrayXd expected = apply(*reference, traction);
  return (apply(op, traction) - expected).abs().maxCoeff() / expected.abs().maxCoeff();
}

template <typename Real>
void time_application(benchmark::State& state, OperatorKind kind, const OperatorOptions& options = {}) {
  const Index n = state.range(0);
  const Grid grid{n, n, 1.0, 1.0};
  const auto op = make<Real>(kind, grid, options);
  state.counters["error"] = error(*op, kind);
  if (!(state.counters["error"] <= kAllowedError<Real>)) {
    state.SkipWithError("disagrees with its reference");
    return;
  }
  const typename Operator<Real>::Field in = Operator<Real>::Field::Random(2 * grid.cells());
  typename Operator<Real>::Field out(in.size());
  const auto application = [&] {
    op->apply(in, out);
    benchmark::DoNotOptimize(out.data());
  };
  if (kind == OperatorKind::dcfft) {
    const unsigned flags = options.measure_plans ? FFTW_MEASURE : FFTW_ESTIMATE;
    FourTransforms<Real> transforms(n, flags);
    const auto times = slipstick::bench::side_by_side([&] { return seconds(application); },
                                                      [&] { return seconds(transforms); });
    state.counters["over_four_transforms"] = times.ratio;
  }
  for ([[maybe_unused]] auto _ : state) application();
  state.counters["bytes"] = static_cast<double>(op->bytes());
}

void tangential_application(benchmark::State& state, OperatorKind kind, const OperatorOptions& options = {}) {
  time_application<double>(state, kind, options);
}
void single_tangential_application(benchmark::State& state, OperatorKind kind) {
  time_application<float>(state, kind);
}

void tangential_set_up(benchmark::State& state) {
  const Grid grid{state.range(0), state.range(0), 1.0, 1.0};
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(make<double>(OperatorKind::dcfft, grid, {}));
  }
}

void four_bare_transforms(benchmark::State& state) {
  FourTransforms<double> transforms(state.range(0));
  for ([[maybe_unused]] auto _ : state) transforms();
}

constexpr OperatorOptions kMeasured{.measure_plans = true};

BENCHMARK_CAPTURE(tangential_application, dense, OperatorKind::dense)->RangeMultiplier(2)->Range(8, 32);
BENCHMARK_CAPTURE(tangential_application, direct, OperatorKind::direct)->RangeMultiplier(2)->Range(8, 128);
BENCHMARK_CAPTURE(tangential_application, dcfft, OperatorKind::dcfft)->RangeMultiplier(2)->Range(8, 1024);
BENCHMARK_CAPTURE(tangential_application, dcfft_measured, OperatorKind::dcfft, kMeasured)->Arg(512);
BENCHMARK_CAPTURE(single_tangential_application, dcfft, OperatorKind::dcfft)
    ->RangeMultiplier(2)
    ->Range(8, 1024);
BENCHMARK(tangential_set_up)->RangeMultiplier(2)->Range(128, 1024);
BENCHMARK(four_bare_transforms)->RangeMultiplier(2)->Range(8, 1024);

}  // namespace
