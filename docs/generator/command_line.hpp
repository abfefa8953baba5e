#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

/// What the program takes on its command line, as texts.
namespace slipstick::docs {

/// An option, or a file that stands without one.
struct OptionText {
  std::string name;                ///< "--json"; of positionals "scene"
  std::string value;               ///< "TEXT", "INT in [1 - 100]", "{a,b}"; empty: it takes none
  std::string otherwise;           ///< what holds where it is left out; empty: nothing to say
  std::string meaning;             ///< with what it needs and excludes
  std::vector<std::string> words;  ///< the values that are allowed; empty: any of its type
};

struct CommandText {
  std::string name;
  std::string meaning;
  std::string footer;  ///< examples and exit codes
  std::vector<OptionText> files;
  std::vector<OptionText> options;
};

/// The commands of a program in their order, without those and the options that --help hides.
std::vector<CommandText> command_texts(const CLI::App& app);

/// All of them as a page (Markdown).
std::string commands_markdown(const std::vector<CommandText>& commands);

/// As a manual page (troff, section 1).
std::string commands_manual(const std::vector<CommandText>& commands, const std::string& version);

/// As a script for bash that completes commands, options, the words and files that they take, and the keys of
/// a scene after --set.
std::string commands_completion(const std::vector<CommandText>& commands,
                                const std::vector<std::string>& scene_keys);

}  // namespace slipstick::docs
