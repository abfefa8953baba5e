#include "convergence/commands.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>

#include "convergence/gates/gate.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/results/output.hpp"
#include "convergence/runs/run_options.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/studies/study.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

struct GateRequest {
  std::vector<std::string> files;
  std::vector<std::string> only;
  std::string junit;
  std::string summary;
  std::string results;
  RunOptions runs{.output = "build/gates"};
};

/// A gate whose source cannot be read says so when it is judged.
std::vector<std::filesystem::path> files_behind(const std::vector<Gate>& gates) {
  std::vector<std::filesystem::path> files;
  for (const Gate& gate : with_others(gates)) {
    if (gate.kind == GateSource::none) continue;
    files.push_back(gate.source);
    if (gate.kind == GateSource::result) continue;
    try {
      Study study;
      study.scene = gate.source;
      study.overrides = gate.overrides;
      if (gate.kind == GateSource::study) study = read_study(gate.source, gate.overrides);
      const auto of_scene = input_files(solver::read_scene(study.scene, study.overrides));
      files.insert(files.end(), of_scene.begin(), of_scene.end());
    } catch (const solver::InputError&) {
    }
  }
  return files;
}

int run_gate(const CLI::App& command, const GateRequest& request, std::ostream& text, Json& result) {
  const std::optional<Shard> shard = request.runs.wanted_shard();
  require_output("--junit", request.junit);
  require_output("--summary", request.summary);
  const GateFiles files = read_gate_files(request.files, request.results);
  require_inputs_kept(command, files_behind(files.gates));
  std::vector<Judgement> judgements = files.unreadable;
  const Interrupts interrupts;
  const ProcessPool pool = request.runs.pool();
  std::vector<Gate> gates = select_gates(files.gates, request.only);
  for (Gate& gate : gates) {
    const std::vector<std::string>& set = request.runs.overrides;
    if (gate.kind != GateSource::result) gate.overrides.insert(gate.overrides.end(), set.begin(), set.end());
  }
  if (shard) {
    result = run_shard(gate_runs(gates, pool), *shard, pool);
    text << shard_text(result);
    return is_complete(result) ? 0 : 1;
  }
  if (!request.runs.merged.empty()) require_finished(gate_runs(gates, pool), pool);
  std::vector<Judgement> judged = run_gates(gates, pool);
  for (Judgement& judgement : judged) {
    const std::string of_file = complaint_of_file(judgement.why, request.runs.overrides);
    if (of_file.empty()) continue;
    judgement.why = fmt::format("{}:{}: {}", judgement.gate.file.string(), judgement.gate.line, of_file);
  }
  judgements.insert(judgements.end(), judged.begin(), judged.end());

  result = gates_json(judgements);
  text << gates_text(judgements);
  write_option_file("--junit", request.junit, gates_junit(judgements));
  write_option_file("--summary", request.summary, gates_markdown(judgements));
  if (judgements.empty()) {
    throw solver::InputError(request.files.front(), "no gate ran; allowed: tables headed [[gate]]");
  }
  return exit_code(judgements);
}

}  // namespace

RunCommand add_gate_command(CLI::App& app) {
  const auto request = std::make_shared<GateRequest>();
  CLI::App* const command =
      app.add_subcommand("gate", "Run accuracy gates: numbers with bounds that they must keep");
  command->add_option("files", request->files, "gate files (TOML)")->required();
  command->add_option("--only", request->only, "run the gates with these ids alone; stands after the files");
  command->add_option("--junit", request->junit, "write JUnit XML, as CI servers read it, to this file");
  command->add_option("--summary", request->summary, "write a Markdown table, the worst first, below 64 kB");
  command->add_option("--results", request->results,
                      "folder of the result files that gates name, in place of the gate file's own");
  request->runs.add_to(*command);
  request->runs.add_programs_to(*command);
  request->runs.add_shards_to(*command, {"--junit", "--summary"});
  command->footer(
      "Example:\n  slipstick gate convergence/gates/quick.toml --junit gates.xml --summary summary.md\n"
      "Exit code 0: all gates pass; 1: an active gate fails, or an expected failure passes; 2: something "
      "could not be judged, or no gate ran. Finished solves are kept: repeating an interrupted command goes "
      "on from there.");
  return running(command, request, run_gate);
}

}  // namespace slipstick::convergence
