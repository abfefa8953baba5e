#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/process_pool.hpp"
#include "convergence/runs/run_spec.hpp"

namespace slipstick::convergence {

/// One part of the runs of a study or of gates; index is counted from 1.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;
};

/// "2/4" is the second of four. Throws InputError for anything else.
Shard read_shard(const std::string& word);

/// The shard of each part, counted from 1: the costliest part first, each to the shard with the least work so
/// far.
std::vector<std::size_t> deal(const std::vector<double>& costs, std::size_t count);

/// The relative work of a run: predicted bytes of its operators and workspaces, which each iteration reads,
/// times its steps. It is the same on every machine, since shards of several machines must fit together.
double predicted_cost(const PreparedRun& run);

/// The work of one shard.
struct ShardResult {
  Shard shard;
  std::size_t runs = 0;
  std::size_t of_runs = 0;  ///< in all shards
  double cost = 0.0;        ///< part of the predicted work of all shards
  std::filesystem::path folder;
  FailedRuns failed;
};

/// Solves the runs of a shard and keeps their results; equal runs count once. Throws as ProcessPool::run().
ShardResult run_shard(const std::vector<PreparedRun>& runs, const Shard& shard, const ProcessPool& pool);

/// docs/schema/shard.schema.json
Json to_json(const ShardResult& result);

/// For a person.
std::string shard_text(const ShardResult& result);

/// Throws InputError unless each run has a result in the pool's folder or in one that it joins. The message
/// names the runs without a result, and the remedy.
void require_finished(const std::vector<PreparedRun>& runs, const ProcessPool& pool);

}  // namespace slipstick::convergence
