#include "convergence/runs/run_options.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "convergence/results/output.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/runs/run_list.hpp"
#include "convergence/system/machine.hpp"

namespace slipstick::convergence {
namespace {

volatile std::sig_atomic_t interrupted = 0;

}  // namespace

void add_set_option(CLI::App& command, std::vector<std::string>& overrides, const std::string& help) {
  command.add_option("--set", overrides, "key=value: " + help)->take_all()->allow_extra_args(false);
}

void add_program_options(CLI::App& command, std::vector<std::string>& overrides, bool& allow) {
  const auto name = [&overrides](const std::string& file) { overrides.push_back(program_override(file)); };
  command
      .add_option_function<std::string>("--program", name,
                                        "let another program find pressure and tractions: the TOML file that "
                                        "says how it is started")
      ->type_name("FILE");
  command.add_flag("--allow-programs", allow,
                   "let programs run that scenes, studies and gates name: they may do whatever you may do");
}

void add_memory_option(CLI::App& command, std::optional<std::uint64_t>& bytes) {
  constexpr bool kThousands = true;  // 1 kB is 1000 bytes, 1 KiB is 1024
  command
      .add_option("--memory-limit", bytes,
                  "most memory that solving may take, e.g. 500MB, 4GiB, or bytes: what would take more is "
                  "refused; left out: what the machine has left")
      ->transform(CLI::AsSizeValue(kThousands).description(""))
      ->transform([](std::string size) {  // called first
        if (size.starts_with('-')) throw CLI::ValidationError("allowed: bytes above zero, as 500MB or 4GiB");
        return size;
      })
      ->type_name("SIZE");
}

void RunOptions::add_to(CLI::App& command) {
  command.add_option("--output", output, "folder that keeps finished solves")->capture_default_str();
  command.add_option("--jobs", jobs, "solves at a time; 0: one a processor, as memory allows")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  add_memory_option(command, memory_limit);
}

void RunOptions::add_programs_to(CLI::App& command) { add_program_options(command, overrides, allow_programs); }

void RunOptions::add_list_to(CLI::App& command, const std::vector<std::string>& of_judgement) {
  CLI::Option* const option =
      command
          .add_option("--list-runs", list,
                      "write the runs without a result in --output to this file, a JSON object a line, and "
                      "solve none: slipstick run solves them")
          ->type_name("FILE");
  for (const std::string& other : of_judgement) option->excludes(command.get_option(other));
}

ProcessPool RunOptions::pool(std::vector<PreparedRun>* lacking) const {
  return ProcessPool({.folder = output,
                      .jobs = jobs,
                      .memory_limit = memory_limit,
                      .program = own_program(),
                      .interrupted = Interrupts::seen,
                      .programs = {allow_programs, overrides, own_program()},
                      .lacking = list.empty() ? nullptr : lacking,
                      .progress = progress});
}

int RunOptions::write_list(const std::vector<PreparedRun>& lacking, std::ostream& text, Json& result) const {
  const std::string lines = run_list_text(lacking, output);
  write_option_file("--list-runs", list, lines);
  const auto count = std::ranges::count(lines, '\n');
  text << fmt::format("{} runs without a result are listed in {}\n", count, list);
  result = {{"listed", count}, {"list", list}, {"output", output}, {"provenance", provenance(1)}};
  return 0;
}

Interrupts::Interrupts() {
  interrupted = 0;
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };  // no SA_RESTART: waiting ends
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
}

Interrupts::~Interrupts() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

bool Interrupts::seen() { return interrupted != 0; }

}  // namespace slipstick::convergence
