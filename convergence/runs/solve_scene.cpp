#include "convergence/runs/solve_scene.hpp"

#include <cfenv>
#include <memory>
#include <utility>

#include "convergence/results/result.hpp"
#include "solver/input/input_error.hpp"
#include "solver/within_double.hpp"

namespace slipstick::convergence {
namespace {

/// Sets how this thread rounds, and sets it back.
class RoundingScope {
 public:
  explicit RoundingScope(Rounding rounding) : before_(std::fegetround()) {
    std::fesetround(static_cast<int>(rounding));
  }
  ~RoundingScope() { std::fesetround(before_); }
  RoundingScope(const RoundingScope&) = delete;
  RoundingScope& operator=(const RoundingScope&) = delete;

 private:
  int before_;
};

}  // namespace

SolvedScene solve_scene(const solver::Scene& scene, const SolveSceneOptions& options) {
  const auto history = solver::within_double(scene, [&] { return exact_history(scene); });
  SolvedScene solved;
  Json steps = Json::array();
  const auto on_step = [&](const solver::Solution& at) {
    const RoundingScope scope(Rounding::nearest);
    solved.exact = history->advance(at.loads);
    if (has_history(scene)) steps.push_back(step_result(scene, at, solved.exact));
    if (options.on_step) options.on_step(at, solved.exact);
  };
  try {
    const RoundingScope scope(options.rounding);
    solved.solution =
        solver::solve(scene, {.progress = options.progress, .on_step = on_step, .cache = options.cache});
  } catch (const solver::InputError& error) {
    if (!steps.empty() && options.incomplete != nullptr) {
      *options.incomplete = {{"name", scene.name}, {"status", "not_converged"}, {"message", error.what()}};
      add_steps(*options.incomplete, std::move(steps));
    }
    throw;
  }
  solved.result =
      solver::within_double(scene, [&] { return solve_result(scene, solved.solution, solved.exact); });
  if (has_history(scene)) add_steps(solved.result, std::move(steps));
  return solved;
}

}  // namespace slipstick::convergence
