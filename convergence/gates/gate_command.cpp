#include "convergence/commands.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>
#include <variant>

#include "convergence/gates/gate_reader.hpp"
#include "convergence/gates/gate_report.hpp"
#include "convergence/gates/gate_run.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/programs/package_module.hpp"
#include "convergence/results/output.hpp"
#include "convergence/runs/run_options.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/studies/study.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::convergence {
namespace {

/// Options that name files which the module `ci` of the Python package makes of a run, and their help.
constexpr std::array kExports{
    std::pair{"--history", "add this run to a file, a JSON object a line: commit, date, values with bounds, times"},
    std::pair{"--figure", "draw the values of --history with their bounds over the runs (.svg)"},
    std::pair{"--badge", "write the counts for a badge of shields.io's endpoint"},
    std::pair{"--bencher", "write values and times in Bencher's format (BMF JSON)"},
    std::pair{"--benchmark-action",
              "write them for github-action-benchmark (customSmallerIsBetter), numbers over their bounds"}};

struct GateRequest {
  std::vector<std::string> files;
  std::vector<std::string> only;
  std::string junit;
  std::string summary;
  std::string results;
  std::map<std::string, std::string> exports;  ///< files by the options of kExports
  std::string times;
  bool list = false;
  RunOptions runs{.output = "build/gates"};
};

/// The files that the gates read; a source that cannot be read is refused when its gate is judged.
std::vector<std::filesystem::path> files_behind(const std::vector<Gate>& gates) {
  std::vector<std::filesystem::path> files;
  const auto add_scene = [&](const std::filesystem::path& scene, const std::vector<std::string>& overrides) {
    std::ranges::move(input_files(solver::read_scene(scene, overrides)), std::back_inserter(files));
  };
  for (const GateSource& source : sources_of(gates)) {
    if (const auto file = file_of(source); !file.empty()) files.push_back(file);
    try {
      if (const auto* const scene = std::get_if<SceneSource>(&source)) add_scene(scene->file, scene->overrides);
      if (const auto* const of_study = std::get_if<StudySource>(&source)) {
        const Study study = read_study(of_study->file, of_study->overrides);
        add_scene(study.scene, study.overrides);
      }
    } catch (const solver::InputError&) {
    }
  }
  return files;
}

/// The gates with further overrides of their scenes.
std::vector<Gate> with_overrides(std::vector<Gate> gates, const std::vector<std::string>& further) {
  for (Gate& gate : gates) {
    std::vector<std::string>* overrides = nullptr;
    if (auto* const scene = std::get_if<SceneSource>(&gate.source)) overrides = &scene->overrides;
    if (auto* const study = std::get_if<StudySource>(&gate.source)) overrides = &study->overrides;
    if (overrides != nullptr) overrides->insert(overrides->end(), further.begin(), further.end());
  }
  return gates;
}

/// Lists the gates, judged or not. Exit code 2 where a file cannot be read.
int list_gates(const GateRequest& request, std::ostream& text, Json& result) {
  GateFiles files = read_gate_files(request.files, request.results);
  std::vector<Judgement>& listed = files.unreadable;
  const int code = listed.empty() ? 0 : 2;
  const auto as_listed = [](const Gate& gate) { return refuse(gate, ""); };
  std::ranges::transform(with_overrides(select_gates(files.gates, request.only), request.runs.overrides),
                         std::back_inserter(listed), as_listed);
  text << list_text(listed);
  result = list_json(listed);
  return code;
}

void require_exports(const GateRequest& request) {
  for (const auto& [option, file] : request.exports) require_output(option, file);
  const auto figure = request.exports.find("--figure");
  if (figure != request.exports.end() && !figure->second.empty() && !figure->second.ends_with(".svg"))
    throw solver::InputError("--figure " + figure->second, "allowed ending: .svg");
  if (!request.times.empty())
    solver::require_input_file(request.times, solver::kLargestJson, "a file of benchmarks (JSON)");
}

void write_exports(const GateRequest& request, const Json& result) {
  Json files = Json::object();
  for (const auto& [option, file] : request.exports) {
    if (!file.empty()) files[option] = file;
  }
  if (files.empty()) return;
  const ModuleAnswer answer =
      run_package_module("ci", {{"files", files}, {"times", request.times}, {"result", result}});
  for (const auto& [option, text] : answer.rest.at("texts").items()) {
    const auto write = option == "--history" ? append_option_file : write_option_file;
    write(option, files.at(option), text);
  }
}

int run_gate(const CLI::App& command, const GateRequest& request, std::ostream& text, Json& result) {
  if (request.list) return list_gates(request, text, result);
  require_output("--junit", request.junit);
  require_output("--summary", request.summary);
  require_exports(request);
  const GateFiles files = read_gate_files(request.files, request.results);
  require_inputs_kept(command, files_behind(files.gates));
  std::vector<Judgement> judgements = files.unreadable;
  const Interrupts interrupts;
  std::vector<PreparedRun> lacking;
  const ProcessPool pool = request.runs.pool(&lacking);
  const std::vector<Gate> gates = with_overrides(select_gates(files.gates, request.only), request.runs.overrides);
  std::vector<Judgement> judged = run_gates(gates, pool);
  if (!request.runs.list.empty()) return request.runs.write_list(lacking, text, result);
  for (Judgement& judgement : judged) {
    const std::string of_file = complaint_of_file(judgement.why, request.runs.overrides);
    if (of_file.empty()) continue;
    judgement.why = fmt::format("{}:{}: {}", judgement.gate.file.string(), judgement.gate.line, of_file);
  }
  judgements.insert(judgements.end(), judged.begin(), judged.end());

  result = gates_json(judgements);
  text << gates_text(judgements);
  write_option_file("--junit", request.junit, gates_junit(judgements));
  append_option_file("--summary", request.summary, gates_markdown(judgements));
  write_exports(request, result);
  if (judgements.empty()) {
    throw solver::InputError(request.files.front(), "no gate ran; allowed: tables headed [[gate]]");
  }
  return exit_code(judgements);
}

}  // namespace

RunCommand add_gate_command(CLI::App& app) {
  const auto request = std::make_shared<GateRequest>();
  CLI::App* const command = app.add_subcommand("gate", "Run accuracy gates: numbers with bounds that they must keep");
  command->add_option("files", request->files, "gate files (TOML)")->required();
  command->add_option("--only", request->only,
                      "run only the gates with these ids, as 'paper-*' too; comes after the files");
  CLI::Option* const list = command->add_flag("--list", request->list,
                                              "list the gates with their files, quantities and bounds, and run none");
  command->add_option("--junit", request->junit, "write JUnit XML, as CI servers read it, to this file")
      ->excludes(list);
  command->add_option("--summary", request->summary, "add a Markdown table, the worst first, below 64 kB, to this file")
      ->excludes(list);
  std::vector<std::string> of_judgement{"--junit", "--summary", "--list"};
  for (const auto& [option, help] : kExports) {
    command->add_option(option, request->exports[option], help)->type_name("FILE")->excludes(list);
    of_judgement.emplace_back(option);
  }
  command->get_option("--figure")->needs(command->get_option("--history"));
  command
      ->add_option("--times", request->times,
                   "times for these files: of Google Benchmark, pytest-benchmark or hyperfine (JSON)")
      ->type_name("FILE");
  command->add_option("--results", request->results,
                      "folder of the result files that gates name (default: the gate file's folder)");
  request->runs.add_to(*command);
  request->runs.add_programs_to(*command);
  request->runs.add_list_to(*command, of_judgement);
  command->footer(
      "Example:\n  slipstick gate convergence/gates/quick.toml --junit gates.xml --summary summary.md\n"
      "Exit code 0: all gates pass; 1: an active gate fails, or an expected failure passes; 2: something "
      "could not be judged, or no gate ran. Finished solves are kept: an interrupted command "
      "continues when it is repeated.");
  return running(command, request, run_gate);
}

}  // namespace slipstick::convergence
