#include "convergence/programs/command_word.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "solver/input/input_error.hpp"
#include "solver/input/misspelling.hpp"

namespace slipstick::convergence {

void require_command(const CLI::App& app, int argc, const char* const* argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  if (word.empty() || word.starts_with("-")) return;
  std::vector<std::string> shown;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return;
    if (!command->get_group().empty()) shown.emplace_back(command->get_name());
  }
  throw solver::InputError(word, fmt::format("is no command; the nearest is {}, slipstick --help lists all",
                                             solver::nearest_word(word, shown)));
}

}  // namespace slipstick::convergence
