#include "docs/generator/reference_command.hpp"

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <ostream>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/gates/gate_reader.hpp"
#include "convergence/hard/hard_case.hpp"
#include "convergence/studies/study.hpp"
#include "docs/generator/command_line.hpp"
#include "docs/generator/key_page.hpp"
#include "solver/input/whole_file.hpp"
#include "solver/scene/scene_keys.hpp"

namespace slipstick::docs {
namespace {

/// The keys for --set: keys of tables that occur once.
std::vector<std::string> keys_of_one_table() {
  std::vector<std::string> names;
  for (const solver::SettingKey& key : solver::scene_keys()) {
    const bool several = key.name.starts_with("upper.shape.") || key.name.starts_with("step");
    if (!several) names.push_back(key.name);
  }
  return names;
}

std::map<std::string, std::string> pages(const CLI::App& app) {
  const std::vector<CommandText> commands = command_texts(app);
  return {{"scene.md",
           keys_markdown(
               {"Keys of a scene",
                "`slipstick solve SCENE.toml`, and every command that takes a scene, reads these keys. Units "
                "are SI, or\nany other consistent set, though results print SI units. `--set "
                "key=value` overrides any key, with its table:\n`--set load.moment_ratio=0.5`, "
                "`--set \"step[0].moment=2\"`. The meanings of allowed words are in the order of the words."},
               solver::scene_keys())},
          {"study.md", keys_markdown({"Keys of a study", "`slipstick study STUDY.toml` reads these keys."},
                                     convergence::study_keys())},
          {"gate.md", keys_markdown({"Keys of a gate", "`slipstick gate GATES.toml` reads these keys."},
                                    convergence::gate_keys())},
          {"hard.md", keys_markdown({"Keys of hard cases", "`slipstick hard CASES.toml` reads these keys."},
                                    convergence::hard_keys())},
          {"program.md", keys_markdown({"Keys of a program",
                                        "`solver.program` and `--program FILE` name a file with these keys."},
                                       convergence::program_keys())},
          {"commands.md", commands_markdown(commands)},
          {"slipstick.1", commands_manual(commands, SLIPSTICK_VERSION)},
          {"slipstick.bash", commands_completion(commands, keys_of_one_table())}};
}

}  // namespace

convergence::RunCommand add_reference_command(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  constexpr const char* kHidden = "";
  CLI::App* const command =
      app.add_subcommand("reference", "Write the reference that is made from the program");
  command->group(kHidden);
  command->add_option("folder", *folder, "folder for the pages")->required();
  return [&app, folder](std::ostream& text, nlohmann::ordered_json&) {
    solver::make_folder(*folder);
    for (const auto& [name, content] : pages(app)) {
      const std::filesystem::path file = std::filesystem::path(*folder) / name;
      solver::write_whole_file(file, content);
      text << file.string() << '\n';
    }
    return 0;
  };
}

}  // namespace slipstick::docs
