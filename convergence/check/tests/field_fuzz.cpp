// Any text is judged as a field of tractions or is refused.

#include "convergence/check/check.hpp"
#include "solver/input/tests/fuzz_file.hpp"

namespace {

slipstick::solver::Scene sphere() {
  slipstick::solver::Scene scene;
  scene.surfaces.front().radius = 0.018;
  scene.upper = scene.lower = {210e9, 0.3};
  scene.friction = 0.1;
  scene.steps.front().normal = 1000.0;
  scene.steps.front().torsion = slipstick::solver::MomentRatio{0.9};
  scene.cells = {8, 8};
  return scene;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace slipstick;
  static const solver::FuzzFile file("field.csv");
  static const solver::Scene scene = sphere();
  const auto& path = file.write(solver::text_of(bytes, size));
  solver::read_or_refuse([&] { convergence::check_text(convergence::check_field(scene, path)); });
  return 0;
}
