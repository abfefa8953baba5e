// Whole solves of the paper's scene, beside the errors that they buy: over four bare padded transforms, with
// what symmetry leaves out over the full model, mixed over double precision, at one tolerance over another. A
// solution that is wrong is reported and not timed.

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "bench/checked_solve.hpp"
#include "bench/four_transforms.hpp"
#include "bench/side_by_side.hpp"

namespace {

using slipstick::bench::CheckedSolution;
using slipstick::bench::FourTransforms;
using slipstick::bench::SideBySide;
using slipstick::solver::Index;
using slipstick::solver::Scene;

/// range(0): cells along a side; range(1): the moment in thousandths of its limit.
Scene scene_of(const benchmark::State& state) {
  return slipstick::bench::paper_scene(state.range(0), 1e-3 * static_cast<double>(state.range(1)));
}

double seconds_of(const Scene& scene) { return slipstick::solver::solve(scene).seconds.total; }

/// False if it must not be timed.
bool accept(benchmark::State& state, const CheckedSolution& checked) {
  if (!checked.objection.empty()) state.SkipWithError(checked.objection.c_str());
  return checked.objection.empty();
}

void show_errors(benchmark::State& state, const CheckedSolution& checked) {
  state.counters["twist_error"] = checked.errors.twist;
  state.counters["traction_error"] = checked.errors.traction.at_centres.l2;
  state.counters["gap"] = checked.solution.certificate.gap;
}

void show_work(benchmark::State& state, const CheckedSolution& checked) {
  const auto& cells = checked.solution.model.grid;
  const double padded_cells = 4.0 * static_cast<double>(cells.n1 * cells.n2);
  state.counters["applications"] = checked.solution.operator_applications;
  state.counters["pressure_applications"] = checked.solution.pressure_applications;
  state.counters["doubles_per_padded_cell"] =
      static_cast<double>(checked.solution.bytes) / sizeof(double) / padded_cells;
}

/// The benchmark's own time is the first one's; `name` is first over second.
void show_times(benchmark::State& state, const SideBySide& times, const std::string& name) {
  for ([[maybe_unused]] auto _ : state) state.SetIterationTime(times.first);
  state.counters[name] = times.ratio;
  state.counters[name + "_cpu"] = times.cpu_ratio;
}

void whole_solve(benchmark::State& state) {
  const Scene scene = scene_of(state);
  const CheckedSolution checked = slipstick::bench::solve_and_check(scene);
  if (!accept(state, checked)) return;
  show_errors(state, checked);
  show_work(state, checked);
  FourTransforms<double> transforms(state.range(0));
  show_times(state,
             slipstick::bench::side_by_side([&] { return seconds_of(scene); },
                                            [&] { return slipstick::bench::seconds(transforms); },
                                            {.seconds = 2.0, .most_seconds = 20.0}),
             "over_four_transforms");
}

/// The errors and the work shown are those of the scene; `standard` is checked as well.
void time_against(benchmark::State& state, const Scene& scene, const Scene& standard,
                  const std::string& name) {
  const CheckedSolution checked = slipstick::bench::solve_and_check(scene);
  const CheckedSolution other = slipstick::bench::solve_and_check(standard);
  if (!accept(state, checked) || !accept(state, other)) return;
  show_errors(state, checked);
  show_work(state, checked);
  state.counters[name + "_in_memory"] =
      static_cast<double>(checked.solution.bytes) / static_cast<double>(other.solution.bytes);
  show_times(
      state,
      slipstick::bench::side_by_side([&] { return seconds_of(scene); }, [&] { return seconds_of(standard); }),
      name);
}

void symmetric_model(benchmark::State& state) {
  const Scene full = scene_of(state);
  Scene automatic = full;
  automatic.model = slipstick::solver::ModelChoice::automatic;
  time_against(state, automatic, full, "over_full");
}

void mixed_precision(benchmark::State& state) {
  const Scene in_double = scene_of(state);
  Scene mixed = in_double;
  mixed.precision = slipstick::solver::Precision::mixed;
  time_against(state, mixed, in_double, "over_double");
}

/// range(2): digits of the tolerance. Over the same solve at 1e-8.
void tolerance(benchmark::State& state) {
  const Scene standard = scene_of(state);
  Scene scene = standard;
  scene.tolerance = std::pow(10.0, -static_cast<double>(state.range(2)));
  time_against(state, scene, standard, "over_8_digits");
}

/// The rounds are within one iteration.
void once(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);
}
void load(benchmark::internal::Benchmark* benchmark) {
  once(benchmark);
  benchmark->ArgNames({"cells", "permille"});
}
void load_and_tolerance(benchmark::internal::Benchmark* benchmark) {
  once(benchmark);
  benchmark->ArgNames({"cells", "permille", "digits"});
}

BENCHMARK(whole_solve)->Apply(load)->ArgsProduct({{64, 128, 256, 512, 1024}, {500, 900, 990}});
BENCHMARK(symmetric_model)->Apply(load)->ArgsProduct({{128, 256, 512}, {500, 900, 990}});
BENCHMARK(mixed_precision)->Apply(load)->ArgsProduct({{128, 256, 512}, {500, 900, 990}});
BENCHMARK(tolerance)->Apply(load_and_tolerance)->ArgsProduct({{256}, {900}, {4, 6, 8, 10, 12}});

}  // namespace
