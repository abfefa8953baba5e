#include "convergence/runs/runner.hpp"

#include <fmt/core.h>

namespace slipstick::convergence {

namespace fs = std::filesystem;

Runner::Runner(const fs::path& folder, std::size_t points) : journal_(folder / "points"), points_(points) {}

Json Runner::solve(const std::string& name, const fs::path& scene_file,
                   const std::vector<std::string>& overrides, const Look& look, const fs::path& also) {
  const Point point{scene_file, overrides};
  Json result = journal_.point(
      name, question(point), [&] { return solve_point(point, look); }, also);
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
