#include "convergence/studies/budget.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/results/quantity.hpp"

namespace slipstick::convergence {

BudgetRuns budget_runs(const RunSpec& observed, double tolerance) {
  RunSpec tightened = observed;
  tightened.overrides.push_back(fmt::format("solver.tolerance={}", kTightening * tolerance));
  RunSpec upward = tightened;
  upward.rounding = Rounding::upward;
  RunSpec downward = tightened;
  downward.rounding = Rounding::downward;
  return {observed, tightened, {upward, downward}};
}

Budget split_error(const std::string& quantity, const Json& observed, const Json& tightened,
                   const std::vector<Json>& rounded) {
  Budget budget;
  budget.observed = number_at(observed, quantity);
  budget.discretisation = number_at(tightened, quantity);
  budget.iteration = budget.observed - budget.discretisation;
  budget.rounding = rounded.empty() ? NAN : 0.0;
  for (const Json& result : rounded) {
    const double change = std::abs(number_at(result, quantity) - budget.discretisation);
    const bool keep = std::isnan(budget.rounding) || change <= budget.rounding;
    budget.rounding = keep ? budget.rounding : change;
  }
  budget.reference = number_at(observed, "exact.relative_uncertainty");
  return budget;
}

Budget error_budget(const PreparedRun& run, const std::string& quantity, const ProcessPool& pool) {
  const BudgetRuns runs = budget_runs(run.spec, run.scene.solver.tolerance);
  const std::vector<Json> results =
      to_json(pool.run({runs.observed, runs.tightened, runs.rounded[0], runs.rounded[1]}));
  return split_error(quantity, results[0], results[1], {results[2], results[3]});
}

std::string largest_part(const Budget& budget) {
  const std::pair<double, const char*> parts[] = {{std::abs(budget.discretisation), "discretisation"},
                                                  {std::abs(budget.iteration), "iteration"},
                                                  {budget.rounding, "rounding"},
                                                  {budget.reference, "reference"}};
  return std::max_element(
             std::begin(parts), std::end(parts),
             [](const auto& a, const auto& b) { return a.first < b.first || std::isnan(a.first); })
      ->second;
}

}  // namespace slipstick::convergence
