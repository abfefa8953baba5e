#include "convergence/runner.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <fstream>
#include <sstream>

#include "convergence/result.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// What the answer depends on.
std::string question(const solver::Scene& scene, const std::vector<std::string>& overrides) {
  std::string text = fmt::format("{}\n{}", read_text(scene.source), fmt::join(overrides, "\n"));
  for (const solver::Surface& surface : scene.surfaces) {
    if (!surface.file.empty()) text += read_text(surface.file);
  }
  return text;
}

Json solve_and_compare(const solver::Scene& scene, const Look& look) {
  const std::unique_ptr<ExactHistory> history = exact_history(scene);
  OracleAnswer exact;
  Json steps = Json::array();
  const solver::Solution solution =
      solver::solve(scene, {.progress = {}, .on_step = [&](const solver::Solution& at) {
                              exact = history->advance(at.loads);
                              steps.push_back(step_result(scene, at, exact));
                            }});
  Json result = solve_result(scene, solution, exact);
  if (steps.size() > 1) add_steps(result, std::move(steps));
  if (look) look(result, solution, exact);
  return result;
}

}  // namespace

std::string read_text(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

Runner::Runner(const fs::path& folder, std::size_t points) : journal_(folder / "points"), points_(points) {}

Json Runner::solve(const std::string& name, const fs::path& scene_file,
                   const std::vector<std::string>& overrides, const Look& look, const fs::path& also) {
  const solver::Scene scene = solver::read_scene(scene_file, overrides);
  Json result = journal_.point(
      name, question(scene, overrides), [&] { return solve_and_compare(scene, look); }, also);
  say_progress(name);
  return result;
}

void Runner::say_progress(const std::string& name) {
  ++done_;
  computed_ += journal_.reused() ? 0 : 1;
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double left = computed_ == 0 ? 0.0 : elapsed / computed_ * static_cast<double>(points_ - done_);
  fmt::print(stderr, "[{}/{}] {}{}, about {:.0f} s left\n", done_, points_, name,
             journal_.reused() ? " (already there)" : "", left);
}

}  // namespace slipstick::convergence
