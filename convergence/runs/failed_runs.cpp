#include "convergence/runs/failed_runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

SolveRecord not_computed(RunStatus status, const std::string& message, const RunSpec& spec) {
  SolveRecord record;
  record.status = status;
  record.message = message;
  record.run = run_text(spec);
  return record;
}

bool is_failed(const Json& result) {
  const std::string status = result.value("status", "");
  return status == "failed" || status == "refused";
}

bool is_converged(const Json& result) { return result.value("status", "") == "converged"; }

std::string why_missing(const Json& result, const std::string& path) {
  const FoundQuantity found = find_quantity(result, path);
  if (found.value != nullptr && found.value->is_number()) return "";
  if (!found.reason.empty()) return found.reason;
  return result.value("message", "the result does not have it");
}

void FailedRuns::add(const std::string& name, const SolveRecord& record) {
  runs_[name] |= record.is_failed();
  if (!record.is_failed() || first_) return;
  first_ = {record.run.empty() ? name : record.run,
            record.message.empty() ? "no reason is known" : record.message};
}

void FailedRuns::add(const std::string& name, const Json& result) {
  SolveRecord record;
  record.status = convergence::is_failed(result) ? RunStatus::failed : RunStatus::converged;
  record.message = result.value("message", "");
  record.run = result.value("run", "");
  add(name, record);
}

Json FailedRuns::json() const {
  Json json{{"count", count()}, {"of", runs_.size()}};
  if (first_) {
    json["first"] = {{"run", first_->run}, {"message", first_->message}};
  } else {
    set_missing(json, "first", "no run failed");
  }
  return json;
}

std::size_t FailedRuns::count() const {
  return static_cast<std::size_t>(std::ranges::count_if(runs_, [](const auto& run) { return run.second; }));
}

std::string FailedRuns::text() const {
  if (!first_) return "";
  return fmt::format("{} of {} runs failed; the first ({}): {}", count(), runs_.size(), first_->run,
                     first_->message);
}

std::string failed_runs_text(const Json& result) {
  const auto runs = result.find("failed_runs");
  if (runs == result.end() || runs->at("count") == 0) return "";
  const Json& first = runs->at("first");
  return fmt::format("{} of {} runs failed; the first ({}): {}", runs->at("count").get<int>(),
                     runs->at("of").get<int>(), first.at("run").get<std::string>(),
                     first.at("message").get<std::string>());
}

}  // namespace slipstick::convergence
