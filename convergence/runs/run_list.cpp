#include "convergence/runs/run_list.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "convergence/results/json_text.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::convergence {
namespace {

constexpr const char* kAllowedRun = "a run, as --list-runs writes it";
constexpr std::array kRunKeys{"name",         "scene",  "set",         "rounding",        "variant", "profile",
                              "stress_error", "fields", "step_before", "program_version", "output"};
const std::map<std::string, Rounding> kRoundingWords{
    {"nearest", Rounding::nearest}, {"upward", Rounding::upward}, {"downward", Rounding::downward}};

/// Reads the keys of a run.
class RunReader {
 public:
  RunReader(const Json& json, const std::string& source) : json_(json), source_(source) {
    if (!json.is_object()) throw solver::InputError(source, fmt::format("is no run; allowed: {}", kAllowedRun));
    for (const auto& [key, value] : json.items()) {
      if (std::ranges::find(kRunKeys, key) == kRunKeys.end()) fail(key, fmt::format("{}", fmt::join(kRunKeys, ", ")));
    }
  }

  [[noreturn]] void fail(const std::string& key, const std::string& allowed) const {
    throw solver::InputError(source_, key, json_.contains(key) ? json_text(json_[key]) : "(missing)", allowed);
  }

  template <typename T>
  T get(const std::string& key, const std::string& allowed, T otherwise) const {
    if (!json_.contains(key)) return otherwise;
    try {
      return json_[key].template get<T>();
    } catch (const Json::exception&) {
      fail(key, allowed);
    }
  }

  std::string text(const std::string& key) const { return get<std::string>(key, "a text", ""); }
  bool flag(const std::string& key) const { return get<bool>(key, "true or false", false); }

 private:
  const Json& json_;
  const std::string& source_;
};

}  // namespace

Json to_json(const RunSpec& spec) {
  Json json{{"scene", spec.scene.string()}, {"set", spec.overrides}};
  for (const auto& [word, rounding] : kRoundingWords) {
    if (rounding == spec.rounding && rounding != Rounding::nearest) json["rounding"] = word;
  }
  if (spec.variant != Variant::none) json["variant"] = to_string(spec.variant);
  if (spec.profile) json["profile"] = true;
  if (spec.stress_error) json["stress_error"] = true;
  if (!spec.fields.empty()) json["fields"] = spec.fields.string();
  if (spec.step_before) json["step_before"] = true;
  if (!spec.program_version.empty()) json["program_version"] = spec.program_version;
  return json;
}

RunSpec run_of(const Json& json, const std::string& source) {
  const RunReader reader(json, source);
  RunSpec run{.scene = reader.text("scene"),
              .overrides = reader.get<std::vector<std::string>>("set", "a list of texts, KEY=VALUE", {}),
              .fields = reader.text("fields"),
              .step_before = reader.flag("step_before"),
              .profile = reader.flag("profile"),
              .stress_error = reader.flag("stress_error"),
              .program_version = reader.text("program_version")};
  if (run.scene.empty()) reader.fail("scene", "a scene file (TOML)");
  if (const std::string word = reader.text("rounding"); !word.empty()) {
    if (!kRoundingWords.contains(word)) reader.fail("rounding", "nearest, upward, downward");
    run.rounding = kRoundingWords.at(word);
  }
  if (const std::string word = reader.text("variant"); !word.empty()) {
    try {
      run.variant = variant_of(word);
    } catch (const std::invalid_argument&) {
      reader.fail("variant", "none, or an equivalent scene that slipstick hard names");
    }
  }
  return run;
}

std::string run_list_text(const std::vector<PreparedRun>& runs, const std::filesystem::path& folder) {
  std::string text;
  std::set<std::string> listed;
  for (const PreparedRun& run : runs) {
    if (!listed.insert(run.name).second) continue;
    Json line{{"name", run.name}};
    line.update(to_json(run.spec));
    line["output"] = folder.string();
    text += json_text(line) + "\n";
  }
  return text;
}

std::vector<ListedRun> read_run_list(const std::filesystem::path& file, std::size_t only) {
  std::istringstream lines(solver::read_input_file(file, solver::kLargestJson, "a list of runs"));
  std::vector<ListedRun> runs;
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty() || (only != 0 && number != only)) continue;
    const std::string source = fmt::format("{}:{}", file.string(), number);
    const Json json = parse_json(line, source, kAllowedRun);
    const RunSpec spec = run_of(json, source);
    const RunReader reader(json, source);
    const std::filesystem::path folder = reader.text("output");
    if (folder.empty()) reader.fail("output", "the folder that keeps the result");
    runs.push_back({number, prepare_run(spec), folder});
    const std::string& name = runs.back().run.name;
    if (json.contains("name") && json["name"] != name) {
      reader.fail("name", fmt::format("{}: its scene has changed; write the list again", name));
    }
  }
  if (only > number) {
    throw solver::InputError(fmt::format("--only {}", only),
                             fmt::format("{} has {} lines; allowed: the number of a line", file.string(), number));
  }
  return runs;
}

}  // namespace slipstick::convergence
