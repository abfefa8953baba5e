// Any text is judged as a field of tractions or read as a loop, or is refused.

#include <nlohmann/json.hpp>

#include "convergence/check/check.hpp"
#include "convergence/check/loop_request.hpp"
#include "solver/input/tests/fuzz_file.hpp"

namespace {

slipstick::solver::Scene sphere() {
  slipstick::solver::Scene scene;
  scene.surfaces.front().radius = 0.018;
  scene.upper = scene.lower = {210e9, 0.3};
  scene.contact.friction.coefficient = 0.1;
  scene.steps.front().normal = 1000.0;
  scene.steps.front().torsion = slipstick::solver::MomentRatio{0.9};
  scene.grid.cells = {8, 8};
  return scene;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace slipstick;
  static const solver::FuzzFile table("field.csv");
  static const solver::FuzzFile lists("loop.json");
  static const solver::Scene scene = sphere();
  const bool is_json = size > 0 && bytes[0] == '{';
  const auto& path = (is_json ? lists : table).write(solver::text_of(bytes, size));
  solver::read_or_refuse([&] {
    if (convergence::is_loop_file(path)) {
      convergence::loop_request(scene, path, {});
    } else {
      convergence::check_text(convergence::check_field(scene, path));
    }
  });
  return 0;
}
