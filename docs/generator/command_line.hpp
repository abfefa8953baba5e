#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

/// The program's command line as text.
namespace slipstick::docs {

/// An option, or a file without an option.
struct OptionText {
  std::string name;                ///< "--json", or without dashes for a file
  std::string value;               ///< "TEXT", "INT in [1 - 100]", "{a,b}"; empty: it takes none
  std::string otherwise;           ///< the default, or "required"; empty: none
  std::string meaning;             ///< with the options that it needs and excludes
  std::vector<std::string> words;  ///< the allowed values; empty: any of its type
};

struct CommandText {
  std::string name;
  std::string meaning;
  std::string footer;  ///< examples and exit codes
  std::vector<OptionText> files;
  std::vector<OptionText> options;
};

/// The commands of a program in their order. Commands and options that --help hides are skipped.
std::vector<CommandText> command_texts(const CLI::App& app);

/// A page of all commands (Markdown).
std::string commands_markdown(const std::vector<CommandText>& commands);

/// A manual page of all commands (troff, section 1).
std::string commands_manual(const std::vector<CommandText>& commands, const std::string& version);

/// A script for bash that completes commands, options, their words and files, and a scene's keys after --set.
std::string commands_completion(const std::vector<CommandText>& commands,
                                const std::vector<std::string>& scene_keys);

}  // namespace slipstick::docs
