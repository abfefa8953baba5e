#include "convergence/runs/run_spec.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cfenv>
#include <memory>
#include <utility>

#include "convergence/results/result.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::convergence {
namespace {

int mode(Rounding rounding) {
  switch (rounding) {
    case Rounding::upward:
      return FE_UPWARD;
    case Rounding::downward:
      return FE_DOWNWARD;
    default:
      return FE_TONEAREST;
  }
}

/// Sets how this thread rounds, and sets it back.
class RoundingScope {
 public:
  explicit RoundingScope(Rounding rounding) : before_(std::fegetround()) { std::fesetround(mode(rounding)); }
  ~RoundingScope() { std::fesetround(before_); }
  RoundingScope(const RoundingScope&) = delete;
  RoundingScope& operator=(const RoundingScope&) = delete;

 private:
  int before_;
};

solver::Solution solve_rounded(const Point& point, const solver::Scene& scene,
                               const std::function<void(const solver::Solution&)>& on_step) {
  const RoundingScope scope(point.rounding);
  return solver::solve(scene, {.progress = {}, .on_step = on_step});
}

}  // namespace

std::string read_text(const std::filesystem::path& file) {
  return solver::read_input_file(file, solver::kLargestTable, "a regular file");
}

std::string cells_override(const solver::Scene& scene, solver::Index across) {
  const solver::Index longer = std::max(scene.cells[0], scene.cells[1]);
  return fmt::format("grid.cells=[{},{}]", across * scene.cells[0] / longer,
                     across * scene.cells[1] / longer);
}

std::string question(const Point& point) {
  const solver::Scene scene = solver::read_scene(point.scene, point.overrides);
  std::string text = fmt::format("{}\n{}", read_text(point.scene), fmt::join(point.overrides, "\n"));
  for (const solver::Surface& surface : scene.surfaces) {
    if (!surface.file.empty()) text += read_text(surface.file);
  }
  if (!scene.pressure_file.empty()) text += read_text(scene.pressure_file);
  if (point.rounding != Rounding::nearest) text += fmt::format("\nrounding {}", mode(point.rounding));
  return text;
}

std::string run_text(const Point& point) {
  std::string text = point.scene.stem().string();
  for (const std::string& assignment : point.overrides) text += ", " + assignment;
  if (point.rounding == Rounding::upward) text += ", rounded upward";
  if (point.rounding == Rounding::downward) text += ", rounded downward";
  return text;
}

Json solve_point(const Point& point, const Look& look) {
  const solver::Scene scene = solver::read_scene(point.scene, point.overrides);
  const std::unique_ptr<ExactHistory> history = exact_history(scene);
  OracleAnswer exact;
  Json steps = Json::array();
  const auto on_step = [&](const solver::Solution& at) {
    const RoundingScope scope(Rounding::nearest);  // the exact answer is no part of what is tried
    exact = history->advance(at.loads);
    steps.push_back(step_result(scene, at, exact));
  };
  const solver::Solution solution = solve_rounded(point, scene, on_step);
  Json result = solve_result(scene, solution, exact);
  if (has_history(scene)) add_steps(result, std::move(steps));
  if (look) look(result, solution, exact);
  return result;
}

}  // namespace slipstick::convergence
