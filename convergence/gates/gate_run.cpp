#include "convergence/gates/gate.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "convergence/results/json_text.hpp"
#include "convergence/results/quantity.hpp"
#include "convergence/runs/run_batch.hpp"
#include "convergence/studies/budget.hpp"
#include "convergence/studies/study.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
namespace fs = std::filesystem;

/// The result that a gate judges, or why there is none.
struct Source {
  Json result;
  std::string refused;
  double seconds = 0.0;
  std::string file_date;
};
using Sources = std::vector<Source>;

/// Which part of the error budget is the largest, where a gate on an error of a solve fails; it takes some
/// more solves.
std::string find_dominant_error(const Judgement& judgement, const ProcessPool& pool) {
  const Gate& gate = judgement.gate;
  if (gate.kind != GateSource::scene || judgement.outcome != Outcome::failed ||
      !judgement.value.is_number() || !is_error(gate.quantity)) {
    return "";
  }
  const Budget budget =
      error_budget(prepare_run({.scene = gate.source, .overrides = gate.overrides}), gate.quantity, pool);
  const double parts = budget.discretisation + budget.iteration + budget.rounding + budget.reference;
  if (!std::isfinite(parts)) return "not known: solves that would tell have no such number";
  return fmt::format(
      "{} (of {:.2g}: discretisation {:.2g}, iteration {:.2g}, rounding {:.1g}, reference {:.1g})",
      largest_part(budget), budget.observed, budget.discretisation, budget.iteration, budget.rounding,
      budget.reference);
}

/// Equal scenes are solved once, and the first gate has their time.
void solve_scenes(const std::vector<Gate>& gates, const ProcessPool& pool, Sources& sources) {
  RunBatch batch;
  std::set<std::pair<fs::path, std::vector<std::string>>> timed;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    if (gates[i].kind != GateSource::scene) continue;
    const auto take = [&timed, &gate = gates[i], &source = sources[i]](const Json& result) {
      source.result = result;
      if (result.value("out_of_memory", false)) source.refused = result["message"];
      const double seconds = seconds_of(result);
      if (timed.emplace(gate.source, gate.overrides).second && std::isfinite(seconds))
        source.seconds = seconds;
    };
    try {
      batch.add({.scene = gates[i].source, .overrides = gates[i].overrides}, take);
    } catch (const InputError& error) {
      sources[i].refused = error.what();
    }
  }
  batch.run(pool);
}

/// A study that cannot be judged, for example since solves did not converge, is a result that failed.
Json study_result(const Gate& gate, const ProcessPool& pool) {
  const Study study = read_study(gate.source, gate.overrides);
  try {
    return run_study(study, pool);
  } catch (const InputError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    return {{"status", "failed"}, {"message", error.what()}};
  }
}

/// The day of a file's last change.
std::string date_of(const fs::path& file) {
  const auto changed = std::chrono::file_clock::to_sys(fs::last_write_time(file));
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::to_time_t(
                                        std::chrono::time_point_cast<std::chrono::seconds>(changed))));
}

Source read_result(const Gate& gate) {
  const std::string made_by = gate.made_by.empty() ? "" : "; it is made by: " + gate.made_by;
  Source source;
  source.result = read_json(gate.source, "a result file (JSON)" + made_by);
  source.file_date = date_of(gate.source);
  return source;
}

/// Equal studies are run once, each file is read once.
void take_others(const std::vector<Gate>& gates, const ProcessPool& pool, Sources& sources) {
  std::map<std::pair<fs::path, std::vector<std::string>>, Source> known;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    const Gate& gate = gates[i];
    if (gate.kind == GateSource::scene || gate.kind == GateSource::none) continue;
    const auto [found, is_new] = known.try_emplace({gate.source, gate.overrides});
    try {
      if (is_new && gate.kind == GateSource::study) found->second.result = study_result(gate, pool);
      if (is_new && gate.kind == GateSource::result) found->second = read_result(gate);
    } catch (const InputError& error) {
      found->second.refused = error.what();
    }
    sources[i] = found->second;
  }
}

/// A published number that cannot be compared, and why.
Judgement not_compared(const Gate& gate) {
  Judgement judgement;
  judgement.gate = gate;
  judgement.outcome = Outcome::reported;
  judgement.why = gate.published->not_compared;
  return judgement;
}

Judgement judge(const Gate& gate, const Source& source, const Source* other) {
  std::string refused = source.refused;
  if (refused.empty() && other != nullptr) refused = other->refused;
  if (!refused.empty()) return refuse(gate, refused);
  if (gate.kind == GateSource::none) return not_compared(gate);
  try {
    if (gate.published) return judge_published(gate, source.result);
    return judge(other == nullptr ? gate : bounded_by(gate, other->result), source.result);
  } catch (const InputError& error) {
    return refuse(gate, error.what());
  }
}

}  // namespace

std::vector<Gate> with_others(const std::vector<Gate>& gates) {
  std::vector<Gate> all = gates;
  for (const Gate& gate : gates) {
    if (gate.of.empty()) continue;
    Gate other = gate;
    other.source = gate.of;
    if (gate.of.extension() == ".json") {
      other.kind = GateSource::result;
      other.overrides.clear();
    } else if (gate.kind == GateSource::result) {
      other.kind = GateSource::scene;
    }
    all.push_back(std::move(other));
  }
  return all;
}

std::vector<PreparedRun> gate_runs(const std::vector<Gate>& gates, const ProcessPool& pool) {
  std::vector<PreparedRun> runs;
  for (const Gate& gate : with_others(gates)) {
    if (gate.kind == GateSource::result || gate.kind == GateSource::none) continue;
    try {
      if (gate.kind == GateSource::scene) {
        runs.push_back(prepare_run({.scene = gate.source, .overrides = gate.overrides}));
        continue;
      }
      std::ranges::move(study_runs(read_study(gate.source, gate.overrides), pool.memory_limit()),
                        std::back_inserter(runs));
    } catch (const InputError&) {  // its gate is refused when it is judged
    }
  }
  return runs;
}

std::vector<Judgement> run_gates(const std::vector<Gate>& gates, const ProcessPool& pool) {
  const std::vector<Gate> all = with_others(gates);
  Sources sources(all.size());
  solve_scenes(all, pool, sources);
  take_others(all, pool, sources);
  std::vector<Judgement> judgements;
  std::size_t others = gates.size();
  for (std::size_t i = 0; i < gates.size(); ++i) {
    judgements.push_back(judge(gates[i], sources[i], gates[i].of.empty() ? nullptr : &sources[others++]));
    judgements.back().seconds = sources[i].seconds;
    judgements.back().file_date = sources[i].file_date;
    judgements.back().dominant_error = find_dominant_error(judgements.back(), pool);
  }
  return judgements;
}

}  // namespace slipstick::convergence
