#include "docs/generator/command_line.hpp"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "convergence/results/markup.hpp"

namespace slipstick::docs {
namespace {

using convergence::markdown_cell;

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += by.size()) {
    text.replace(at, old.size(), by);
  }
  return text;
}

/// The type's name, with its range or its allowed words: "INT:INT in [1 - 9]".
std::string value_of(const CLI::Option& option) {
  if (option.get_type_size() == 0) return "";
  std::string type = option.get_type_name();
  const auto colon = type.find(':');
  if (colon != std::string::npos) {
    const std::string check = type.substr(colon + 1);
    const bool whole = check.starts_with("{") || check.find(" in ") != std::string::npos;
    type = whole ? check : type.substr(0, colon) + " " + check;
  }
  if (option.get_expected_max() == CLI::detail::expected_max_vector_size) return type + " ...";
  return option.get_expected_min() == 2 ? type + " " + type : type;
}

/// The default as text: numbers in their shortest form, paths of this build by their last part.
std::string default_of(const CLI::Option& option) {
  const std::string text = option.get_default_str();
  if (option.get_type_name().starts_with("FLOAT") && !text.empty()) {
    return fmt::format("{:g}", std::stod(text));
  }
  const std::filesystem::path path(text);
  return path.is_absolute() ? path.filename().string() + " of this build" : text;
}

std::vector<std::string> words_of(const std::string& value) {
  const auto open = value.find('{');
  const auto close = value.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  std::istringstream list(value.substr(open + 1, close - open - 1));
  std::vector<std::string> words;
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

/// "; needs --a, --b", sorted, since the library keeps no order.
std::string relation(const char* verb, const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* const option : options) names.insert(option->get_name());
  return names.empty() ? "" : fmt::format("; {} {}", verb, fmt::join(names, ", "));
}

OptionText option_text(const CLI::Option& option) {
  OptionText text{.name = option.get_positional() ? option.get_name(true) : option.get_name(false, true),
                  .value = value_of(option),
                  .otherwise = option.get_required() ? "required" : default_of(option),
                  .meaning = option.get_description() + relation("needs", option.get_needs()) +
                             relation("excludes", option.get_excludes()),
                  .words = {}};
  text.words = words_of(text.value);
  return text;
}

void add_options(const CLI::App& app, const std::string& suffix, CommandText& command) {
  for (const CLI::Option* const option : app.get_options()) {
    if (option->get_group().empty()) continue;
    OptionText text = option_text(*option);
    text.meaning += suffix;
    (option->get_positional() ? command.files : command.options).push_back(text);
  }
}

/// Adds a group of options, which the library treats as a command with a --help of its own.
void add_group(const CLI::App& group, CommandText& command) {
  add_options(group, group.get_require_option_min() > 0 ? "; one of these is required" : "", command);
  std::erase_if(command.options, [](const OptionText& option) { return option.name.ends_with("--help"); });
}

std::string usage(const CommandText& command) {
  std::string line = fmt::format("slipstick {} [OPTIONS]", command.name);
  for (const OptionText& file : command.files) {
    const std::string more = file.value.ends_with("...") ? "..." : "";
    line += file.otherwise == "required" ? fmt::format(" {}{}", file.name, more)
                                         : fmt::format(" [{}{}]", file.name, more);
  }
  return line;
}

std::string in_code(const std::string& text) {
  return text.empty() ? "" : fmt::format("`{}`", replaced(text, "|", "\\|"));
}

/// Text for a manual page, where no line may begin with a dot or a quote.
std::string in_troff(const std::string& text) {
  std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  safe = replaced(replaced(safe, "\n.", "\n\\&."), "\n'", "\n\\&'");
  return safe.starts_with(".") || safe.starts_with("'") ? "\\&" + safe : safe;
}

std::string in_manual(const OptionText& option) {
  const std::string otherwise =
      option.otherwise.empty()
          ? ""
          : fmt::format(" ({})",
                        option.otherwise == "required" ? option.otherwise : "default: " + option.otherwise);
  return fmt::format(".TP\n\\fB{}\\fR{}\n{}{}\n", in_troff(option.name),
                     option.value.empty() ? "" : " " + in_troff(option.value), in_troff(option.meaning),
                     in_troff(otherwise));
}

std::string names_of(const std::vector<OptionText>& options) {
  std::vector<std::string> names;
  for (const OptionText& option : options) {
    const auto comma = option.name.rfind(',');
    names.push_back(comma == std::string::npos ? option.name : option.name.substr(comma + 1));
  }
  return fmt::format("{}", fmt::join(names, " "));
}

/// The cases of a command: after an option its words, the keys of a scene or files; otherwise all options.
std::string completion_cases(const CommandText& command) {
  std::string cases;
  std::string with_files;
  for (const OptionText& option : command.options) {
    if (option.value.empty()) continue;
    const std::string place = fmt::format("\"{} {}\"", command.name, names_of({option}));
    if (option.name == "--set") {
      cases +=
          fmt::format("      {}) words=\"$_slipstick_keys\"; compopt -o nospace 2>/dev/null ;;\n", place);
    } else if (!option.words.empty()) {
      cases += fmt::format("      {}) words=\"{}\" ;;\n", place, fmt::join(option.words, " "));
    } else {
      with_files += (with_files.empty() ? "" : " | ") + place;
    }
  }
  if (!with_files.empty()) cases += fmt::format("      {}) return ;;\n", with_files);
  return cases + fmt::format("      \"{} \"*) [[ $current != -* ]] || words=\"{}\" ;;\n", command.name,
                             names_of(command.options));
}

}  // namespace

std::vector<CommandText> command_texts(const CLI::App& app) {
  std::vector<CommandText> commands;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_group().empty()) continue;
    CommandText text{command->get_name(), command->get_description(), command->get_footer(), {}, {}};
    for (const CLI::App* const group : command->get_subcommands([](const CLI::App*) { return true; })) {
      add_group(*group, text);
    }
    add_options(*command, "", text);
    commands.push_back(std::move(text));
  }
  return commands;
}

std::string commands_markdown(const std::vector<CommandText>& commands) {
  std::string page =
      "# Commands\n\nWritten by `make reference` from the program's own options; a test fails where this "
      "page "
      "differs from\nthem. `slipstick COMMAND --help` prints the same. See also [results](results.md) and "
      "[exit codes](exit-codes.md).\n\n| command | task |\n|---|---|\n";
  for (const CommandText& command : commands) {
    page += fmt::format("| [`{0}`](#slipstick-{0}) | {1} |\n", command.name, markdown_cell(command.meaning));
  }
  for (const CommandText& command : commands) {
    page += fmt::format("\n## slipstick {}\n\n{}.\n\n```text\n{}\n```\n\n", command.name, command.meaning,
                        usage(command));
    page += "| option | value | default | meaning |\n|---|---|---|---|\n";
    for (const auto* const options : {&command.files, &command.options}) {
      for (const OptionText& option : *options) {
        page += fmt::format("| `{}` | {} | {} | {} |\n", option.name, in_code(option.value),
                            markdown_cell(option.otherwise), markdown_cell(option.meaning));
      }
    }
    page += fmt::format("\n```text\n{}\n```\n", command.footer);
  }
  return page;
}

std::string commands_manual(const std::vector<CommandText>& commands, const std::string& version) {
  std::string page = fmt::format(
      ".\\\" Written by make reference from the program's own options.\n"
      ".TH SLIPSTICK 1 \"\" \"slipstick {}\" \"User Commands\"\n.SH NAME\n"
      "slipstick \\- the elastic torsional contact with slip and stick, exact and numerical, compared\n"
      ".SH SYNOPSIS\n.B slipstick\n.I COMMAND\n[OPTIONS]\n.br\n.B slipstick\n\\-\\-help | \\-\\-version\n"
      ".SH DESCRIPTION\nEvery command explains itself with \\-\\-help. Scenes, studies, gates and hard cases "
      "are TOML files; their keys stand in docs/reference.\n.SH COMMANDS\n",
      in_troff(version));
  for (const CommandText& command : commands) {
    page += fmt::format(".SS \"{}\"\n{}.\n.PP\n.nf\n{}\n.fi\n", in_troff(command.name),
                        in_troff(command.meaning), in_troff(usage(command)));
    for (const OptionText& file : command.files) page += in_manual(file);
    for (const OptionText& option : command.options) page += in_manual(option);
    page += fmt::format(".PP\n.nf\n{}\n.fi\n", in_troff(command.footer));
  }
  return page +
         ".SH EXIT STATUS\n.TP\n0\nDone; everything that was judged is good.\n.TP\n1\nJudged and failed: a "
         "gate, a "
         "regression, a solve that did not reach its tolerance.\n.TP\n2\nNothing was judged: bad input, a "
         "missing file, loads that the contact cannot carry, no memory.\n";
}

std::string commands_completion(const std::vector<CommandText>& commands,
                                const std::vector<std::string>& scene_keys) {
  std::string names;
  for (const CommandText& command : commands) names += command.name + " ";
  std::string script = fmt::format(
      "# bash completion of slipstick, written by `make reference` from the program's own options.\n"
      "# In zsh: autoload -U +X bashcompinit && bashcompinit, then source this file.\n"
      "_slipstick() {{\n"
      "  local current=\"${{COMP_WORDS[COMP_CWORD]}}\" previous=\"${{COMP_WORDS[COMP_CWORD - 1]}}\"\n"
      "  local words=\"\"\n"
      "  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    words=\"{}--help --version\"\n"
      "  else\n"
      "    case \"${{COMP_WORDS[1]}} $previous\" in\n",
      names);
  for (const CommandText& command : commands) script += completion_cases(command);
  return script + fmt::format(
                      "    esac\n  fi\n"
                      "  [ -z \"$words\" ] || COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n}}\n"
                      "_slipstick_keys=\"{}=\"\n"
                      "# If no word matches, bash completes files.\n"
                      "complete -o default -F _slipstick slipstick\n",
                      fmt::join(scene_keys, "= "));
}

}  // namespace slipstick::docs
