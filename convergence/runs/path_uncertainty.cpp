#include "convergence/runs/path_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/history/history_state.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/step/pressure.hpp"
#include "solver/step/resolution.hpp"

namespace slipstick::convergence {
namespace {

using namespace solver;
using Eigen::ArrayXXd;

/// Cells along a side of the coarse grid, in the geometric mean: on 16 to 64 cells a path's error differs by
/// up to a quarter.
constexpr double kPathCells = 16.0;
/// Most cells along a side of a correction; its second mesh has half as many.
constexpr double kCorrectionCells = 96.0;
/// The uncertainty of a correction c by meshes of n and n/2 cells, whose differences are d apart, where the
/// slip ring is a part s of the contact's radius: kOfChange c/(n s) + kOfMeshes d + kOfCells/n^2, and the
/// second-order term. The constants are chosen so that on 96 cells it holds in all of 38 random histories: 24
/// twists of ellipsoids, 14 pushes before twists, Coulomb's and a capped law, 4, 8 and 16 parts.
constexpr double kOfChange = 1.5;
constexpr double kOfMeshes = 0.5;
constexpr double kOfCells = 8e-3;
constexpr double kLeastRing = 0.02;
/// Part of these cells that the contact must fill, at least, along its diameter.
constexpr double kPathAcross = 0.5;
/// Differences of parts are small, and each part leaves what the tolerance allows: of one part, and of all of a step.
constexpr double kPathTolerance = 1e-7;
constexpr double kToleranceOfParts = 1e-6;
/// Error of n parts over its difference from 4 n parts, so that 1 of 100 random histories is further off. An
/// error that falls like 1/n would make it 4/3, but a single part is not there yet: 1.8 to 2.4 for pushes
/// before twists and both at once, spheres and ellipsoids of up to 10 to 1; 3.0 for an ellipsoid of 2 to 1
/// that is twisted to 0.9 of its limit.
constexpr double kPathSafety = 3.3;
/// Additional factor where a step changes the normal load and another load: a single part applies both at
/// once, four parts one after the other, and the two answers may agree by chance.
constexpr double kBothAtOnce = 2.5;
/// Parts of a step in the finer history, over those in the coarse one.
constexpr int kFinerPath = 4;
/// Steps that are solved to estimate; a longer history's path is longer in proportion.
constexpr std::size_t kMaxPathSteps = 60;

Quantities times(double factor, Quantities quantities) {
  for (const auto number : kQuantities) quantities.*number *= factor;
  return quantities;
}

/// The normal load, and a tangential one.
bool changes_both(const Step& from, const Step& to) {
  const auto value = [](const Step& step) {
    return std::visit([](const auto& load) { return load.value; }, step.torsion);
  };
  return from.normal != to.normal && (from.torsion.index() != to.torsion.index() || value(from) != value(to) ||
                                      from.force != to.force || from.displacement != to.displacement);
}

/// Whether all shapes are of revolution, about one axis.
bool has_axis(const Scene& scene) {
  return scene.contact.pressure != PressureModel::file &&
         std::ranges::all_of(scene.surfaces, [&](const Surface& surface) {
           if (surface.at != scene.surfaces.front().at) return false;
           if (surface.shape == Shape::ellipsoid) return surface.radius_1 == surface.radius_2;
           return surface.shape != Shape::height_map && surface.shape != Shape::roughness;
         });
}

/// Means over squares of side x side samples; samples at the far ends that fill no square are cut off.
ArrayXXd block_means(const ArrayXXd& heights, Index side) {
  return ArrayXXd::NullaryExpr(heights.rows() / side, heights.cols() / side,
                               [&](Index i, Index j) { return heights.block(i * side, j * side, side, side).mean(); });
}

void make_coarse(Scene& scene, double cells) {
  const double mean = std::sqrt(static_cast<double>(scene.grid.cells[0] * scene.grid.cells[1]));
  if (mean <= cells) return;
  for (Index& side : scene.grid.cells) {
    side = std::max<Index>(4, 2 * std::lround(0.5 * static_cast<double>(side) * cells / mean));
  }
}

/// Cells that a circle of the first step's contact has across.
double cells_across(const Scene& scene) {
  const Model model = make_model(scene);
  const NormalSolution normal = find_pressure(scene, model, scene.steps.front());
  return 2.0 * std::sqrt(static_cast<double>((normal.pressure > 0.0).count()) / M_PI);
}

/// The scene on few cells, its map of friction left out; none where a file of pressures fixes the grid.
std::optional<Scene> on_few_cells(const Scene& scene, double cells) {
  if (scene.contact.pressure == PressureModel::file) return std::nullopt;
  Scene coarse = scene;
  coarse.contact.friction.map.clear();
  coarse.solver.op = OperatorKind::dcfft;
  coarse.solver.model = ModelChoice::automatic;
  coarse.solver.threads = 1;
  coarse.surfaces = with_heights(std::move(coarse.surfaces));
  const Surface* const map = find_height_map(coarse.surfaces);
  if (map == nullptr) {
    make_coarse(coarse, cells);
    if (!scene.grid.extent) return coarse;
    const double across = cells_across(coarse);
    if (across < kPathAcross * cells) {
      coarse.grid.cells = scene.grid.cells;
      make_coarse(coarse, cells * kPathAcross * cells / std::max(across, 1.0));
    }
    return coarse;
  }
  const Index side = std::max(map->map.heights.rows(), map->map.heights.cols()) / static_cast<Index>(4.0 * cells);
  if (side < 2) return coarse;
  for (Surface& surface : coarse.surfaces) {
    if (surface.shape != Shape::height_map) continue;
    surface.map.heights = block_means(surface.map.heights, side);
    for (double& spacing : surface.map.spacing) spacing *= static_cast<double>(side);
  }
  coarse.grid.cells = {};
  return coarse;
}

/// The scene on few cells, its map of friction as means over them. solution: of one of its steps.
std::optional<Scene> coarse_scene(const Scene& scene, const Solution& solution, double cells = kPathCells) {
  std::optional<Scene> coarse = on_few_cells(scene, cells);
  if (!coarse || !solution.friction.factors) return coarse;
  const Grid& grid = solution.grid;
  const Grid few = make_model(*coarse).grid_in_m();
  std::array<double, 2> centre{};
  if (find_height_map(scene.surfaces) != nullptr) {  // samples are cut off at its far ends
    centre = {grid.x1(0) - 0.5 * grid.h1 - (few.x1(0) - 0.5 * few.h1),
              grid.x2(0) - 0.5 * grid.h2 - (few.x2(0) - 0.5 * few.h2)};
  }
  coarse->contact.friction.factors = solution.friction.factors;
  coarse->contact.friction = resampled(std::move(coarse->contact.friction), grid, few, centre);
  return coarse;
}

/// The ends of the steps up to the first that cannot be solved.
std::vector<LoadNumbers> ends_of(Scene scene) {
  std::vector<LoadNumbers> ends;
  scene.solver.tolerance = std::min(kPathTolerance, kToleranceOfParts / scene.solver.substeps);
  SolveOptions options{.detail = Detail::loads};
  options.observer.step = [&](const Solution& at) {
    if (at.status == Status::converged) ends.push_back(at);
  };
  try {
    solve(scene, options);
  } catch (const InputError&) {
    // Few cells carry a little less, or more parts slide on their way.
  }
  return ends;
}

/// Relative changes of the twist, or else of the moment, at the end of the last step from the scene's number
/// of parts to kFinerPath times as many, from these to kFinerPath times as many, and so on: at most `count`.
/// They end where a history breaks off, or an earlier step changes more than the last one.
std::vector<double> path_changes(Scene scene, std::size_t steps, bool turns, std::size_t count) {
  const auto number = [&](const LoadNumbers& end) { return turns ? end.twist_angle : end.moment; };
  std::vector<double> changes;
  std::vector<LoadNumbers> before = ends_of(scene);
  while (changes.size() < count) {
    scene.solver.substeps *= kFinerPath;
    const std::vector<LoadNumbers> after = ends_of(scene);
    if (before.size() < steps || after.size() < steps) break;
    const auto change_of = [&](std::size_t k) {
      return (number(after[k]) - number(before[k])) / number(after[steps - 1]);
    };
    const double change = change_of(steps - 1);
    for (std::size_t k = 0; k < steps; ++k) {
      // The errors of a loading and of its reversal cancel in part: what is left was up to 4 times the change.
      if (!(std::abs(change_of(k)) <= std::abs(change))) return changes;
    }
    changes.push_back(change);
    before = after;
  }
  return changes;
}

/// Cuts the history to whole cycles of at most `steps` steps.
void shorten(Scene& scene, std::size_t steps) {
  const std::size_t cycles = std::max<std::size_t>(1, steps / scene.steps.size());
  scene.cycles = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(scene.cycles), cycles));
  if (scene.steps.size() > steps) scene.steps.resize(steps);
}

}  // namespace

bool depends_on_path(const Scene& scene, bool coupled) {
  if (scene.solver.method != Method::coulomb) return false;
  const bool one_pressure =
      std::ranges::all_of(scene.steps, [&](const Step& step) { return step.normal == scene.steps.front().normal; });
  const bool turned_only = std::ranges::none_of(scene.steps, brings_translation);
  return !(one_pressure && !coupled && turned_only && has_axis(scene));
}

PathUncertainty::PathUncertainty(const Scene& scene, const Solution& solution)
    : matters_(depends_on_path(scene, solution.coupled)) {
  if (!matters_) return;
  std::optional<Scene> coarse = coarse_scene(scene, solution);
  broke_off_ = !coarse;
  if (broke_off_) return;
  shorten(*coarse, kMaxPathSteps);
  const std::vector<LoadNumbers> ends = ends_of(*coarse);
  coarse->solver.substeps *= kFinerPath;
  const std::vector<LoadNumbers> finer = ends_of(*coarse);
  double safety = kPathSafety;
  for (std::size_t k = 0; k < std::min(ends.size(), finer.size()); ++k) {
    if (k > 0 && changes_both(step_of(scene, k - 1), step_of(scene, k))) safety = kPathSafety * kBothAtOnce;
    at_ends_.push_back(times(safety, distance(ends[k], finer[k])));
  }
  broke_off_ = at_ends_.size() < coarse->steps.size() * static_cast<std::size_t>(coarse->cycles);
}

Quantities PathUncertainty::at(std::size_t step) const {
  if (!matters_) return {};
  if (step < at_ends_.size()) return at_ends_[step];
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  if (broke_off_) return {kUnknown, kUnknown, kUnknown, kUnknown};
  return times(static_cast<double>(step + 1) / static_cast<double>(at_ends_.size()), at_ends_.back());
}

std::optional<PathCorrection> path_correction(const Scene& scene, const Solution& solution) {
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  if (scene.solver.substeps < kFewestCorrected || steps > kMaxPathSteps) return std::nullopt;
  if (!depends_on_path(scene, solution.coupled)) return std::nullopt;
  for (std::size_t k = 1; k < steps; ++k) {
    if (changes_both(step_of(scene, k - 1), step_of(scene, k))) return std::nullopt;
  }
  const double cells = std::min(kCorrectionCells, std::sqrt(static_cast<double>(solution.grid.cells())));
  const auto changes_on = [&](double few, std::size_t count) {
    const std::optional<Scene> coarse = coarse_scene(scene, solution, few);
    const bool turns = solution.resolution.number == &Quantities::twist;
    return coarse ? path_changes(*coarse, steps, turns, count) : std::vector<double>{};
  };
  const std::vector<double> fine = changes_on(cells, 1);
  const std::vector<double> few = changes_on(0.5 * cells, 2);
  if (fine.size() < 1 || few.size() < 2) return std::nullopt;
  const double change = fine[0] + few[1] + few[1] / 3.0;
  const double second = (4.0 * few[1] - few[0]) / 45.0;  // of an error c/n + d/n^2
  const double apart = std::abs(fine[0] - few[0]);
  const double ring = std::fmax(1.0 - solution.stick_radius / solution.contact_radius, kLeastRing);
  return PathCorrection{change + second, kOfChange * std::abs(change) / (cells * ring) + kOfMeshes * apart +
                                             kOfCells / (cells * cells) + std::abs(second)};
}

Solution solve_with_path(const Scene& scene, SolveOptions options) {
  if (options.detail != Detail::all) return solve(scene, options);
  std::optional<PathUncertainty> path;
  std::size_t k = options.resumed ? options.resumed->finished : 0;
  options.observer.step = [&, observe = std::move(options.observer.step)](Solution& at) {
    if (!path) {
      Stopwatch watch(nullptr);
      path.emplace(scene, at);
      const double seconds = watch.lap();
      at.seconds.setup += seconds;
      at.seconds.total += seconds;
    }
    at.resolution = with_uncertainty(at, scene, k, at.resolution.mesh, path->at(k));
    ++k;
    if (observe) observe(at);
  };
  return solve(scene, options);
}

}  // namespace slipstick::convergence
