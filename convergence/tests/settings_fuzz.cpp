// Any text is a study, a file of gates or of hard cases, or is refused.

#include "convergence/gates/gate_reader.hpp"
#include "convergence/hard/hard_case.hpp"
#include "convergence/studies/study.hpp"
#include "solver/input/tests/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace slipstick;
  static const solver::FuzzFile file("settings.toml");
  const auto& path = file.write(solver::text_of(bytes, size));
  solver::read_or_refuse([&] { convergence::read_study(path, {}); });
  solver::read_or_refuse([&] { convergence::read_gates(path); });
  solver::read_or_refuse([&] { convergence::read_hard_cases(path); });
  return 0;
}
