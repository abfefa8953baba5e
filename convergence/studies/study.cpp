#include "convergence/studies/study.hpp"

#include <numeric>

#include "convergence/results/provenance.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/run_batch.hpp"
#include "convergence/studies/budget.hpp"
#include "convergence/studies/study_plan.hpp"

namespace slipstick::convergence {
namespace {

/// Times that a study tightens a tolerance by itself, from 1e-8 to 1e-12.
constexpr int kMaxTightenings = 2;

/// Adds runs, and counts those that fail.
class CountedRuns {
 public:
  CountedRuns(RunBatch& batch, FailedRuns& failed) : batch_(batch), failed_(failed) {}
  void add(const RunSpec& run, RunBatch::Take take) {
    batch_.add(run, [&failed = failed_, name = run_text(run), take = std::move(take)](const Json& result) {
      failed.add(name, result);
      take(result);
    });
  }

 private:
  RunBatch& batch_;
  FailedRuns& failed_;
};

/// The runs of a series to its tolerance; `results` is filled when they are solved, and must stay until then.
void add_runs(const Study& study, const Series& series, CountedRuns runs, std::vector<MeshResults>& results) {
  results.assign(series.meshes.size(), {});
  for (std::size_t i = 0; i < series.meshes.size(); ++i) {
    const Mesh& mesh = series.meshes[i];
    MeshResults& at = results[i];
    for (const GridChoice& grid : mesh.grids) {
      runs.add(make_run(study, grid, series.tolerance),
               [&at](const Json& result) { at.grids.push_back(result); });
    }
    const BudgetRuns parts =
        budget_runs(make_run(study, mesh.grids.front(), series.tolerance), series.tolerance);
    runs.add(parts.tightened, [&at](const Json& result) { at.tightened = result; });
    if (!mesh.rounded) continue;
    for (const RunSpec& run : parts.rounded) {
      runs.add(run, [&at](const Json& result) { at.rounded.push_back(result); });
    }
  }
}

/// Solves the series, again and to tighter tolerances where the iteration shows.
std::vector<std::vector<MeshResults>> solve_series(const Study& study, std::vector<Series>& all,
                                                   const ProcessPool& pool, FailedRuns& failed) {
  std::vector<std::vector<MeshResults>> results(all.size());
  std::vector<std::size_t> open(all.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  for (int pass = 0; !open.empty(); ++pass) {
    RunBatch batch;
    for (const std::size_t i : open) add_runs(study, all[i], {batch, failed}, results[i]);
    batch.run(pool);
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

/// The tolerances that the study varies, and one tighter than all that stands for none.
/// Results mesh by mesh, filled as those of add_runs().
void add_tolerance_runs(const Study& study, const Series& series, CountedRuns runs,
                        std::vector<std::vector<Json>>& by_mesh) {
  by_mesh.assign(series.meshes.size(), {});
  for (std::size_t i = 0; i < series.meshes.size(); ++i) {
    const GridChoice& grid = series.meshes[i].grids.front();
    const auto add = [&](double tolerance) {
      runs.add(make_run(study, grid, tolerance),
               [&at = by_mesh[i]](const Json& result) { at.push_back(result); });
    };
    for (const double tolerance : study.tolerances) add(tolerance);
    add(kTightening * study.tolerances.back());
  }
}

bool varies_tolerance(const Study& study) { return study.tolerances.size() > 1; }

}  // namespace

std::vector<PreparedRun> study_runs(const Study& study, std::optional<double> memory_limit) {
  RunBatch batch;
  FailedRuns failed;
  const std::vector<Series> all = make_series(study, memory_limit);
  std::vector<std::vector<MeshResults>> results(all.size());
  std::vector<std::vector<std::vector<Json>>> by_tolerance(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    add_runs(study, all[i], {batch, failed}, results[i]);
    if (varies_tolerance(study)) add_tolerance_runs(study, all[i], {batch, failed}, by_tolerance[i]);
  }
  return batch.runs();
}

Json run_study(const Study& study, const ProcessPool& pool) {
  std::vector<Series> all = make_series(study, pool.memory_limit());
  FailedRuns failed;
  const auto results = solve_series(study, all, pool, failed);
  Json json;
  json["name"] = study.name;
  json["scene"] = study.scene.string();
  json["shifts"] = study.shifts;
  json["series"] = Json::object();
  for (std::size_t i = 0; i < all.size(); ++i) {
    json["series"][all[i].name] = judge_series(study, all[i], results[i]);
  }
  if (varies_tolerance(study)) {
    RunBatch batch;
    std::vector<std::vector<std::vector<Json>>> by_mesh(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      add_tolerance_runs(study, all[i], {batch, failed}, by_mesh[i]);
    batch.run(pool);
    for (std::size_t i = 0; i < all.size(); ++i) {
      json["series"][all[i].name]["tolerances"] = tolerance_rows(study, all[i], by_mesh[i], results[i]);
    }
  }
  json["failed_runs"] = failed.json();
  json["provenance"] = provenance(1);
  return json;
}

}  // namespace slipstick::convergence
