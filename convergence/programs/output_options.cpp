#include "convergence/programs/output_options.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <map>
#include <system_error>

#include "solver/input/input_error.hpp"
#include "solver/input/setting_key.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// The options of all commands that name an output file.
constexpr std::array<std::string_view, 9> kOutputs{"--json",    "--fields",     "--figure",
                                                   "--summary", "--junit",      "--accuracy-data",
                                                   "--write",   "--checkpoint", "--list-runs"};
/// Prefix of a file's name in `exact --profile`.
constexpr std::string_view kProfileFile = "file:";

bool is_output(const CLI::Option& option) {
  return std::ranges::find(kOutputs, option.get_name()) != kOutputs.end();
}

bool is_same_file(const fs::path& one, const fs::path& other) {
  std::error_code error;
  return fs::equivalent(one, other, error) && !error;
}

void require_outputs_apart(const CLI::App& command) {
  std::map<fs::path, std::string> options;
  for (const CLI::Option* const option : command.get_options()) {
    if (!is_output(*option)) continue;
    for (const std::string& output : option->results()) {
      if (output == "-") continue;
      if (output.empty() || output.starts_with("--")) {
        throw solver::InputError(fmt::format("{} '{}'", option->get_name(), output),
                                 "names no file; allowed: a file's name, as ./FILE where it begins with --");
      }
      std::error_code error;
      const fs::path target = fs::weakly_canonical(solver::behind_links(fs::absolute(output, error)), error);
      if (!fs::is_regular_file(target, error) && fs::exists(target, error)) continue;  // a device takes all
      const auto [other, is_new] = options.emplace(target, option->get_name() + " " + output);
      if (is_new) continue;
      throw solver::InputError(fmt::format("{} {}", option->get_name(), output),
                               fmt::format("is the file of {} too; allowed: another file", other->second));
    }
  }
}

}  // namespace

void require_input_kept(const std::string& option, const std::string& output,
                        const std::vector<fs::path>& inputs) {
  const auto same = [&](const fs::path& input) { return is_same_file(input, output); };
  const auto overwritten = std::ranges::find_if(inputs, same);
  if (overwritten == inputs.end()) return;
  throw solver::InputError(
      fmt::format("{} {}", option, output),
      fmt::format("would overwrite {}, which is read; allowed: another file", overwritten->string()));
}

void require_inputs_kept(const CLI::App& command, const std::vector<fs::path>& inputs) {
  for (const CLI::Option* const option : command.get_options()) {
    if (!is_output(*option)) continue;
    for (const std::string& output : option->results()) {
      require_input_kept(option->get_name(), output, inputs);
    }
  }
}

void require_inputs_kept(const CLI::App& command) {
  std::vector<fs::path> inputs;
  for (const CLI::Option* const option : command.get_options()) {
    if (is_output(*option)) continue;
    for (const std::string& word : option->results()) {
      inputs.emplace_back(word);
      if (word.starts_with(kProfileFile)) inputs.emplace_back(word.substr(kProfileFile.size()));
    }
  }
  require_inputs_kept(command, inputs);
  require_outputs_apart(command);
}

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
