// Any text is judged as a result, by a gate on the quantity that its first line names, or is refused.

#include <algorithm>
#include <cstdlib>

#include "convergence/gates/gate.hpp"
#include "solver/input/tests/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace slipstick;
  static const solver::FuzzFile file("result.json");
  static const convergence::ProcessPool pool({.folder = file.folder() / "runs"});
  const std::string_view text = solver::text_of(bytes, size);
  const std::size_t end = std::min(text.find('\n'), text.size());
  convergence::Gate gate;
  gate.id = "fuzzed";
  gate.file = "gates.toml";
  gate.kind = convergence::GateSource::result;
  gate.source = file.write(text.substr(std::min(end + 1, text.size())));
  gate.quantity = std::string(text.substr(0, end));
  gate.below = 1.0;
  gate.above = 0.0;
  gate.basis = "any";
  const auto judgements = convergence::run_gates({gate}, pool);
  if (judgements.size() != 1) std::abort();
  convergence::gates_text(judgements);
  convergence::gates_junit(judgements);
  convergence::gates_markdown(judgements);
  convergence::gates_json(judgements);
  return 0;
}
