#include "convergence/runs/failed_runs.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "convergence/results/quantity.hpp"

namespace slipstick::convergence {

Json not_computed(const std::string& status, const std::string& message, const RunSpec& spec) {
  return {{"status", status}, {"message", message}, {"run", run_text(spec)}};
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

void FailedRuns::add(const std::string& name, const Json& result) {
  const bool failed = is_failed(result);
  runs_[name] |= failed;
  if (!failed || !first_.is_null()) return;
  first_ = {{"run", result.value("run", name)}, {"message", result.value("message", "no reason is known")}};
}

Json FailedRuns::json() const {
  const auto failed = std::ranges::count_if(runs_, [](const auto& run) { return run.second; });
  Json json{{"count", failed}, {"of", runs_.size()}};
  if (failed > 0) {
    json["first"] = first_;
  } else {
    set_missing(json, "first", "no run failed");
  }
  return json;
}

std::string failed_runs_text(const Json& result) {
  const auto runs = result.find("failed_runs");
  if (runs == result.end() || (*runs)["count"] == 0) return "";
  const Json& first = (*runs)["first"];
  return fmt::format("{} of {} runs failed; the first ({}): {}", (*runs)["count"].get<int>(),
                     (*runs)["of"].get<int>(), first["run"].get<std::string>(),
                     first["message"].get<std::string>());
}

}  // namespace slipstick::convergence
