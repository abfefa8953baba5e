#include "convergence/exchange/solver_program.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "convergence/programs/package_module.hpp"
#include "convergence/results/json_text.hpp"
#include "convergence/results/markup.hpp"
#include "convergence/results/output.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/toml_reader.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using solver::InputError;

/// The exit code of a program that does not solve such scenes.
constexpr int kNotForIt = 3;
/// Bytes of a program's output that are kept.
constexpr std::size_t kKept = 4096;
/// s, for a program to print its version.
constexpr double kVersionSeconds = 60.0;

const solver::Range kSeconds{"positive, at most 86400", [](double x) { return x > 0.0 && x <= 86400.0; }};

/// Puts a file's name wherever {name} stands in a word.
void replace(std::string& word, const std::string& name, const fs::path& file) {
  for (std::size_t at = 0; (at = word.find(name, at)) != std::string::npos; at += file.string().size())
    word.replace(at, name.size(), file.string());
}

ProgramEnd run(const SolverProgram& program, std::vector<std::string> words, double seconds, const fs::path& tied_by) {
  for (std::string& word : words) replace(word, "{python}", python_interpreter());
  const fs::path folder = program.file.parent_path();
  return Program(words, {.captured = Captured::everything,
                         .tied_by = tied_by,
                         .folder = folder.empty() ? fs::path(".") : folder,
                         .own_group = true})
      .wait_at_most(seconds, kKept);
}

/// The last line of a program's output, for a message; empty: no output.
std::string last_line(std::string said) {
  while (!said.empty() && (said.back() == '\n' || said.back() == '\r')) said.pop_back();
  return plain_text(as_utf8(said.substr(said.find_last_of('\n') + 1)));
}

std::string with_last_line(const std::string& text, const std::string& said) {
  const std::string line = last_line(said);
  return line.empty() ? text : fmt::format("{}; it says: {}", text, line);
}

/// A command line that names a program.
const std::string kProgramKey = "solver.program=";

/// The text of a TOML value or of a bare word.
std::string unquoted(const std::string& value) {
  const Json read = Json::parse(value, nullptr, false);
  if (read.is_string()) return read;
  const bool quoted = value.size() > 1 && value.front() == '\'' && value.back() == '\'';
  return quoted ? value.substr(1, value.size() - 2) : value;
}

}  // namespace

const solver::SettingKeys& program_keys() {
  using solver::kAny;
  using solver::KeyType;
  using solver::kRequired;
  static const solver::SettingKeys keys{
      {"name", KeyType::text, "", "the file's name", kAny, "Names it in results and figures."},
      {"command", KeyType::texts, "", kRequired, kAny,
       "Words that start it, without a shell, in the folder of this file. {scene} becomes the file that it "
       "reads, {field} the file that it writes, {numbers} a file that it may write, {python} the Python with "
       "NumPy that draws reports."},
      {"version", KeyType::texts, "", "none", kAny,
       "Words that print its version; kept results of another version are not used."},
      {"inputs", KeyType::texts, "", "files that the command names", kAny,
       "Files that its answers depend on, relative to this one."},
      {"time_limit", KeyType::number, "s", "600", kSeconds, "After this it is stopped, and the run failed."},
      {"arrays",
       KeyType::word,
       "",
       "csv",
       {"csv, npy", nullptr},
       "How it takes the gap and a given pressure: text, or NumPy's files."}};
  return keys;
}

SolverProgram read_solver_program(const fs::path& file) {
  solver::SceneReader reader(file, {}, program_keys());
  SolverProgram program{.file = file, .name = {}, .command = {}, .version = {}, .inputs = {}};
  program.name = reader.text_or("name", file.stem().string());
  program.command = reader.texts("command");
  program.version = reader.texts("version");
  for (const std::string& input : reader.texts("inputs")) program.inputs.push_back(file.parent_path() / input);
  program.time_limit = reader.number_or("time_limit", program.time_limit);
  program.numpy = reader.choice_or("arrays", program.numpy, solver::Words<bool>{{"csv", false}, {"npy", true}});
  reader.reject_unknown();
  for (const char* needed : {"{scene}", "{field}"}) {
    const bool there = std::ranges::any_of(
        program.command, [&](const std::string& word) { return word.find(needed) != std::string::npos; });
    if (!there) {
      reader.fail("command", program.command.empty() ? "(missing)" : "no " + std::string(needed),
                  "a list of words, {scene} and {field} among them");
    }
  }
  return program;
}

std::string version_of(const SolverProgram& program, const fs::path& tied_by) {
  if (program.version.empty()) return "";
  const ProgramEnd end = run(program, program.version, kVersionSeconds, tied_by);
  if (!end.trouble.empty()) {
    throw ProgramFailure(
        with_last_line(fmt::format("{}: while printing its version, it {}", program.name, end.trouble), end.output));
  }
  return last_line(end.output.substr(0, end.output.find('\n')));
}

std::vector<fs::path> program_files(const SolverProgram& program) {
  std::vector<fs::path> files{program.file};
  files.insert(files.end(), program.inputs.begin(), program.inputs.end());
  for (const std::string& word : program.command) {
    const fs::path named = program.file.parent_path() / word;
    if (fs::is_regular_file(named)) files.push_back(named);
  }
  return files;
}

ProgramEnd run_solver_program(const SolverProgram& program, const ExchangeFiles& files, const fs::path& tied_by) {
  std::vector<std::string> words = program.command;
  for (std::string& word : words) {
    replace(word, "{scene}", files.scene);
    replace(word, "{field}", files.field);
    replace(word, "{numbers}", files.numbers);
  }
  ProgramEnd end = run(program, words, program.time_limit, tied_by);
  if (end.code == kNotForIt) {
    throw InputError(program.file.string(),
                     with_last_line(fmt::format("{} does not solve this scene", program.name), end.output));
  }
  if (!end.trouble.empty()) {
    throw ProgramFailure(with_last_line(fmt::format("{} {}", program.name, end.trouble), end.output));
  }
  return end;
}

std::string program_override(const std::filesystem::path& file) {
  return kProgramKey + json_text(std::filesystem::absolute(file).string());
}

void require_allowed(const solver::Scene& scene, const AllowedPrograms& allowed) {
  if (scene.solver.program.empty() || allowed.all) return;
  for (const std::string& assignment : allowed.overrides) {
    if (assignment.starts_with(kProgramKey) &&
        scene.solver.program == scene.source.parent_path() / unquoted(assignment.substr(kProgramKey.size())))
      return;
  }
  throw InputError(scene.source.string(), "solver.program", scene.solver.program.string(),
                   "one that the command line names, by --program or by --set solver.program=FILE; others run with "
                   "--allow-programs only, since a program may do whatever you may do");
}

}  // namespace slipstick::convergence
