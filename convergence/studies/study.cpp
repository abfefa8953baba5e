#include "convergence/studies/study.hpp"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "convergence/results/provenance.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/studies/budget.hpp"
#include "convergence/studies/study_judgement.hpp"
#include "convergence/studies/study_plan.hpp"

namespace slipstick::convergence {
namespace {

/// Times that a study tightens a tolerance by itself, from 1e-8 to 1e-12.
constexpr int kMaxTightenings = 2;

/// Collects runs, then hands out their results in the same order.
class StudyRuns {
 public:
  StudyRuns(const ProcessPool& pool, FailedRuns& failed) : pool_(pool), failed_(failed) {}
  std::vector<RunSpec>& runs() { return runs_; }
  void run() {
    results_ = pool_.run(runs_);
    for (std::size_t i = 0; i < runs_.size(); ++i) failed_.add(run_text(runs_[i]), results_[i]);
  }
  Json next() { return std::move(results_[taken_++]); }

 private:
  const ProcessPool& pool_;
  FailedRuns& failed_;
  std::vector<RunSpec> runs_;
  std::vector<Json> results_;
  std::size_t taken_ = 0;
};

void add_runs(const Study& study, const Series& series, std::vector<RunSpec>& runs) {
  for (const Mesh& mesh : series.meshes) {
    for (const GridChoice& grid : mesh.grids) runs.push_back(make_run(study, grid, series.tolerance));
    const BudgetRuns parts =
        budget_runs(make_run(study, mesh.grids.front(), series.tolerance), series.tolerance);
    runs.push_back(parts.tightened);
    if (mesh.rounded) runs.insert(runs.end(), parts.rounded.begin(), parts.rounded.end());
  }
}

std::vector<MeshResults> take_results(const Series& series, StudyRuns& batch) {
  std::vector<MeshResults> results;
  for (const Mesh& mesh : series.meshes) {
    MeshResults& at = results.emplace_back();
    for (std::size_t k = 0; k < mesh.grids.size(); ++k) at.grids.push_back(batch.next());
    at.tightened = batch.next();
    if (!mesh.rounded) continue;
    at.rounded = {batch.next(), batch.next()};
  }
  return results;
}

/// Solves the series, again and to tighter tolerances where the iteration shows.
std::vector<std::vector<MeshResults>> solve_series(const Study& study, std::vector<Series>& all,
                                                   const ProcessPool& pool, FailedRuns& failed) {
  std::vector<std::vector<MeshResults>> results(all.size());
  std::vector<bool> open(all.size(), true);
  for (int pass = 0; pass <= kMaxTightenings; ++pass) {
    StudyRuns batch(pool, failed);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (open[i]) add_runs(study, all[i], batch.runs());
    }
    batch.run();
    bool any = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!open[i]) continue;
      results[i] = take_results(all[i], batch);
      open[i] =
          pass < kMaxTightenings && all[i].meshes.size() > 1 && needs_tightening(study, all[i], results[i]);
      if (!open[i]) continue;
      any = true;
      all[i].tolerance *= kTightening;
      ++all[i].tightenings;
    }
    if (!any) break;
  }
  return results;
}

/// The tolerances that the study varies, and one tighter than all that stands for none.
void add_tolerance_runs(const Study& study, const Series& series, std::vector<RunSpec>& runs) {
  for (const Mesh& mesh : series.meshes) {
    const GridChoice& grid = mesh.grids.front();
    for (const double tolerance : study.tolerances) runs.push_back(make_run(study, grid, tolerance));
    runs.push_back(make_run(study, grid, kTightening * study.tolerances.back()));
  }
}

/// Results to each tolerance, mesh by mesh.
std::vector<std::vector<Json>> take_tolerance_results(const Study& study, const Series& series,
                                                      StudyRuns& batch) {
  std::vector<std::vector<Json>> by_mesh(series.meshes.size());
  for (std::vector<Json>& at : by_mesh) {
    for (std::size_t k = 0; k <= study.tolerances.size(); ++k) at.push_back(batch.next());
  }
  return by_mesh;
}

bool varies_tolerance(const Study& study) { return study.tolerances.size() > 1; }

}  // namespace

std::vector<RunSpec> study_runs(const Study& study, std::optional<double> memory_limit) {
  std::vector<RunSpec> runs;
  for (const Series& series : make_series(study, memory_limit)) {
    add_runs(study, series, runs);
    if (varies_tolerance(study)) add_tolerance_runs(study, series, runs);
  }
  return runs;
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
    StudyRuns batch(pool, failed);
    for (const Series& series : all) add_tolerance_runs(study, series, batch.runs());
    batch.run();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto by_mesh = take_tolerance_results(study, all[i], batch);
      json["series"][all[i].name]["tolerances"] = tolerance_rows(study, all[i], by_mesh, results[i]);
    }
  }
  json["failed_runs"] = failed.json();
  json["provenance"] = provenance(1);
  return json;
}

}  // namespace slipstick::convergence
