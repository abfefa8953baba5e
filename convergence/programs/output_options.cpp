#include "convergence/programs/output_options.hpp"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <span>
#include <system_error>

#include "solver/input/input_error.hpp"
#include "solver/input/misspelling.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// The options of all commands that name an output file.
constexpr std::array<std::string_view, 15> kOutputs{
    "--json",    "--fields",     "--figure",    "--loop",    "--summary", "--junit",   "--accuracy-data",
    "--write",   "--checkpoint", "--list-runs", "--history", "--badge",   "--bencher", "--benchmark-action",
    "--stresses"};
/// Prefix of a file's name in `exact --profile`.
constexpr std::string_view kProfileFile = "file:";

bool is_output(const CLI::Option& option) { return std::ranges::find(kOutputs, option.get_name()) != kOutputs.end(); }

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

/// The long names of a command's options, with those of its groups.
void add_option_names(const CLI::App& command, std::vector<std::string>& names) {
  for (const CLI::Option* const option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const CLI::App* const group : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (group->get_name().empty()) add_option_names(*group, names);
  }
}

}  // namespace

void require_input_kept(const std::string& option, const std::string& output, const std::vector<fs::path>& inputs) {
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
  std::vector<std::string> shown{"--help", "--version"};
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return;
    if (!command->get_group().empty()) shown.emplace_back(command->get_name());
  }
  throw solver::InputError(word, fmt::format("is no command; the nearest is {}, slipstick --help lists all",
                                             solver::nearest_word(word, shown)));
}

void require_known_options(const CLI::App& app, int argc, const char* const* argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  const auto subcommands = app.get_subcommands([&](const CLI::App* each) { return each->get_name() == first; });
  const CLI::App* const command = subcommands.empty() ? &app : subcommands.front();
  std::vector<std::string> known;
  add_option_names(*command, known);
  std::vector<std::string> unknown;
  for (const char* const word : std::span(argv, static_cast<std::size_t>(argc)).subspan(1)) {
    const std::string option = std::string(word).substr(0, std::string_view(word).find('='));
    const std::size_t dashes = std::min(option.find_first_not_of('-'), option.size());
    const std::string name = option.substr(dashes);
    const bool is_long = dashes > 0 && name.size() > 1 && std::isalpha(static_cast<unsigned char>(name[0]));
    if (!is_long || std::ranges::find(known, option) != known.end()) continue;
    const std::string nearest = solver::nearest_word("--" + name, known);
    unknown.push_back(fmt::format("{}: unknown option; the nearest is {}", option, nearest));
  }
  if (!unknown.empty()) throw solver::InputError(command->get_name(), fmt::format("{}", fmt::join(unknown, "\n  ")));
}

}  // namespace slipstick::convergence
