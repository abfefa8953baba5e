// Any text is a scene or is refused.

#include "solver/input/tests/fuzz_file.hpp"
#include "solver/scene/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace slipstick::solver;
  static const FuzzFile file("scene.toml");
  read_or_refuse([&] { read_scene(file.write(text_of(bytes, size))); });
  return 0;
}
