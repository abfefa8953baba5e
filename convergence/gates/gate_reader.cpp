#include "convergence/gates/gate.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

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

/// Where the keys of one gate stand: in its own table, or in that of its group, which it adds to or replaces.
class GateTable {
 public:
  /// group: empty where the gate stands in none.
  GateTable(SceneReader& reader, std::string own, std::string group)
      : reader_(reader), own_(std::move(own)), group_(std::move(group)) {}

  const std::string& table() const { return own_; }
  std::string own(const std::string& key) const { return own_ + "." + key; }

  /// A key that a group may have for its gates.
  std::string shared(const std::string& key) const {
    const std::string in_group = group_ + "." + key;
    const bool has_default = !group_.empty() && reader_.has(in_group);
    return has_default && !reader_.has(own(key)) ? in_group : own(key);
  }

  /// Those of the group first: what comes later counts.
  std::vector<std::string> assignments(const std::string& key) const {
    std::vector<std::string> all;
    if (!group_.empty()) all = reader_.assignments(group_ + "." + key);
    const std::vector<std::string> added = reader_.assignments(own(key));
    all.insert(all.end(), added.begin(), added.end());
    return all;
  }

 private:
  SceneReader& reader_;
  std::string own_;
  std::string group_;
};

void read_source(SceneReader& reader, const GateTable& at, Gate& gate) {
  std::vector<std::string> given;
  for (const auto& [key, kind] : kSources) {
    if (!reader.has(at.shared(key))) continue;
    given.push_back(key);
    gate.kind = kind;
  }
  if (given.size() != 1) {
    reader.fail(at.own("scene"), given.empty() ? "(missing)" : "beside " + given.back(),
                "one of scene and study, a file (TOML), and result, a file (JSON)");
  }
  gate.source = reader.path(at.shared(given.front()));
  gate.overrides = at.assignments("set");
}

/// Any program may have written the file: only the gate file can say which.
void read_result_source(SceneReader& reader, const GateTable& at, const std::filesystem::path& folder,
                        Gate& gate) {
  if (!gate.overrides.empty()) {
    reader.fail(at.own("set"), "(given)", "left out beside result: a file is taken as it is");
  }
  gate.results_folder = folder;
  if (!folder.empty()) gate.source = folder / reader.text(at.shared("result"));
  gate.made_by = reader.text_or("made_by", "");
}

/// How far from the number of another result.
void read_relative(SceneReader& reader, const GateTable& at, Gate& gate) {
  gate.of = reader.path(at.own("of"));
  gate.within = reader.number(at.own("within"));
  for (const char* const key : {"below", "above", "equals"}) {
    if (reader.has(at.own(key))) reader.fail(at.own(key), "beside of", "one or the other");
  }
}

void refuse_beside_published(SceneReader& reader, const std::string& key) {
  if (reader.has(key)) reader.fail(key, "beside published", "one or the other");
}

/// A number of the literature, whose digits are the bound.
Published read_published(SceneReader& reader, const GateTable& at) {
  const std::string key = at.own("published");
  const std::string text = reader.text(key);
  const std::optional<Published> number = read_printed(text);
  if (!number)
    reader.fail(key, "\"" + text + "\"",
                "a number with the digits that are printed, as \"1.0760\" or \"8.155e-3\"");
  Published published = *number;
  published.source = reader.text_or(at.shared("published_in"), "");
  if (published.source.empty()) {
    reader.fail(at.own("published_in"), "(missing)", "author, year, title, table or equation, page");
  }
  published.seen = reader.text_or(at.shared("seen_in"), "the publication itself");
  published.argument_error = reader.number_or(at.own("argument_error"), 0.0);
  published.relative_error = reader.find_number(at.shared("own_error"));
  if (published.relative_error && reader.text_or(at.shared("basis"), "").empty()) {
    reader.fail(at.own("basis"), "(missing)", "where own_error comes from");
  }
  published.times = reader.number_or(at.shared("times"), 1.0);
  published.inverse = reader.flag_or(at.shared("inverse"), false);
  published.differs = reader.text_or(at.shared("differs"), "");
  published.undecided = reader.text_or(at.shared("undecided"), "");
  published.not_compared = reader.text_or(at.shared("not_compared"), "");
  if (!published.differs.empty() && !published.not_compared.empty()) {
    reader.fail(at.own("not_compared"), "beside differs", "one or the other");
  }
  if (!published.undecided.empty() && !(published.differs + published.not_compared).empty()) {
    reader.fail(at.own("undecided"), "beside differs or not_compared", "one of them");
  }
  for (const char* const other : {"of", "within", "below", "above", "equals"}) {
    refuse_beside_published(reader, at.own(other));
  }
  refuse_beside_published(reader, at.shared("status"));
  return published;
}

void read_bounds(SceneReader& reader, const GateTable& at, Gate& gate) {
  if (gate.published) return;
  if (reader.has(at.own("of")) || reader.has(at.own("within"))) return read_relative(reader, at, gate);
  const std::string below = at.own("below");
  const std::string above = at.own("above");
  const std::string equals = at.own("equals");
  gate.below = reader.find_number(below);
  gate.above = reader.find_number(above);
  if (reader.has(equals)) {
    if (gate.below || gate.above) reader.fail(equals, "beside below or above", "one or the other");
    gate.equals = reader.is_text(equals) ? Json(reader.text(equals)) : Json(reader.number(equals));
  } else if (!gate.below && !gate.above) {
    reader.fail(below, "(missing)", "below, above, both, equals, of and within, or published");
  }
  const auto shown = [](double number) { return fmt::format("{:g}", number); };
  if (gate.below && gate.above && !(*gate.above < *gate.below)) {
    reader.fail(above, shown(*gate.above), "less than below, " + shown(*gate.below));
  }
  if (gate.below && !gate.above && !(*gate.below > 0.0)) {
    reader.fail(below, shown(*gate.below), "positive where it stands alone, as a bound on the size");
  }
}

std::string required_text(SceneReader& reader, const std::string& key) {
  const std::string text = reader.text(key);
  if (text.empty()) reader.fail(key, "\"\"", "some text");
  return text;
}

Gate read_gate(SceneReader& reader, const GateTable& at, const std::filesystem::path& file,
               const std::filesystem::path& results_folder) {
  Gate gate;
  gate.file = file;
  gate.line = reader.line(at.table());
  gate.id = required_text(reader, at.own("id"));
  if (reader.has(at.own("published"))) gate.published = read_published(reader, at);
  gate.status = reader.choice_or(at.shared("status"), gate.status, kStatuses);
  if (gate.published && !gate.published->differs.empty()) gate.status = GateStatus::expected_failure;
  if (gate.published && !gate.published->not_compared.empty()) {
    gate.kind = GateSource::none;
  } else {
    read_source(reader, at, gate);
  }
  if (gate.kind == GateSource::result) read_result_source(reader, at, results_folder, gate);
  gate.quantity = required_text(reader, at.own("quantity"));
  read_bounds(reader, at, gate);
  gate.platform_spread = reader.number_or(at.shared("platform_spread"), gate.platform_spread);
  gate.reason = reader.text_or(at.shared("reason"), "");
  gate.basis = reader.text_or(at.shared("basis"), "");
  if (gate.status == GateStatus::active && gate.basis.empty() && !gate.published) {
    reader.fail(at.own("basis"), "(missing)", "where the bound of an active gate comes from");
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

/// What a group may say for all its gates.
solver::SettingKeys shared_keys() {
  using namespace solver;
  constexpr const char* kOne = "one of scene, study, result is required";
  return {
      {"status", KeyType::word, "", word_of(kStatuses, Gate{}.status), one_of(kStatuses),
       "Whether failing fails the run, passing does, or neither."},
      {"scene", KeyType::file, "", kOne, kAny, "Scene file (TOML) that is solved, relative to this file."},
      {"study", KeyType::file, "", kOne, kAny, "Study file (TOML) that is run."},
      {"result", KeyType::file, "", kOne, kAny, "Result file (JSON) of any program, taken as it is."},
      {"set", KeyType::table, "", "none", kAny, "Keys of the scene that differ from its file."},
      {"published_in", KeyType::text, "", "required beside published", kAny,
       "Who published the number: author, year, title, table or equation, page."},
      {"seen_in", KeyType::text, "", "the publication itself", kAny,
       "The text in which it was looked up, where that is another one."},
      {"own_error", KeyType::number, "", "what the result states", kNotNegative,
       "How far our number may be off, relative, where the result states no error of it; `basis` says why."},
      {"times", KeyType::number, "", fmt::format("{:g}", Published{}.times), kPositive,
       "The published number is this many times the quantity."},
      {"inverse", KeyType::flag, "", "false", kAny, "The published number is `times` over the quantity."},
      {"differs", KeyType::text, "", "none", kAny,
       "Why the published number is another: then the gate must not hold."},
      {"undecided", KeyType::text, "", "none", kAny,
       "Why our own error is larger than the printed digits: then the number is not compared at its digits."},
      {"not_compared", KeyType::text, "", "none", kAny, "Why it cannot be compared: then nothing is solved."},
      {"platform_spread", KeyType::number, "the quantity's", fmt::format("{:g}", Gate{}.platform_spread),
       kNotNegative, "By how much machines and compilers differ."},
      {"basis", KeyType::text, "", "required of an active gate", kAny, "Where the bound comes from."},
      {"reason", KeyType::text, "", "none", kAny, "What the gate is for."}};
}

/// What each gate says for itself.
solver::SettingKeys own_keys() {
  using namespace solver;
  constexpr const char* kBound = "one of below, above, equals, of, published is required";
  return {{"id", KeyType::text, "", kRequired, kAny, "Names the gate; no other gate of the run has it."},
          {"quantity", KeyType::text, "", kRequired, kAny,
           "Path of a number in the result, as --json writes it: steps[3].traction_error.averaged.l2."},
          {"below", KeyType::number, "the quantity's", kBound, kFinite,
           "Bound that the number stays below; alone, of its size; with above, of the signed value."},
          {"above", KeyType::number, "the quantity's", kBound, kFinite, "Bound that it stays above."},
          {"equals", KeyType::number, "the quantity's", kBound, kFinite,
           "The number, or in quotes the word, that it is to be; in place of the bounds."},
          {"published", KeyType::text, "", kBound, kAny,
           "Number of the literature as printed, in quotes: the quantity agrees within half a unit of the "
           "last digit and what the result states as its own error."},
          {"argument_error", KeyType::number, "the published", "0", kNotNegative,
           "What the printed digits of its argument leave open."},
          {"of", KeyType::file, "", kBound, kAny,
           "Result file (JSON), or scene or study (TOML, with the same `set`), whose number this one is to "
           "be."},
          {"within", KeyType::number, "", "required beside of", kPositive,
           "How far from that number, over its size."}};
}

solver::SettingKeys all_keys() {
  using namespace solver;
  SettingKeys keys{
      {"made_by", KeyType::text, "", "none", kAny,
       "Command that makes the results which gates of the file name; known beside such gates alone."},
      {"gate", KeyType::tables, "", "none", kAny, "Tables `[[gate]]`, one for each gate."},
      {"group", KeyType::tables, "", "none", kAny,
       "Tables `[[group]]`: what several gates share, and these gates as `[[group.gate]]`. A key of the gate "
       "replaces that of its group; what it says in `set` is added to it."}};
  const auto add = [&](const std::string& table, const SettingKeys& rows) {
    for (SettingKey key : rows) {
      key.name = table + key.name;
      keys.push_back(std::move(key));
    }
  };
  add("gate.", own_keys());
  add("gate.", shared_keys());
  add("group.", shared_keys());
  keys.push_back({"group.gate", KeyType::tables, "", "none", kAny, "Tables, one for each gate."});
  add("group.gate.", own_keys());
  add("group.gate.", shared_keys());
  return keys;
}

}  // namespace

const solver::SettingKeys& gate_keys() {
  static const solver::SettingKeys keys = all_keys();
  return keys;
}

std::vector<Gate> read_gates(const std::filesystem::path& file, const std::filesystem::path& results_folder) {
  SceneReader reader(file, {}, gate_keys());
  std::vector<Gate> gates;
  const auto read = [&](const std::string& table, const std::string& group) {
    gates.push_back(read_gate(reader, {reader, table, group}, file, results_folder));
  };
  for (std::size_t i = 0; i < reader.count("gate"); ++i) read(fmt::format("gate[{}]", i), "");
  for (std::size_t i = 0; i < reader.count("group"); ++i) {
    const std::string group = fmt::format("group[{}]", i);
    const std::size_t count = reader.count(group + ".gate");
    for (std::size_t k = 0; k < count; ++k) read(fmt::format("{}.gate[{}]", group, k), group);
  }
  reader.reject_unknown();
  std::ranges::stable_sort(gates, {}, &Gate::line);
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
