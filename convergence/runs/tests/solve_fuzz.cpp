// Any text is refused as a scene or solved, here on few cells; a converged solve has finite numbers. The text
// after a zero byte is the file table.csv, which a scene may name as height map or pressure.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "convergence/results/exact_result.hpp"
#include "convergence/results/record_text.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "solver/input/tests/fuzz_file.hpp"

namespace {

using namespace slipstick;
using solver::Index;

/// Larger tables make larger grids.
constexpr std::size_t kMaxTable = 256;

void make_small(solver::Scene& scene) {
  for (Index& cells : scene.grid.cells) cells = std::min<Index>(cells, 6);
  if (scene.steps.size() > 3) scene.steps.resize(3);
  scene.cycles = std::min(scene.cycles, 2);
  if (scene.surfaces.size() > 3) scene.surfaces.resize(3);
  for (solver::Surface& surface : scene.surfaces) {
    solver::Roughness& waves = surface.roughness;
    waves.shortest = std::max(waves.shortest, std::min(waves.period / 32.0, waves.longest / 2.0));
  }
  scene.solver.tolerance = std::max(scene.solver.tolerance, 1e-6);
  scene.solver.max_iterations = std::min(scene.solver.max_iterations, 200);
  scene.solver.threads = 1;
}

void answer(const solver::Scene& scene) {
  if (scene.solver.model == solver::ModelChoice::exact) {
    const convergence::Oracle oracle = convergence::require_oracle(scene);
    convergence::solve_text(convergence::exact_record(scene, oracle, 0.0));
    return;
  }
  const convergence::SolvedScene solved = convergence::solve_scene(scene);
  const solver::Solution& found = solved.solution;
  convergence::solve_text(solved.record);
  if (found.status != solver::Status::converged) return;
  if (!std::isfinite(found.twist_angle) || !std::isfinite(found.moment) || !found.pressure.isFinite().all() ||
      !found.traction.isFinite().all()) {
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const solver::FuzzFile file("scene.toml");
  const std::string_view text = solver::text_of(bytes, size);
  const std::size_t end = std::min(text.find('\0'), text.size());
  std::ofstream(file.folder() / "table.csv", std::ios::binary)
      << (end < text.size() ? text.substr(end + 1, kMaxTable) : std::string_view());
  solver::read_or_refuse([&] {
    solver::Scene scene = solver::read_scene(file.write(text.substr(0, end)));
    make_small(scene);
    answer(scene);
  });
  return 0;
}
