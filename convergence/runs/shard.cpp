#include "convergence/runs/shard.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string_view>

#include "convergence/results/provenance.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"
#include "solver/model/memory_plan.hpp"

namespace slipstick::convergence {
namespace {

/// Bytes; no larger model is made to predict its cost, so that every machine makes the same models.
constexpr double kLargestModelled = 16.0 * 0x1p30;
/// Bytes of operators and workspaces for each cell, where symmetry leaves nothing out; measured, to a tenth.
constexpr double kBytesOfCell = 400.0;
/// Runs that a message names.
constexpr std::size_t kMaxNamed = 10;

/// The whole number that the word is; 0: it is none.
std::size_t number_in(std::string_view word) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() ? number : 0;
}

std::vector<PreparedRun> different(const std::vector<PreparedRun>& runs) {
  std::vector<PreparedRun> once;
  std::set<std::string> seen;
  for (const PreparedRun& run : runs) {
    if (seen.insert(run.name).second) once.push_back(run);
  }
  return once;
}

}  // namespace

Shard read_shard(const std::string& word) {
  const std::size_t slash = std::min(word.find('/'), word.size());
  const std::string_view view = word;
  const Shard shard{number_in(view.substr(0, slash)),
                    slash < word.size() ? number_in(view.substr(slash + 1)) : 0};
  if (shard.index >= 1 && shard.index <= shard.count) return shard;
  throw solver::InputError("--shard " + word, "allowed: I/N, the I-th of N parts, from 1/N to N/N, e.g. 2/4");
}

std::vector<std::size_t> deal(const std::vector<double>& costs, std::size_t count) {
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return costs[i]; });
  std::vector<double> sums(count, 0.0);
  std::vector<std::size_t> shards(costs.size());
  for (const std::size_t i : order) {
    const auto least = std::ranges::min_element(sums);
    *least += costs[i];
    shards[i] = static_cast<std::size_t>(least - sums.begin()) + 1;
  }
  return shards;
}

double predicted_cost(const PreparedRun& run) {
  solver::Scene scene = run.scene;
  scene.solver.memory_limit = kLargestModelled;
  const double steps = static_cast<double>(scene.steps.size()) * scene.cycles;
  try {
    return steps * predicted_memory(scene, solver::make_model(scene)).solver;
  } catch (const solver::InputError&) {  // too large, or refused at once
    return steps * kBytesOfCell * static_cast<double>(scene.grid.cells[0]) *
           static_cast<double>(scene.grid.cells[1]);
  }
}

ShardResult run_shard(const std::vector<PreparedRun>& runs, const Shard& shard, const ProcessPool& pool) {
  const std::vector<PreparedRun> all = different(runs);
  std::vector<double> costs;
  for (const PreparedRun& run : all) costs.push_back(predicted_cost(run));
  const std::vector<std::size_t> shards = deal(costs, shard.count);
  std::vector<PreparedRun> own;
  double cost = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (shards[i] != shard.index) continue;
    own.push_back(all[i]);
    cost += costs[i];
  }
  const double total = std::accumulate(costs.begin(), costs.end(), 0.0);
  ShardResult result{.shard = shard,
                     .runs = own.size(),
                     .of_runs = all.size(),
                     .cost = total > 0.0 ? cost / total : 0.0,
                     .folder = pool.folder(),
                     .failed = {}};
  const std::vector<SolveRecord> records = pool.run_prepared(own);
  for (std::size_t i = 0; i < own.size(); ++i) result.failed.add(run_text(own[i].spec), records[i]);
  return result;
}

Json to_json(const ShardResult& result) {
  return {{"shard",
           {{"index", result.shard.index},
            {"count", result.shard.count},
            {"runs", result.runs},
            {"of_runs", result.of_runs},
            {"cost", result.cost},
            {"folder", result.folder.string()}}},
          {"failed_runs", result.failed.json()},
          {"provenance", provenance(1)}};
}

std::string shard_text(const ShardResult& result) {
  const std::string failed = result.failed.text();
  return fmt::format("shard {}/{}: {} of {} runs, {:.1f} % of the predicted work, kept in {}\n{}",
                     result.shard.index, result.shard.count, result.runs, result.of_runs, 100.0 * result.cost,
                     result.folder.string(), failed.empty() ? "" : failed + "\n");
}

void require_finished(const std::vector<PreparedRun>& runs, const ProcessPool& pool) {
  const std::vector<PreparedRun> all = different(runs);
  const std::vector<PreparedRun> missing = pool.missing(all);
  if (missing.empty()) return;
  std::string names;
  for (std::size_t i = 0; i < std::min(missing.size(), kMaxNamed); ++i) {
    names += "\n  " + run_text(missing[i].spec);
  }
  if (missing.size() > kMaxNamed) names += fmt::format("\n  and {} more", missing.size() - kMaxNamed);
  throw solver::InputError(
      "--merge",
      fmt::format("{} of {} runs are in none of the folders, or were kept by another build of this program: "
                  "start the shards again, each solves what it lacks; or leave --merge out, and they are "
                  "solved here. Missing:{}",
                  missing.size(), all.size(), names));
}

}  // namespace slipstick::convergence
