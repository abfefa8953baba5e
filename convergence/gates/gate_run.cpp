#include "convergence/gates/gate_run.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "convergence/results/json_text.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/studies/study_judgement.hpp"
#include "convergence/studies/study_run.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
namespace fs = std::filesystem;

/// The result of a source, or why there is none.
struct SourceResult {
  Json result;
  std::string refused;
  double seconds = 0.0;
  std::string file_date;
};
using SourceResults = std::map<GateSource, SourceResult>;

/// The largest part of the error budget where a gate on an error of a solve fails; empty for other gates.
/// Solves the scene up to three times more.
std::string find_dominant_error(const Judgement& judgement, const ProcessPool& pool) {
  const Gate& gate = judgement.gate;
  const auto* const scene = std::get_if<SceneSource>(&gate.source);
  if (scene == nullptr || judgement.outcome != Outcome::failed || !judgement.value.is_number() ||
      !is_error(gate.quantity)) {
    return "";
  }
  const Budget budget =
      error_budget(prepare_run({.scene = scene->file, .overrides = scene->overrides}), gate.quantity, pool);
  const double parts = budget.discretisation + budget.iteration + budget.rounding + budget.reference;
  if (!std::isfinite(parts)) return "unknown: the solves for the budget have no such number";
  return fmt::format("{} (of {:.2g}: discretisation {:.2g}, iteration {:.2g}, rounding {:.1g}, reference {:.1g})",
                     largest_part(budget), budget.observed, budget.discretisation, budget.iteration, budget.rounding,
                     budget.reference);
}

void solve_scenes(const std::vector<GateSource>& sources, const ProcessPool& pool, SourceResults& results) {
  std::vector<PreparedRun> runs;
  std::vector<SourceResult*> places;
  for (const GateSource& source : sources) {
    const auto* const scene = std::get_if<SceneSource>(&source);
    if (scene == nullptr) continue;
    SourceResult& found = results[source];
    try {
      runs.push_back(prepare_run({.scene = scene->file, .overrides = scene->overrides}));
      places.push_back(&found);
    } catch (const InputError& error) {
      found.refused = error.what();
    }
  }
  const std::vector<SolveRecord> solved = pool.run_prepared(runs);
  for (std::size_t k = 0; k < solved.size(); ++k) {
    SourceResult& found = *places[k];
    found.result = to_json(solved[k]);
    if (solved[k].out_of_memory) found.refused = solved[k].message;
    const double seconds = solved[k].seconds();
    if (std::isfinite(seconds)) found.seconds = seconds;
  }
}

/// A study that cannot be judged, for example since solves did not converge, is a result that failed.
Json study_result(const StudySource& source, const ProcessPool& pool) {
  const Study study = read_study(source.file, source.overrides);
  try {
    return to_json(run_study(study, pool));
  } catch (const InputError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    return {{"status", "failed"}, {"message", error.what()}};
  }
}

/// The day of a file's last change.
std::string date_of(const fs::path& file) {
  const auto changed = std::chrono::file_clock::to_sys(fs::last_write_time(file));
  return fmt::format(
      "{:%Y-%m-%d}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::time_point_cast<std::chrono::seconds>(changed))));
}

SourceResult read_result(const ResultSource& source) {
  const std::string made_by = source.made_by.empty() ? "" : "; it is made by: " + source.made_by;
  SourceResult found;
  found.result = read_json(source.file, "a result file (JSON)" + made_by);
  found.file_date = date_of(source.file);
  return found;
}

/// Runs the studies and reads the files.
void find_others(const std::vector<GateSource>& sources, const ProcessPool& pool, SourceResults& results) {
  for (const GateSource& source : sources) {
    SourceResult& found = results[source];
    try {
      if (const auto* const study = std::get_if<StudySource>(&source)) found.result = study_result(*study, pool);
      if (const auto* const file = std::get_if<ResultSource>(&source)) found = read_result(*file);
    } catch (const InputError& error) {
      found.refused = error.what();
    }
  }
}

/// The verdict of a published number that is not compared.
Judgement not_compared(const Gate& gate) {
  Judgement judgement = refuse(gate, std::get<Published>(gate.bound).why);
  judgement.outcome = Outcome::reported;
  judgement.factor = 0.0;
  return judgement;
}

/// other: the result that the gate is relative to, else nullptr.
Judgement judge_or_refuse(const Gate& gate, const SourceResult& source, const SourceResult* other) {
  std::string refused = source.refused;
  if (refused.empty() && other != nullptr) refused = other->refused;
  if (!refused.empty()) return refuse(gate, refused);
  if (std::holds_alternative<std::monostate>(gate.source)) return not_compared(gate);
  try {
    return judge(gate, source.result, other == nullptr ? nullptr : &other->result);
  } catch (const InputError& error) {
    return refuse(gate, error.what());
  }
}

/// The source of the number that a gate is relative to: a result file, or a scene or study with the gate's
/// own overrides.
GateSource other_source(const GateSource& own, const fs::path& file) {
  if (file.extension() == ".json") return ResultSource{.file = file, .folder = {}, .made_by = {}};
  if (const auto* const study = std::get_if<StudySource>(&own)) return StudySource{file, study->overrides};
  const auto* const scene = std::get_if<SceneSource>(&own);
  return SceneSource{file, scene == nullptr ? std::vector<std::string>{} : scene->overrides};
}

}  // namespace

std::vector<GateSource> sources_of(const std::vector<Gate>& gates) {
  std::vector<GateSource> sources;
  std::set<GateSource> known;
  const auto add = [&](const GateSource& source) {
    if (known.insert(source).second) sources.push_back(source);
  };
  for (const Gate& gate : gates) add(gate.source);
  for (const Gate& gate : gates) {
    if (const auto* const relative = std::get_if<RelativeTo>(&gate.bound))
      add(other_source(gate.source, relative->file));
  }
  return sources;
}

std::vector<Judgement> run_gates(const std::vector<Gate>& gates, const ProcessPool& pool) {
  const std::vector<GateSource> sources = sources_of(gates);
  SourceResults results;
  solve_scenes(sources, pool, results);
  find_others(sources, pool, results);
  std::vector<Judgement> judgements;
  for (const Gate& gate : gates) {
    SourceResult& source = results.at(gate.source);
    const auto* const relative = std::get_if<RelativeTo>(&gate.bound);
    const SourceResult* const other =
        relative == nullptr ? nullptr : &results.at(other_source(gate.source, relative->file));
    Judgement& judgement = judgements.emplace_back(judge_or_refuse(gate, source, other));
    judgement.seconds = std::exchange(source.seconds, 0.0);
    judgement.file_date = source.file_date;
    judgement.dominant_error = find_dominant_error(judgement, pool);
  }
  return judgements;
}

}  // namespace slipstick::convergence
