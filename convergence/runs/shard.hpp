#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
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

/// The shard, counted from 1, to which each part goes: the costliest first, each to the shard that has least
/// so far.
std::vector<std::size_t> deal(const std::vector<double>& costs, std::size_t count);

/// The work of a run, to compare it with others': predicted bytes of its operators and workspaces, which each
/// iteration goes through, times its steps. The same on every machine, or shards would not fit together.
double predicted_cost(const PreparedRun& run);

/// Solves those runs that fall to a shard and keeps their results; equal runs count once. Says how many they
/// are, what part of the predicted work, and which failed. Throws as ProcessPool::run().
Json run_shard(const std::vector<PreparedRun>& runs, const Shard& shard, const ProcessPool& pool);

/// The same for a person.
std::string shard_text(const Json& result);

/// Whether each of the shard's runs has a result.
bool is_complete(const Json& result);

/// Throws InputError unless each run has a result in the pool's folder or in one that it joins: names the
/// runs that have none, and says how to go on.
void require_finished(const std::vector<PreparedRun>& runs, const ProcessPool& pool);

}  // namespace slipstick::convergence
