#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/process_pool.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {

/// Runs that are solved side by side, each with the function that takes its result.
class RunBatch {
 public:
  using Take = std::function<void(const Json& result)>;

  /// Throws InputError for a scene that cannot be read.
  void add(const RunSpec& spec, Take take) {
    runs_.push_back(prepare_run(spec));
    takes_.push_back(std::move(take));
  }

  /// The same, but a scene that cannot be read is a result at once: refused, with the message.
  void add_or_refuse(const RunSpec& spec, const Take& take) {
    try {
      add(spec, take);
    } catch (const solver::InputError& error) {
      take(to_json(not_computed(RunStatus::refused, error.what(), spec)));
    }
  }

  const std::vector<PreparedRun>& runs() const { return runs_; }

  /// Solves all, then hands out the results in the order of add(). Throws as ProcessPool::run().
  void run(const ProcessPool& pool) const {
    const std::vector<SolveRecord> records = pool.run_prepared(runs_);
    for (std::size_t i = 0; i < records.size(); ++i) takes_[i](to_json(records[i]));
  }

 private:
  std::vector<PreparedRun> runs_;
  std::vector<Take> takes_;
};

}  // namespace slipstick::convergence
