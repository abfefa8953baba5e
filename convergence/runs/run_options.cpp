#include "convergence/runs/run_options.hpp"

#include <CLI/CLI.hpp>

#include "convergence/system/machine.hpp"
#include "solver/input/input_error.hpp"

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

void RunOptions::add_programs_to(CLI::App& command) {
  add_program_options(command, overrides, allow_programs);
}

void RunOptions::add_shards_to(CLI::App& command, const std::vector<std::string>& of_judgement) {
  CLI::Option* const part =
      command
          .add_option("--shard", shard,
                      "I/N: solve the I-th of N parts of the runs, of about equal predicted work, keep their "
                      "results in --output and judge nothing; --merge does, of all parts")
          ->type_name("I/N");
  CLI::Option* const merge = command
                                 .add_option("--merge", merged,
                                             "folders in which shards kept their results: join them in "
                                             "--output and judge; stands last")
                                 ->type_name("FOLDER");
  part->excludes(merge);
  for (const std::string& option : of_judgement) part->excludes(command.get_option(option));
}

std::optional<Shard> RunOptions::wanted_shard() const {
  return shard.empty() ? std::nullopt : std::optional(read_shard(shard));
}

ProcessPool RunOptions::pool() const {
  for (const std::string& folder : merged) {
    if (!std::filesystem::is_directory(folder)) {
      throw solver::InputError("--merge " + folder, "is no folder; allowed: the --output folders of shards");
    }
  }
  return ProcessPool({.folder = output,
                      .jobs = jobs,
                      .memory_limit = memory_limit,
                      .program = own_program(),
                      .joined = {merged.begin(), merged.end()},
                      .interrupted = Interrupts::seen,
                      .programs = {allow_programs, overrides, own_program()}});
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
