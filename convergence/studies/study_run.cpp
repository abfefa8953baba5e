#include "convergence/studies/study_run.hpp"

#include <numeric>
#include <span>

#include "convergence/results/provenance.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/studies/budget.hpp"
#include "convergence/studies/study_judgement.hpp"
#include "convergence/studies/study_plan.hpp"

namespace slipstick::convergence {
namespace {

/// Times that a study tightens a tolerance by itself, from 1e-8 to 1e-12.
constexpr int kMaxTightenings = 2;

/// The runs of a series to its tolerance, mesh by mesh: its grids, the tightened one, the rounded ones.
std::vector<RunSpec> series_runs(const Study& study, const Series& series) {
  std::vector<RunSpec> runs;
  for (const Mesh& mesh : series.meshes) {
    for (const GridChoice& grid : mesh.grids) runs.push_back(make_run(study, grid, series.tolerance));
    const BudgetRuns parts =
        budget_runs(make_run(study, mesh.grids.front(), series.tolerance), series.tolerance);
    runs.push_back(parts.tightened);
    if (mesh.rounded) runs.insert(runs.end(), parts.rounded.begin(), parts.rounded.end());
  }
  return runs;
}

/// The results of series_runs(), taken from the front of `found`.
std::vector<MeshResults> take_series(const Series& series, std::span<const Json>& found) {
  const auto take = [&](std::size_t count) {
    const std::vector<Json> taken(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    found = found.subspan(count);
    return taken;
  };
  std::vector<MeshResults> results;
  for (const Mesh& mesh : series.meshes) {
    MeshResults& at = results.emplace_back();
    at.grids = take(mesh.grids.size());
    at.tightened = take(1).front();
    if (mesh.rounded) at.rounded = take(2);
  }
  return results;
}

bool varies_tolerance(const Study& study) { return study.tolerances.size() > 1; }

/// The runs of a series to the tolerances of the study and to one that is tighter than all, mesh by mesh.
std::vector<RunSpec> tolerance_runs(const Study& study, const Series& series) {
  std::vector<RunSpec> runs;
  for (const Mesh& mesh : series.meshes) {
    for (const double tolerance : study.tolerances)
      runs.push_back(make_run(study, mesh.grids.front(), tolerance));
    runs.push_back(make_run(study, mesh.grids.front(), kTightening * study.tolerances.back()));
  }
  return runs;
}

/// The results of tolerance_runs() by mesh, taken from the front of `found`.
std::vector<std::vector<Json>> take_tolerances(const Study& study, const Series& series,
                                               std::span<const Json>& found) {
  const std::size_t count = study.tolerances.size() + 1;
  std::vector<std::vector<Json>> by_mesh;
  for (std::size_t i = 0; i < series.meshes.size(); ++i) {
    by_mesh.emplace_back(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    found = found.subspan(count);
  }
  return by_mesh;
}

/// Solves in parallel and counts the failures.
std::vector<Json> solve_all(const std::vector<RunSpec>& runs, const ProcessPool& pool, FailedRuns& failed) {
  std::vector<Json> results = to_json(pool.run(runs));
  for (std::size_t i = 0; i < runs.size(); ++i) failed.add(run_text(runs[i]), results[i]);
  return results;
}

/// Solves the series, again and to tighter tolerances where the iteration error shows.
std::vector<std::vector<MeshResults>> solve_series(const Study& study, std::vector<Series>& all,
                                                   const ProcessPool& pool, FailedRuns& failed) {
  std::vector<std::vector<MeshResults>> results(all.size());
  std::vector<std::size_t> open(all.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  for (int pass = 0; !open.empty(); ++pass) {
    std::vector<RunSpec> runs;
    for (const std::size_t i : open) {
      const std::vector<RunSpec> more = series_runs(study, all[i]);
      runs.insert(runs.end(), more.begin(), more.end());
    }
    const std::size_t listed_before = pool.lacking();
    const std::vector<Json> solved = solve_all(runs, pool, failed);
    if (pool.lacking() > listed_before) break;
    std::span<const Json> found(solved);
    for (const std::size_t i : open) results[i] = take_series(all[i], found);
    std::erase_if(open, [&](std::size_t i) {
      return pass == kMaxTightenings || all[i].meshes.size() < 2 ||
             !needs_tightening(study, all[i], results[i]);
    });
    for (const std::size_t i : open) {
      all[i].tolerance *= kTightening;
      ++all[i].tightenings;
    }
  }
  return results;
}

}  // namespace

StudyResult run_study(const Study& study, const ProcessPool& pool) {
  std::vector<Series> all = make_series(study, pool.memory_limit());
  StudyResult result{.name = study.name, .scene = study.scene.string(), .shifts = study.shifts};
  const std::size_t listed_before = pool.lacking();
  const auto results = solve_series(study, all, pool, result.failed_runs);
  const bool is_judged = pool.lacking() == listed_before;
  for (std::size_t i = 0; i < all.size() && is_judged; ++i)
    result.series.push_back(judge_series(study, all[i], results[i]));
  if (varies_tolerance(study)) {
    std::vector<RunSpec> runs;
    for (const Series& series : all) {
      const std::vector<RunSpec> more = tolerance_runs(study, series);
      runs.insert(runs.end(), more.begin(), more.end());
    }
    const std::vector<Json> solved = solve_all(runs, pool, result.failed_runs);
    std::span<const Json> found(solved);
    for (std::size_t i = 0; i < all.size() && is_judged; ++i) {
      const auto by_mesh = take_tolerances(study, all[i], found);
      result.series[i].tolerances = tolerance_rows(study, all[i], by_mesh, results[i]);
    }
  }
  result.provenance = provenance(1);
  return result;
}

}  // namespace slipstick::convergence
