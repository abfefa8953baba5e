// Coulomb's method beside others: the paper's at the same error of the tractions, and accelerated projected
// gradients at the same gap of the certificate. A solution that is wrong is reported and not timed.

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bench/suite/checked_solve.hpp"
#include "bench/suite/suite.hpp"
#include "bench/timing/side_by_side.hpp"
#include "solver/contact/certificate.hpp"
#include "solver/contact/coulomb_method.hpp"
#include "solver/contact/paper_method.hpp"
#include "solver/contact/projected_gradient.hpp"
#include "solver/pressure.hpp"

namespace slipstick::bench {
namespace {

using solver::Index;
using solver::Scene;

double tolerance_of_digits(int digits) { return std::pow(10.0, -digits); }

/// A torsional problem on the whole grid of a scene, as the methods take it.
struct Torsion {
  solver::Elasticity elasticity;
  solver::Grid grid;
  solver::TangentialProblem problem;
};

Torsion torsion_of(const Scene& scene) {
  const solver::Model model = solver::make_model(scene);
  Torsion torsion{.elasticity = {.law = model.law}, .grid = model.grid, .problem = {}};
  torsion.problem.friction_bound =
      model.friction * solver::find_pressure(scene, model, scene.steps[0]).pressure;
  torsion.problem.moment = *solver::value_if<solver::MomentRatio>(scene.steps[0].torsion) *
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

/// The benchmark's own time is the first one's.
template <typename First, typename Second>
void time_both(Prepared& prepared, const First& first, const Second& second) {
  show_ratio(prepared, side_by_side([&] { return seconds(first); }, [&] { return seconds(second); }));
  prepared.timing = repeated(first);
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
    CheckedSolution checked = solve_and_check(scene);
    const bool right = checked.invalid_reason.empty();
    const double error = checked.errors.traction.at_centres.l2;
    const bool better = !best || !best->checked.invalid_reason.empty() ||
                        (right && error < best->checked.errors.traction.at_centres.l2);
    if (better) best = {scene, std::move(checked), right && error <= 1.1 * wanted_error};
  }
  return *best;
}

std::map<std::string, benchmark::Counter> counters(const Loosest& coulomb, const Loosest& paper) {
  auto both = counters(coulomb.checked);
  for (const auto& [name, value] : counters(paper.checked)) both["paper_" + name] = value;
  both["tolerance"] = coulomb.scene.tolerance;
  both["paper_tolerance"] = paper.scene.tolerance;
  both["paper_gets_as_near"] = paper.as_good ? 1.0 : 0.0;
  return both;
}

void time_methods(Prepared& prepared, const Scene& coulomb, const Scene& paper, bool whole) {
  if (whole) {
    return time_both(
        prepared, [coulomb] { solver::solve(coulomb); }, [&] { solver::solve(paper); });
  }
  time_both(
      prepared,
      [torsion = torsion_of(coulomb), tolerance = coulomb.tolerance] { by_coulomb(torsion, tolerance); },
      [torsion = torsion_of(coulomb), tolerance = paper.tolerance] { by_paper(torsion, tolerance); });
}

/// What is timed: the tractions alone, or the whole solve; Coulomb's method to 1e-8, or to the loosest
/// tolerance at which its tractions are as good.
struct Timed {
  bool whole;
  bool both_loosest;
};

/// The paper's method is to get the tractions that Coulomb's method has at 1e-8; its path, and with that its
/// applications, hang on the last bits of the pressure.
Prepared against_paper_method(Index cells, double moment_ratio, const Timed& timed) {
  const Scene scene = paper_scene(cells, moment_ratio);
  Scene by_the_paper = scene;
  by_the_paper.method = solver::Method::paper;
  Loosest coulomb{scene, solve_and_check(scene), true};
  const double wanted_error = coulomb.checked.errors.traction.at_centres.l2;
  if (timed.both_loosest) coulomb = loosest(scene, wanted_error);
  const Loosest paper = loosest(by_the_paper, wanted_error);
  Prepared prepared{.counters = counters(coulomb, paper),
                    .invalid_reason = coulomb.checked.invalid_reason + paper.checked.invalid_reason};
  if (prepared.invalid_reason.empty()) time_methods(prepared, coulomb.scene, paper.scene, timed.whole);
  return prepared;
}

double gap(const Torsion& torsion, const solver::TangentialSolution& solution) {
  return solver::certify({solution.traction, solution.elastic_displacement, solution.slip},
                         torsion.problem.friction_bound, solver::rotation_field(torsion.grid),
                         *torsion.problem.moment)
      .gap;
}

/// Why a solution, or two of one problem, must not be timed. Each lies within its gap of the least energy,
/// so that |q - q'|_K^2 <= (sqrt(gap) + sqrt(gap'))^2 |q|_K^2.
std::string invalid_reason(const Torsion& torsion, const solver::TangentialSolution& one,
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

Prepared against_projected_gradient(const Scene& scene, int digits) {
  const double tolerance = tolerance_of_digits(digits);
  const auto torsion = std::make_shared<Torsion>(torsion_of(scene));
  const auto coulomb = by_coulomb(*torsion, tolerance);
  const auto gradient = by_projected_gradient(*torsion, tolerance);
  Prepared prepared{.counters = {{"applications", solver::finest_grid_applications(coulomb.grids)},
                                 {"gradient_applications", solver::finest_grid_applications(gradient.grids)},
                                 {"gap", gap(*torsion, coulomb)},
                                 {"gradient_gap", gap(*torsion, gradient)}},
                    .invalid_reason = invalid_reason(*torsion, coulomb, gradient, tolerance)};
  if (!prepared.invalid_reason.empty()) return prepared;
  time_both(
      prepared, [torsion, tolerance] { by_coulomb(*torsion, tolerance); },
      [torsion, tolerance] { by_projected_gradient(*torsion, tolerance); });
  return prepared;
}

/// An ellipse of nearly 2 : 1, cells nearly square.
Scene ellipse_scene(Index cells, double moment_ratio) {
  Scene scene = shipped_scene("ellipse");
  scene.cells = {cells, cells / 2};
  scene.steps[0].torsion = solver::MomentRatio{moment_ratio};
  scene.model = solver::ModelChoice::full;
  return scene;
}

std::string load_name(Index cells, int permille) {
  return fmt::format("/cells:{}/permille:{}", cells, permille);
}

void add_paper_pairs(Suite& suite, Index cells, int permille) {
  const auto add = [&](const std::string& what, const Timed& timed) {
    const std::string prefix = cells == 256 && permille != 990 && !timed.whole ? "" : "long/";
    suite.add(prefix + "paired/coulomb_over_paper/" + what + load_name(cells, permille),
              [=] { return against_paper_method(cells, 1e-3 * permille, timed); });
  };
  add("traction", {.whole = false, .both_loosest = false});
  add("whole", {.whole = true, .both_loosest = false});
  add("both_loosest", {.whole = false, .both_loosest = true});
}

void add_gradient_pairs(Suite& suite, Index cells, int permille, int digits) {
  const std::string name = load_name(cells, permille) + fmt::format("/digits:{}", digits);
  const std::string prefix = cells == 128 && permille == 900 && digits != 6 ? "" : "long/";
  const std::string family = "paired/coulomb_over_projected_gradient/";
  const double moment_ratio = 1e-3 * permille;
  suite.add(prefix + family + "sphere" + name,
            [=] { return against_projected_gradient(paper_scene(cells, moment_ratio), digits); });
  suite.add(prefix + family + "ellipse" + name,
            [=] { return against_projected_gradient(ellipse_scene(cells, moment_ratio), digits); });
}

}  // namespace

void add_methods_benchmarks(Suite& suite) {
  for (const int permille : {500, 900, 990}) {
    for (const Index cells : {128, 256, 512}) add_paper_pairs(suite, cells, permille);
    for (const Index cells : {64, 128, 256}) {
      for (const int digits : {4, 6, 8}) add_gradient_pairs(suite, cells, permille, digits);
    }
  }
}

}  // namespace slipstick::bench
