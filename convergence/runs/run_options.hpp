#pragma once

#include <array>
#include <csignal>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "convergence/runs/process_pool.hpp"

namespace CLI {
class App;
}

/// Options of the commands that solve, and the signals that end them.
namespace slipstick::convergence {

/// --set, whose words are "key=value".
void add_set_option(CLI::App& command, std::vector<std::string>& overrides, const std::string& help);

/// --program, a file that is relative to here, as an override that names it; and --allow-programs.
void add_program_options(CLI::App& command, std::vector<std::string>& overrides, bool& allow);

/// --memory-limit, in bytes; none where it is not given.
void add_memory_option(CLI::App& command, std::optional<std::uint64_t>& bytes);

/// The options of commands that solve many scenes.
struct RunOptions {
  std::string output;                              ///< folder that keeps finished solves
  int jobs = 0;                                    ///< see ProcessPoolOptions
  std::optional<std::uint64_t> memory_limit = {};  ///< bytes
  std::string list = {};                           ///< gets the runs without a result; empty: they are solved
  bool allow_programs = false;                     ///< --allow-programs
  std::vector<std::string> overrides = {};         ///< by the command line, which may name a program
  std::shared_ptr<Progress> progress = std::make_shared<Progress>();  ///< of all pools

  /// --output, --jobs, --memory-limit.
  void add_to(CLI::App& command);
  /// --program, --allow-programs.
  void add_programs_to(CLI::App& command);
  /// --list-runs. of_judgement: options that need a judgement, which --list-runs does not make, so that the
  /// two exclude each other.
  void add_list_to(CLI::App& command, const std::vector<std::string>& of_judgement);

  /// The pool of these options; a signal noted by Interrupts stops it. lacking: gets the runs that --list-runs lists.
  ProcessPool pool(std::vector<PreparedRun>* lacking = nullptr) const;
  /// Writes the file of --list-runs, and the command's result; returns its exit code.
  int write_list(const std::vector<PreparedRun>& lacking, std::ostream& text, Json& result) const;
};

/// Notes SIGINT, SIGTERM and SIGHUP during its lifetime; signals that were ignored before, as under nohup,
/// stay ignored. Only the program's commands use it: a library leaves signals to its host.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// Whether any has come.
  static bool seen();

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace slipstick::convergence
