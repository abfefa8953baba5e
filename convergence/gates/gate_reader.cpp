#include "convergence/gates/gate_reader.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "solver/input/input_error.hpp"
#include "solver/input/misspelling.hpp"
#include "solver/input/toml_reader.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
using solver::SceneReader;

const solver::Words<GateStatus> kStatuses{{"active", GateStatus::active},
                                          {"expected_failure", GateStatus::expected_failure},
                                          {"report_only", GateStatus::report_only}};

const solver::Words<GateSource> kSources{
    {"scene", GateSource::scene}, {"study", GateSource::study}, {"result", GateSource::result}};

void read_source(SceneReader& reader, const std::string& at, Gate& gate) {
  std::vector<std::string> given;
  for (const auto& [key, kind] : kSources) {
    if (!reader.has(at + key)) continue;
    given.push_back(key);
    gate.kind = kind;
  }
  if (given.size() != 1) {
    reader.fail(at + "scene", given.empty() ? "(missing)" : "beside " + given.back(),
                "one of scene and study, a file (TOML), and result, a file (JSON)");
  }
  gate.source = reader.path(at + given.front());
  gate.overrides = reader.assignments(at + "set");
}

/// A day of the calendar, as 2026-11-24.
bool is_day(const std::string& text) {
  int year = 0, month = 0, day = 0, end = 0;
  std::sscanf(text.c_str(), "%4d-%2d-%2d%n", &year, &month, &day, &end);
  return text.size() == 10 && end == 10 && (std::chrono::year(year) / month / day).ok();
}

/// Any program's, so that only the gate file can say which.
void read_result_source(SceneReader& reader, const std::string& at, const std::filesystem::path& folder,
                        Gate& gate) {
  if (!gate.overrides.empty()) {
    reader.fail(at + "set", "(given)", "left out beside result: a file is taken as it is");
  }
  gate.newer_than = reader.text_or(at + "newer_than", "");
  if (reader.has(at + "newer_than") && !is_day(gate.newer_than)) {
    reader.fail(at + "newer_than", gate.newer_than, "a day as 2026-11-24, in quotes");
  }
  gate.results_folder = folder;
  if (!folder.empty()) gate.source = folder / reader.text(at + "result");
  gate.made_by = reader.text_or("made_by", "");
}

/// How far from the number of another result.
void read_relative(SceneReader& reader, const std::string& at, Gate& gate) {
  gate.of = reader.path(at + "of");
  gate.within = reader.number(at + "within");
  for (const char* const key : {"below", "above", "equals"}) {
    if (reader.has(at + key)) reader.fail(at + key, "beside of", "one or the other");
  }
}

void read_bounds(SceneReader& reader, const std::string& at, Gate& gate) {
  if (reader.has(at + "of") || reader.has(at + "within")) return read_relative(reader, at, gate);
  gate.below = reader.find_number(at + "below");
  gate.above = reader.find_number(at + "above");
  if (reader.has(at + "equals")) {
    if (gate.below || gate.above) reader.fail(at + "equals", "beside below or above", "one or the other");
    gate.equals =
        reader.is_text(at + "equals") ? Json(reader.text(at + "equals")) : Json(reader.number(at + "equals"));
  } else if (!gate.below && !gate.above) {
    reader.fail(at + "below", "(missing)", "below, above, both, equals, or of and within");
  }
  const auto shown = [](double number) { return fmt::format("{:g}", number); };
  if (gate.below && gate.above && !(*gate.above < *gate.below)) {
    reader.fail(at + "above", shown(*gate.above), "less than below, " + shown(*gate.below));
  }
  if (gate.below && !gate.above && !(*gate.below > 0.0)) {
    reader.fail(at + "below", shown(*gate.below), "positive where it stands alone, as a bound on the size");
  }
}

std::string required_text(SceneReader& reader, const std::string& key) {
  const std::string text = reader.text(key);
  if (text.empty()) reader.fail(key, "\"\"", "some text");
  return text;
}

Gate read_gate(SceneReader& reader, const std::filesystem::path& file,
               const std::filesystem::path& results_folder, std::size_t index) {
  const std::string table = fmt::format("gate[{}]", index);
  const std::string at = table + ".";
  Gate gate;
  gate.file = file;
  gate.line = reader.line(table);
  gate.id = required_text(reader, at + "id");
  gate.status = reader.choice_or(at + "status", gate.status, kStatuses);
  read_source(reader, at, gate);
  if (gate.kind == GateSource::result) read_result_source(reader, at, results_folder, gate);
  gate.quantity = required_text(reader, at + "quantity");
  read_bounds(reader, at, gate);
  gate.platform_spread = reader.number_or(at + "platform_spread", gate.platform_spread);
  gate.reason = reader.text_or(at + "reason", "");
  gate.basis = reader.text_or(at + "basis", "");
  if (gate.status == GateStatus::active && gate.basis.empty()) {
    reader.fail(at + "basis", "(missing)", "where the bound of an active gate comes from");
  }
  return gate;
}

/// Throws InputError where an id is taken; remembers those that are not.
void claim_ids(const std::vector<Gate>& gates, std::map<std::string, std::string>& places) {
  std::map<std::string, std::string> claimed = places;
  for (const Gate& gate : gates) {
    const std::string place = fmt::format("{}:{}", gate.file.string(), gate.line);
    const auto [taken, is_new] = claimed.emplace(gate.id, place);
    if (!is_new)
      throw InputError(place, "id", gate.id, "an id of its own; this one stands at " + taken->second);
  }
  places = std::move(claimed);
}

}  // namespace

const solver::SettingKeys& gate_keys() {
  using solver::KeyType;
  constexpr const char* kOne = "one of scene, study, result is required";
  constexpr const char* kBound = "one of below, above, equals, of is required";
  static const solver::SettingKeys keys{
      {"made_by",
       KeyType::text,
       "",
       "none",
       {},
       "Command that makes the results which gates of the file name; known beside such gates alone."},
      {"gate", KeyType::tables, "", solver::kRequired, {}, "Tables `[[gate]]`, one for each gate."},
      {"gate.id",
       KeyType::text,
       "",
       solver::kRequired,
       {},
       "Names the gate; no other gate of the run has it."},
      {"gate.status", KeyType::word, "", solver::word_of(kStatuses, Gate{}.status), solver::one_of(kStatuses),
       "Whether failing fails the run, passing does, or neither."},
      {"gate.scene", KeyType::file, "", kOne, {}, "Scene file (TOML) that is solved, relative to this file."},
      {"gate.study", KeyType::file, "", kOne, {}, "Study file (TOML) that is run."},
      {"gate.result", KeyType::file, "", kOne, {}, "Result file (JSON) of any program, taken as it is."},
      {"gate.set", KeyType::table, "", "none", {}, "Keys of the scene that differ from its file."},
      {"gate.quantity",
       KeyType::text,
       "",
       solver::kRequired,
       {},
       "Path of a number in the result, as --json writes it: steps[3].traction_error.averaged.l2."},
      {"gate.below", KeyType::number, "the quantity's", kBound, solver::kFinite,
       "Bound that the number stays below; alone, of its size; with above, of the signed value."},
      {"gate.above", KeyType::number, "the quantity's", kBound, solver::kFinite,
       "Bound that it stays above."},
      {"gate.equals", KeyType::number, "the quantity's", kBound, solver::kFinite,
       "The number, or in quotes the word, that it is to be; in place of the bounds."},
      {"gate.of",
       KeyType::file,
       "",
       kBound,
       {},
       "Result file (JSON), or scene or study (TOML, with the same `set`), whose number this one is to be."},
      {"gate.within", KeyType::number, "", "required beside of", solver::kPositive,
       "How far from that number, over its size."},
      {"gate.newer_than",
       KeyType::text,
       "",
       "none",
       {},
       "Day, as 2026-11-24 (UTC), that the last change of a result file must not be before."},
      {"gate.platform_spread", KeyType::number, "the quantity's", fmt::format("{:g}", Gate{}.platform_spread),
       solver::kNotNegative, "By how much machines and compilers differ."},
      {"gate.basis", KeyType::text, "", "required of an active gate", {}, "Where the bound comes from."},
      {"gate.reason", KeyType::text, "", "none", {}, "What the gate is for."}};
  return keys;
}

std::vector<Gate> read_gates(const std::filesystem::path& file, const std::filesystem::path& results_folder) {
  SceneReader reader(file, {}, gate_keys());
  std::vector<Gate> gates;
  const std::size_t count = reader.count("gate");
  for (std::size_t i = 0; i < count; ++i) gates.push_back(read_gate(reader, file, results_folder, i));
  reader.reject_unknown();
  return gates;
}

GateFiles read_gate_files(const std::vector<std::string>& files,
                          const std::filesystem::path& results_folder) {
  GateFiles result;
  std::map<std::string, std::string> places;
  for (const std::string& file : files) {
    try {
      const std::vector<Gate> gates = read_gates(file, results_folder);
      claim_ids(gates, places);
      result.gates.insert(result.gates.end(), gates.begin(), gates.end());
    } catch (const InputError& error) {
      Gate gate;
      gate.file = file;
      gate.id = file;
      result.unreadable.push_back(refuse(gate, error.what()));
    }
  }
  return result;
}

std::vector<Gate> select_gates(const std::vector<Gate>& gates, const std::vector<std::string>& ids) {
  if (ids.empty()) return gates;
  std::vector<std::string> known;
  for (const Gate& gate : gates) known.push_back(gate.id);
  for (const std::string& id : ids) {
    if (std::find(known.begin(), known.end(), id) == known.end()) {
      throw InputError("--only " + id, known.empty() ? "there is no gate"
                                                     : "no gate has this id; the nearest is " +
                                                           solver::nearest_word(id, known));
    }
  }
  std::vector<Gate> selected;
  std::copy_if(gates.begin(), gates.end(), std::back_inserter(selected),
               [&](const Gate& gate) { return std::find(ids.begin(), ids.end(), gate.id) != ids.end(); });
  return selected;
}

}  // namespace slipstick::convergence
