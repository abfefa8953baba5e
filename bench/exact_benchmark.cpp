// The exact wing: stick ratio from a moment, twist and one traction, each beside its round-trip error.

#include <benchmark/benchmark.h>

#include <cmath>

#include "analytic/torsion.hpp"

namespace {

namespace analytic = slipstick::analytic;

void stick_ratio_from_moment(benchmark::State& state) {
  double ratio = 0.5;
  const analytic::TorsionState there = analytic::from_moment_ratio(ratio);
  state.counters["error"] =
      std::abs(analytic::from_stick_ratio(there.stick_ratio).moment_ratio / ratio - 1.0);
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(ratio);
    benchmark::DoNotOptimize(analytic::from_moment_ratio(ratio));
  }
}

void state_from_stick_ratio(benchmark::State& state) {
  double c = 0.5;
  state.counters["error"] =
      std::abs(analytic::from_twist(analytic::from_stick_ratio(c).twist).stick_ratio / c - 1.0);
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(c);
    benchmark::DoNotOptimize(analytic::from_stick_ratio(c));
  }
}

void one_traction(benchmark::State& state) {
  const analytic::TorsionState torsion = analytic::from_stick_ratio(0.5);
  double radius = 0.4;
  // Continuity at the stick edge is what the closed form of the stick zone must meet.
  state.counters["error"] = std::abs(
      analytic::traction(torsion, std::nextafter(0.5, 0.0)) / analytic::traction(torsion, 0.5) - 1.0);
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(radius);
    benchmark::DoNotOptimize(analytic::traction(torsion, radius));
  }
}

BENCHMARK(stick_ratio_from_moment);
BENCHMARK(state_from_stick_ratio);
BENCHMARK(one_traction);

}  // namespace
