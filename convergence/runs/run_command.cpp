#include "convergence/commands.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "convergence/programs/output_options.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/run_list.hpp"
#include "convergence/runs/run_options.hpp"

namespace slipstick::convergence {
namespace {

struct RunRequest {
  std::string list;
  std::size_t only = 0;
  RunOptions runs;
};

/// A record that is not kept: its process died, or the machine has too little memory.
bool has_no_result(const SolveRecord& record) { return record.status == RunStatus::failed || record.out_of_memory; }

Json row_json(const ListedRun& listed, const SolveRecord& record) {
  Json row{{"line", listed.line},
           {"name", listed.run.name},
           {"run", run_text(listed.run.spec)},
           {"output", listed.folder.string()},
           {"status", to_string(record.status)}};
  if (!record.message.empty()) row["message"] = record.message;
  set_number(row, "seconds", record.seconds(), "there is no answer");
  return row;
}

int run_listed(const CLI::App& command, const RunRequest& request, std::ostream& text, Json& result) {
  std::vector<ListedRun> runs = read_run_list(request.list, request.only);
  std::map<std::filesystem::path, std::vector<PreparedRun>> by_folder;
  for (ListedRun& listed : runs) {
    const std::vector<std::filesystem::path> inputs = input_files(listed.run.scene);
    require_inputs_kept(command, inputs);
    require_input_kept(fmt::format("{}:{}: fields", request.list, listed.line), listed.run.spec.fields, inputs);
    if (!request.runs.output.empty()) listed.folder = request.runs.output;
    by_folder[listed.folder].push_back(listed.run);
  }
  std::map<std::filesystem::path, std::vector<SolveRecord>> records;
  const Interrupts interrupts;
  for (const auto& [folder, prepared] : by_folder) {
    RunOptions options = request.runs;
    options.output = folder;
    records[folder] = options.pool().run_prepared(prepared);
  }
  int exit_code = 0;
  result = {{"runs", Json::array()}};
  std::map<std::filesystem::path, std::size_t> next;
  for (const ListedRun& listed : runs) {
    const SolveRecord& record = records[listed.folder][next[listed.folder]++];
    if (has_no_result(record)) exit_code = 1;
    result["runs"].push_back(row_json(listed, record));
    text << fmt::format("{}  {}: {}{}\n", listed.line, run_text(listed.run.spec), to_string(record.status),
                        record.message.empty() ? "" : ": " + record.message);
  }
  result["provenance"] = provenance(1);
  return exit_code;
}

}  // namespace

RunCommand add_run_command(CLI::App& app) {
  const auto request = std::make_shared<RunRequest>();
  CLI::App* const command =
      app.add_subcommand("run", "Solve the runs that study, gate or hard have listed, all or one of them");
  command->add_option("list", request->list, "file that --list-runs has written (a JSON object a line)")->required();
  command->add_option("--only", request->only, "solve the run on this line, counted from 1")
      ->check(CLI::PositiveNumber);
  request->runs.add_to(*command);
  command->get_option("--output")->description("folder that keeps finished solves, instead of the one listed");
  request->runs.add_programs_to(*command);
  command->footer(
      "Example:\n  slipstick study convergence/studies/paper_mesh.toml --list-runs runs.jsonl\n"
      "  slipstick run runs.jsonl\n  slipstick study convergence/studies/paper_mesh.toml\nExit code 0: each "
      "run has a result, which the command that listed it finds; 1: some run failed; 2: bad input.");
  return running(command, request, run_listed);
}

}  // namespace slipstick::convergence
