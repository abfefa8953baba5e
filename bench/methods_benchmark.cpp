// Coulomb's method beside others: the paper's at the same error of the tractions, and accelerated projected
// gradients at the same gap of the certificate. A solution that is wrong is reported and not timed.

#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "bench/checked_solve.hpp"
#include "bench/side_by_side.hpp"
#include "solver/certificate.hpp"
#include "solver/coulomb_method.hpp"
#include "solver/paper_method.hpp"
#include "solver/pressure.hpp"
#include "solver/projected_gradient.hpp"

namespace {

namespace solver = slipstick::solver;
using slipstick::bench::CheckedSolution;
using slipstick::bench::SideBySide;
using solver::Scene;

double tolerance_of_digits(std::int64_t digits) { return std::pow(10.0, -static_cast<double>(digits)); }

double moment_ratio(const benchmark::State& state) { return 1e-3 * static_cast<double>(state.range(1)); }

/// The benchmark's own time is that of Coulomb's method.
void show_times(benchmark::State& state, const SideBySide& times, const std::string& other) {
  for ([[maybe_unused]] auto _ : state) state.SetIterationTime(times.first);
  state.counters["over_" + other] = times.ratio;
  state.counters["over_" + other + "_cpu"] = times.cpu_ratio;
  state.counters[other + "_seconds"] = times.second;
}

/// A torsional problem on the whole grid of a scene, as the methods take it.
struct Torsion {
  solver::Elasticity elasticity;
  solver::Grid grid;
  solver::TangentialProblem problem;
};

Torsion torsion_of(const Scene& scene) {
  const solver::Model model = solver::make_model(scene);
  Torsion torsion{.elasticity = {.pair = model.pair}, .grid = model.grid, .problem = {}};
  torsion.problem.friction_bound =
      model.friction * solver::find_pressure(scene, model, scene.steps[0]).pressure;
  torsion.problem.moment = *scene.steps[0].torsion.moment_ratio *
                           solver::moment_limit(torsion.grid, torsion.problem.friction_bound);
  return torsion;
}

solver::TangentialSolution by_coulomb(const Torsion& torsion, double tolerance) {
  return solver::solve_by_coulomb_method(torsion.elasticity, torsion.grid, torsion.problem,
                                         {.tolerance = tolerance, .progress = {}});
}

/// The operator is set up each time, as Coulomb's method does.
solver::TangentialSolution by_paper(const Torsion& torsion, double tolerance) {
  const auto op = torsion.elasticity.make(torsion.grid, solver::tangential_kernel());
  return solver::solve_by_paper_method(*op, torsion.problem, {.tolerance = tolerance, .progress = {}});
}

/// Likewise.
solver::TangentialSolution by_projected_gradient(const Torsion& torsion, double tolerance) {
  const auto op = torsion.elasticity.make(torsion.grid, solver::tangential_kernel());
  solver::TangentialSolution solution = solver::solve_by_projected_gradient(
      *op, torsion.problem, {.tolerance = tolerance, .start = {}, .progress = {}});
  solution.grids = {{torsion.grid.n1, torsion.grid.n2, op->applications(), solution.iterations, 0.0}};
  return solution;
}

/// Both timed to return their seconds.
template <typename First, typename Second>
SideBySide time_both(const First& first, const Second& second) {
  return slipstick::bench::side_by_side([&] { return slipstick::bench::seconds(first); },
                                        [&] { return slipstick::bench::seconds(second); });
}

/// A method with the loosest tolerance that gets the tractions as right as they can be.
struct Loosest {
  Scene scene;
  CheckedSolution checked;
  bool as_good = false;  ///< within 10 % of the error asked for; else the best there is
};

Loosest loosest(Scene scene, double wanted_error) {
  std::optional<Loosest> best;
  for (int digits = 2; digits <= 8 && !(best && best->as_good); ++digits) {
    scene.tolerance = tolerance_of_digits(digits);
    CheckedSolution checked = slipstick::bench::solve_and_check(scene);
    const bool right = checked.objection.empty();
    const double error = checked.errors.traction.at_centres.l2;
    const bool better = !best || !best->checked.objection.empty() ||
                        (right && error < best->checked.errors.traction.at_centres.l2);
    if (better) best = {scene, std::move(checked), right && error <= 1.1 * wanted_error};
  }
  return *best;
}

void show_methods(benchmark::State& state, const Loosest& coulomb, const Loosest& paper) {
  state.counters["traction_error"] = coulomb.checked.errors.traction.at_centres.l2;
  state.counters["paper_traction_error"] = paper.checked.errors.traction.at_centres.l2;
  state.counters["twist_error"] = coulomb.checked.errors.twist;
  state.counters["paper_twist_error"] = paper.checked.errors.twist;
  state.counters["applications"] = coulomb.checked.solution.operator_applications;
  state.counters["paper_applications"] = paper.checked.solution.operator_applications;
  state.counters["tolerance"] = coulomb.scene.tolerance;
  state.counters["paper_tolerance"] = paper.scene.tolerance;
  state.SetLabel(paper.as_good ? "the paper's method gets as near" : "the paper's method never gets as near");
}

void time_methods(benchmark::State& state, const Scene& coulomb, const Scene& paper, bool whole) {
  if (whole) {
    const auto total = [](const Scene& scene) { return solver::solve(scene).seconds.total; };
    show_times(state,
               slipstick::bench::side_by_side([&] { return total(coulomb); }, [&] { return total(paper); }),
               "paper");
    return;
  }
  const Torsion torsion = torsion_of(coulomb);
  show_times(
      state,
      time_both([&] { by_coulomb(torsion, coulomb.tolerance); }, [&] { by_paper(torsion, paper.tolerance); }),
      "paper");
}

/// What is timed: the tractions alone, or the whole solve; Coulomb's method to 1e-8, or to the loosest
/// tolerance at which its tractions are as good.
struct Contest {
  bool whole;
  bool both_loosest;
};

/// The paper's method is to get the tractions that Coulomb's method has at 1e-8; its path, and with that its
/// applications, hang on the last bits of the pressure.
void against_paper_method(benchmark::State& state, const Contest& contest) {
  const Scene scene = slipstick::bench::paper_scene(state.range(0), moment_ratio(state));
  Scene by_the_paper = scene;
  by_the_paper.method = solver::Method::paper;
  Loosest coulomb{scene, slipstick::bench::solve_and_check(scene), true};
  const double wanted_error = coulomb.checked.errors.traction.at_centres.l2;
  if (contest.both_loosest) coulomb = loosest(scene, wanted_error);
  const Loosest paper = loosest(by_the_paper, wanted_error);
  const std::string objection = coulomb.checked.objection + paper.checked.objection;
  if (!objection.empty()) {
    state.SkipWithError(objection.c_str());
    return;
  }
  show_methods(state, coulomb, paper);
  time_methods(state, coulomb.scene, paper.scene, contest.whole);
}

double gap(const Torsion& torsion, const solver::TangentialSolution& solution) {
  return solver::certify({solution.traction, solution.elastic_displacement, solution.slip},
                         torsion.problem.friction_bound, solver::rotation_field(torsion.grid),
                         *torsion.problem.moment)
      .gap;
}

/// Why a solution, or two of one problem, must not be timed. Each lies within its gap of the least energy,
/// hence |q - q'|_K^2 <= (sqrt(gap) + sqrt(gap'))^2 |q|_K^2.
std::string objection(const Torsion& torsion, const solver::TangentialSolution& one,
                      const solver::TangentialSolution& other, double tolerance) {
  for (const auto* solution : {&one, &other}) {
    if (solution->status != solver::Status::converged) return solution->message;
    if (const double own = gap(torsion, *solution); !(own <= tolerance)) {
      return fmt::format("certificate {:.3g} above the tolerance {:.3g}", own, tolerance);
    }
  }
  const Eigen::ArrayXd apart = one.traction - other.traction;
  const double distance = (apart * (one.elastic_displacement - other.elastic_displacement)).sum();
  const double size = (one.traction * one.elastic_displacement).sum();
  return distance <= 4.0 * tolerance * size ? "" : "the two methods' tractions differ";
}

void against_projected_gradient(benchmark::State& state, const Scene& scene) {
  const double tolerance = tolerance_of_digits(state.range(2));
  const Torsion torsion = torsion_of(scene);
  const auto coulomb = by_coulomb(torsion, tolerance);
  const auto gradient = by_projected_gradient(torsion, tolerance);
  if (const std::string why_not = objection(torsion, coulomb, gradient, tolerance); !why_not.empty()) {
    state.SkipWithError(why_not.c_str());
    return;
  }
  state.counters["applications"] = solver::finest_grid_applications(coulomb.grids);
  state.counters["gradient_applications"] = solver::finest_grid_applications(gradient.grids);
  state.counters["gap"] = gap(torsion, coulomb);
  state.counters["gradient_gap"] = gap(torsion, gradient);
  show_times(
      state,
      time_both([&] { by_coulomb(torsion, tolerance); }, [&] { by_projected_gradient(torsion, tolerance); }),
      "gradient");
}

void against_projected_gradient_on_sphere(benchmark::State& state) {
  against_projected_gradient(state, slipstick::bench::paper_scene(state.range(0), moment_ratio(state)));
}

/// An ellipse of nearly 2 : 1, cells nearly square.
void against_projected_gradient_on_ellipse(benchmark::State& state) {
  Scene scene = slipstick::bench::shipped_scene("ellipse");
  scene.cells = {state.range(0), state.range(0) / 2};
  scene.steps[0].torsion = {.moment_ratio = moment_ratio(state), .moment = {}, .twist = {}};
  scene.model = solver::ModelChoice::full;
  against_projected_gradient(state, scene);
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

BENCHMARK_CAPTURE(against_paper_method, traction, Contest{.whole = false, .both_loosest = false})
    ->Apply(load)
    ->ArgsProduct({{128, 256, 512}, {500, 900, 990}});
BENCHMARK_CAPTURE(against_paper_method, whole, Contest{.whole = true, .both_loosest = false})
    ->Apply(load)
    ->ArgsProduct({{128, 256, 512}, {500, 900, 990}});
BENCHMARK_CAPTURE(against_paper_method, both_loosest, Contest{.whole = false, .both_loosest = true})
    ->Apply(load)
    ->ArgsProduct({{128, 256, 512}, {500, 900, 990}});
BENCHMARK(against_projected_gradient_on_sphere)
    ->Apply(load_and_tolerance)
    ->ArgsProduct({{64, 128, 256}, {500, 900, 990}, {4, 6, 8}});
BENCHMARK(against_projected_gradient_on_ellipse)
    ->Apply(load_and_tolerance)
    ->ArgsProduct({{64, 128, 256}, {500, 900, 990}, {4, 6, 8}});

}  // namespace
