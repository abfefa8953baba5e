#include "docs/generator/reference_command.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>
#include <string>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/gates/gate_reader.hpp"
#include "convergence/hard/hard_case.hpp"
#include "convergence/studies/study.hpp"
#include "solver/scene/scene_keys.hpp"

namespace slipstick::docs {
namespace {

using Json = nlohmann::ordered_json;
using solver::KeyType;

const solver::Words<KeyType> kTypes{{"number", KeyType::number},
                                    {"[a, b], two numbers", KeyType::pair},
                                    {"[a, b, ...], numbers", KeyType::numbers},
                                    {"one of some words", KeyType::word},
                                    {"text", KeyType::text},
                                    {"[\"a\", \"b\", ...], texts", KeyType::texts},
                                    {"path, relative to this file", KeyType::file},
                                    {"true or false", KeyType::flag},
                                    {"[a, b, ...], values", KeyType::values},
                                    {"table, { \"key\" = value }", KeyType::table},
                                    {"tables", KeyType::tables}};

Json keys_json(const solver::SettingKeys& keys) {
  Json list = Json::array();
  for (const solver::SettingKey& key : keys) {
    list.push_back({{"name", key.name},
                    {"type", solver::word_of(kTypes, key.type)},
                    {"unit", key.unit},
                    {"default", key.otherwise},
                    {"allowed", key.type == KeyType::flag ? "true, false" : key.allowed.words},
                    {"meaning", key.meaning},
                    {"shapes", key.shapes}});
  }
  return list;
}

/// The library keeps its options by address: the names are sorted.
std::set<std::string> names_of(const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* const option : options) names.insert(option->get_name());
  return names;
}

/// one_required: the option belongs to a group of which one must be given.
Json option_json(const CLI::Option& option, bool one_required) {
  return {{"name", option.get_positional() ? option.get_name(true) : option.get_name(false, true)},
          {"file", option.get_positional()},
          {"type", option.get_type_size() == 0 ? "" : option.get_type_name()},
          {"two_values", option.get_expected_min() == 2},
          {"many_values", option.get_expected_max() == CLI::detail::expected_max_vector_size},
          {"required", option.get_required()},
          {"one_required", one_required},
          {"default", option.get_default_str()},
          {"meaning", option.get_description()},
          {"needs", names_of(option.get_needs())},
          {"excludes", names_of(option.get_excludes())}};
}

void add_options(const CLI::App& app, bool is_group, Json& list) {
  for (const CLI::Option* const option : app.get_options()) {
    const bool has_own_help = is_group && option->get_name() == "--help";
    if (option->get_group().empty() || has_own_help) continue;
    list.push_back(option_json(*option, is_group && app.get_require_option_min() > 0));
  }
}

Json commands_json(const CLI::App& app) {
  const auto all = [](const CLI::App*) { return true; };
  Json commands = Json::array();
  for (const CLI::App* const command : app.get_subcommands(all)) {
    if (command->get_group().empty()) continue;
    Json options = Json::array();
    for (const CLI::App* const group : command->get_subcommands(all)) add_options(*group, true, options);
    add_options(*command, false, options);
    commands.push_back({{"name", command->get_name()},
                        {"meaning", command->get_description()},
                        {"footer", command->get_footer()},
                        {"options", options}});
  }
  return commands;
}

}  // namespace

convergence::RunCommand add_reference_command(CLI::App& app) {
  constexpr const char* kHidden = "";
  app.add_subcommand("reference", "Give commands, options and keys of files as data")->group(kHidden);
  return [&app](std::ostream& text, Json& result) {
    text << "--json FILE has the commands, their options and the keys of files\n";
    result = {{"version", SLIPSTICK_VERSION},
              {"commands", commands_json(app)},
              {"keys",
               {{"scene", keys_json(solver::scene_keys())},
                {"study", keys_json(convergence::study_keys())},
                {"gate", keys_json(convergence::gate_keys())},
                {"hard", keys_json(convergence::hard_keys())},
                {"program", keys_json(convergence::program_keys())}}}};
    return 0;
  };
}

}  // namespace slipstick::docs
