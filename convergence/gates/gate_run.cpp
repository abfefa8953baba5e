#include "convergence/gates/gate_run.hpp"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "convergence/results/json_text.hpp"
#include "convergence/studies/budget.hpp"
#include "convergence/studies/study.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
using Judgements = std::vector<std::optional<Judgement>>;

double seconds_of(const Json& result) {
  const auto seconds = result.find("seconds");
  return seconds != result.end() && seconds->is_object() ? seconds->value("total", 0.0) : 0.0;
}

/// Which part of the error budget is the largest, where a gate on an error fails; it takes some more solves.
std::string find_dominant_error(const Judgement& judgement, const PreparedRun& run, const ProcessPool& pool) {
  const Gate& gate = judgement.gate;
  if (judgement.outcome != Outcome::failed || !judgement.value.is_number() || !is_error(gate.quantity))
    return "";
  const Budget budget = error_budget(run, gate.quantity, pool);
  const double parts = budget.discretisation + budget.iteration + budget.rounding + budget.reference;
  if (!std::isfinite(parts)) return "not known: solves that would tell have no such number";
  return fmt::format(
      "{} (of {:.2g}: discretisation {:.2g}, iteration {:.2g}, rounding {:.1g}, reference {:.1g})",
      largest_part(budget), budget.observed, budget.discretisation, budget.iteration, budget.rounding,
      budget.reference);
}

void judge_scenes(const std::vector<Gate>& gates, const ProcessPool& pool, Judgements& judgements) {
  std::vector<std::size_t> places;
  std::vector<PreparedRun> runs;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    if (gates[i].kind != GateSource::scene) continue;
    try {
      runs.push_back(prepare_run({.scene = gates[i].source, .overrides = gates[i].overrides}));
      places.push_back(i);
    } catch (const InputError& error) {
      judgements[i] = refuse(gates[i], error.what());
    }
  }
  const std::vector<Json> results = pool.run_prepared(runs);
  std::set<std::string> timed;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (results[k].value("out_of_memory", false)) {
      judgements[places[k]] = refuse(gates[places[k]], results[k]["message"]);
      continue;
    }
    Judgement judgement = judge(gates[places[k]], results[k]);
    if (timed.insert(runs[k].name).second) judgement.seconds = seconds_of(results[k]);
    judgement.dominant_error = find_dominant_error(judgement, runs[k], pool);
    judgements[places[k]] = std::move(judgement);
  }
}

/// What cannot be judged as a study, with solves that did not converge for one, is a result that failed.
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

/// Equal studies are run once.
void judge_studies(const std::vector<Gate>& gates, const ProcessPool& pool, Judgements& judgements) {
  std::map<std::pair<std::filesystem::path, std::vector<std::string>>, Json> results;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    const Gate& gate = gates[i];
    if (gate.kind != GateSource::study) continue;
    try {
      auto [found, is_new] = results.try_emplace({gate.source, gate.overrides});
      if (is_new) found->second = study_result(gate, pool);
      judgements[i] = judge(gate, found->second);
    } catch (const InputError& error) {
      judgements[i] = refuse(gate, error.what());
    }
  }
}

Json read_result(const Gate& gate) {
  const std::string made_by = gate.made_by.empty() ? "" : "; it is made by: " + gate.made_by;
  return read_json(gate.source, "a result file (JSON)" + made_by);
}

/// Each file is read once.
void judge_results(const std::vector<Gate>& gates, Judgements& judgements) {
  std::map<std::filesystem::path, Json> results;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    const Gate& gate = gates[i];
    if (gate.kind != GateSource::result) continue;
    try {
      if (!results.contains(gate.source)) results[gate.source] = read_result(gate);
      judgements[i] = judge(gate, results.at(gate.source));
    } catch (const InputError& error) {
      judgements[i] = refuse(gate, error.what());
    }
  }
}

}  // namespace

std::vector<PreparedRun> gate_runs(const std::vector<Gate>& gates, const ProcessPool& pool) {
  std::vector<PreparedRun> runs;
  for (const Gate& gate : gates) {
    if (gate.kind == GateSource::result) continue;
    try {
      std::vector<RunSpec> specs{{.scene = gate.source, .overrides = gate.overrides}};
      if (gate.kind == GateSource::study) {
        specs = study_runs(read_study(gate.source, gate.overrides), pool.memory_limit());
      }
      for (const RunSpec& spec : specs) runs.push_back(prepare_run(spec));
    } catch (const InputError&) {  // its gate is refused when it is judged
    }
  }
  return runs;
}

std::vector<Judgement> run_gates(const std::vector<Gate>& gates, const ProcessPool& pool) {
  Judgements judgements(gates.size());
  judge_scenes(gates, pool, judgements);
  judge_studies(gates, pool, judgements);
  judge_results(gates, judgements);
  std::vector<Judgement> result;
  for (std::optional<Judgement>& judgement : judgements) result.push_back(*std::move(judgement));
  return result;
}

}  // namespace slipstick::convergence
