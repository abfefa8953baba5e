// Any text is judged as a result, by a gate on the quantity that its first line names, or is refused.

#include <algorithm>
#include <cstdlib>

#include "convergence/gates/gate_report.hpp"
#include "convergence/gates/gate_run.hpp"
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
  gate.source = convergence::ResultSource{
      .file = file.write(text.substr(std::min(end + 1, text.size()))), .folder = {}, .made_by = {}};
  gate.quantity = std::string(text.substr(0, end));
  gate.bound = convergence::Interval{0.0, 1.0};
  gate.basis = "any";
  const auto judgements = convergence::run_gates({gate}, pool);
  if (judgements.size() != 1) std::abort();
  convergence::gates_text(judgements);
  convergence::gates_junit(judgements);
  convergence::gates_markdown(judgements);
  convergence::gates_json(judgements);
  return 0;
}
