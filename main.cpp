// The program: registers each folder's commands, maps errors to exit codes, nothing else.

#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analytic/command/exact_command.hpp"
#include "bench/commands.hpp"
#include "convergence/commands.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/results/output.hpp"
#include "convergence/system/run_program.hpp"
#include "docs/generator/reference_command.hpp"
#ifdef SLIPSTICK_INTERFACES
#include "interfaces/laws/law_command.hpp"
#endif
#include "solver/grid/ranks.hpp"
#include "solver/model/memory.hpp"

namespace {

using namespace slipstick;
using solver::Ranks;

constexpr int kCouldNotJudge = 2;

using Json = nlohmann::ordered_json;
/// Writes what a person reads, fills the result, returns the exit code.
using Command = std::function<int(std::ostream&, Json&)>;

void write_json(const std::string& path, const Json& result) {
  // Names of files need not be UTF-8; JSON is. On standard output, perhaps a terminal, it is ASCII.
  const std::string text = result.dump(2, ' ', path == "-", Json::error_handler_t::replace);
  if (path == "-") return convergence::write_standard_output(text + "\n");
  convergence::write_option_file("--json", path, text + "\n");
}

/// Ranks that fail, fail alike: one of them says so.
void complain(const std::exception& error, const Ranks& ranks) {
  if (ranks.first()) std::cerr << convergence::plain_text("slipstick: " + convergence::failure_text(error)) << '\n';
}

/// Best-effort write before an error is rethrown.
void keep(const std::function<void()>& write, const Ranks& ranks) {
  try {
    write();
  } catch (const std::exception& error) {
    complain(error, ranks);
  }
}

/// Runs a command that was parsed and writes its result: JSON to `json_path`, text unless `quiet`. Returns
/// the exit code.
int run_command(const Command& command, const CLI::App& parsed, const std::string& json_path, bool quiet,
                const Ranks& ranks) {
  convergence::require_inputs_kept(parsed);
  if (json_path != "-") convergence::require_output("--json", json_path);
  std::ostringstream text;
  Json result;
  const auto write_text = [&] {
    if (quiet || !ranks.first() || json_path == "-") return;
    convergence::write_standard_output(convergence::plain_text(text.str()));
  };
  // The file first: a reader of the text may leave, and so end this process.
  const auto write_out = [&] {
    try {
      if (!json_path.empty() && ranks.first() && !result.empty()) write_json(json_path, result);
    } catch (const std::exception&) {
      keep(write_text, ranks);
      throw;
    }
    write_text();
  };
  int exit_code = kCouldNotJudge;
  try {
    exit_code = command(text, result);
  } catch (const std::exception&) {
    if (!result.empty()) keep(write_out, ranks);  // what was computed before the error is not lost
    throw;
  }
  write_out();
  return exit_code;
}

/// Adds the command that the line begins with. Where it begins with none, adds all of them, for --help, for
/// misspelled commands and for the reference. Building every command's options doubles the start-up time.
std::vector<Command> add_commands(CLI::App& app, std::string_view first_word, const Ranks& ranks) {
  const auto add_solve = [&ranks](CLI::App& to) { return convergence::add_solve_command(to, ranks); };
  const std::vector<std::pair<std::string_view, std::function<Command(CLI::App&)>>> all{
      {"exact", analytic::add_exact_command},
      {"solve", add_solve},
      {"check", convergence::add_check_command},
#ifdef SLIPSTICK_INTERFACES
      {"law", laws::add_law_command},
#endif
      {"study", convergence::add_study_command},
      {"gate", convergence::add_gate_command},
      {"hard", convergence::add_hard_command},
      {"run", convergence::add_run_command},
      {"digits", convergence::add_digits_command},
      {"report", convergence::add_report_command},
      {"bench", bench::add_bench_command},
      {"compare", bench::add_compare_command},
      {"reference", docs::add_reference_command}};
  if (first_word == "--version") return {};
  const auto asked = std::ranges::find(all, first_word, [](const auto& entry) { return entry.first; });
  if (asked != all.end() && first_word != "reference") return {asked->second(app)};
  std::vector<Command> commands;
  for (const auto& [name, add] : all) commands.push_back(add(app));
  return commands;
}

int run(int argc, char** argv, const Ranks& ranks) {
  CLI::App app{"slipstick: the elastic torsional contact with slip and stick, exact and numerical, compared",
               "slipstick"};
  app.set_version_flag("--version", std::string(SLIPSTICK_VERSION));
  app.require_subcommand(1);

  const std::vector<Command> commands = add_commands(app, argc > 1 ? argv[1] : "", ranks);
  const auto subcommands = app.get_subcommands([](const CLI::App*) { return true; });
  std::string json_path;
  bool quiet = false;
  for (CLI::App* subcommand : subcommands) {
    subcommand->add_option("--json", json_path, "write the result as JSON to this file (- is stdout)");
    subcommand->add_flag("--quiet", quiet, "print no result text");
  }

  convergence::require_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) convergence::require_known_options(app, argc, argv);
    std::ostringstream output;
    std::ostringstream errors;
    const int left = app.exit(error, output, errors);
    if (ranks.first()) {
      std::cerr << convergence::plain_text(errors.str());
      convergence::write_standard_output(output.str());
    }
    return left == 0 ? 0 : kCouldNotJudge;
  }

  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (subcommands[i]->parsed()) return run_command(commands[i], *subcommands[i], json_path, quiet, ranks);
  }
  return kCouldNotJudge;
}

}  // namespace

int main(int argc, char** argv) {
  convergence::hold_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error like a full disk
  try {
    convergence::die_with_parent(argc, argv);
    // Other commands do not share their work: each process does all of it.
    std::optional<solver::JoinedRanks> joined;
    if (std::find(argv + 1, argv + argc, std::string_view("solve")) != argv + argc) joined.emplace();
    const Ranks ranks = joined ? joined->ranks() : Ranks();
    if (ranks.number() == 1) solver::prepare_heap();  // one of several ranks returns what it frees
    int exit_code = kCouldNotJudge;
    std::string failure;
    try {
      exit_code = run(argc, argv, ranks);
    } catch (const std::exception& error) {
      complain(error, ranks);
      failure = convergence::failure_text(error);
    }
    if (joined) joined->end(exit_code, failure);
    return exit_code;
  } catch (const std::exception& error) {
    complain(error, Ranks());
    return kCouldNotJudge;
  }
}
