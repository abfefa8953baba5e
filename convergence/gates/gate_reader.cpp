#include "convergence/gates/gate_reader.hpp"

#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <variant>

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

/// The keys of one gate: in its own table, or in the table of its group.
class GateTable {
 public:
  /// group: empty for a gate outside groups.
  GateTable(SceneReader& reader, std::string own, std::string group)
      : reader_(reader), own_(std::move(own)), group_(std::move(group)) {}

  const std::string& table() const { return own_; }
  std::string own(const std::string& key) const { return own_ + "." + key; }

  /// A key that the gate has, or else its group.
  std::string shared(const std::string& key) const {
    const std::string in_group = group_ + "." + key;
    const bool has_default = !group_.empty() && reader_.has(in_group);
    return has_default && !reader_.has(own(key)) ? in_group : own(key);
  }

  /// The group's assignments, then the gate's, which replace them.
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

/// Refuses a second key that excludes the first.
void refuse_both(SceneReader& reader, const std::string& key, const std::string& first) {
  if (reader.has(key)) reader.fail(key, "given with " + first, "one of the two keys");
}

GateSource read_source(SceneReader& reader, const GateTable& at, const std::filesystem::path& results) {
  std::vector<std::string> given;
  for (const char* const key : {"scene", "study", "result"}) {
    if (reader.has(at.shared(key))) given.emplace_back(key);
  }
  if (given.size() != 1) {
    reader.fail(at.own("scene"), given.empty() ? "(missing)" : "given with " + given.back(),
                "one of scene and study, a file (TOML), and result, a file (JSON)");
  }
  const std::string& key = given.front();
  std::filesystem::path file = reader.path(at.shared(key));
  std::vector<std::string> overrides = at.assignments("set");
  if (key == "scene") return SceneSource{std::move(file), std::move(overrides)};
  if (key == "study") return StudySource{std::move(file), std::move(overrides)};
  if (!overrides.empty()) {
    reader.fail(at.own("set"), "given with result", "no set: the numbers of a result file are final");
  }
  if (!results.empty()) file = results / reader.text(at.shared(key));
  return ResultSource{std::move(file), results, reader.text_or("made_by", "")};
}

RelativeTo read_relative(SceneReader& reader, const GateTable& at) {
  RelativeTo bound{reader.path(at.own("of")), reader.number(at.own("within"))};
  for (const char* const key : {"below", "above", "equals"}) refuse_both(reader, at.own(key), "of");
  return bound;
}

/// The comparison that the gate file expects, and its reason.
std::pair<Comparison, std::string> read_expected(SceneReader& reader, const GateTable& at) {
  constexpr std::pair<const char*, Comparison> kKeys[] = {{"differs", Comparison::differs},
                                                          {"undecided", Comparison::undecided},
                                                          {"not_compared", Comparison::not_compared}};
  std::pair<Comparison, std::string> expected{Comparison::agrees, ""};
  std::string first;
  for (const auto& [key, comparison] : kKeys) {
    std::string why = reader.text_or(at.shared(key), "");
    if (why.empty()) continue;
    if (!first.empty()) reader.fail(at.own(key), "given with " + first, "one of the two keys");
    first = key;
    expected = {comparison, std::move(why)};
  }
  return expected;
}

Published read_published(SceneReader& reader, const GateTable& at) {
  const std::string key = at.own("published");
  const std::string text = reader.text(key);
  const std::optional<PrintedNumber> number = read_printed(text);
  if (!number) {
    reader.fail(key, "\"" + text + "\"", "a number with the digits that are printed, as \"1.0760\" or \"8.155e-3\"");
  }
  Published published;
  published.number = *number;
  published.source = reader.text_or(at.shared("published_in"), "");
  if (published.source.empty()) {
    reader.fail(at.own("published_in"), "(missing)", "author, year, title, table or equation, page");
  }
  published.seen = reader.text_or(at.shared("seen_in"), "the publication itself");
  published.argument_error = reader.number_or(at.own("argument_error"), 0.0);
  published.relative_error = reader.find_number(at.shared("own_error"));
  if (published.relative_error && reader.text_or(at.shared("basis"), "").empty()) {
    reader.fail(at.own("basis"), "(missing)", "the origin of own_error");
  }
  published.times = reader.number_or(at.shared("times"), published.times);
  published.inverse = reader.flag_or(at.shared("inverse"), published.inverse);
  std::tie(published.expected, published.why) = read_expected(reader, at);
  for (const char* const other : {"of", "within", "below", "above", "equals"}) {
    refuse_both(reader, at.own(other), "published");
  }
  refuse_both(reader, at.shared("status"), "published");
  return published;
}

/// One or both ends of an interval.
Bound read_interval(SceneReader& reader, const GateTable& at) {
  const auto shown = [](double number) { return fmt::format("{:g}", number); };
  const std::optional<double> below = reader.find_number(at.own("below"));
  const std::optional<double> above = reader.find_number(at.own("above"));
  if (!below && !above) {
    reader.fail(at.own("below"), "(missing)", "below, above, both, equals, of and within, or published");
  }
  if (!below) return Interval{.low = *above};
  if (above && !(*above < *below)) {
    reader.fail(at.own("above"), shown(*above), "less than below, " + shown(*below));
  }
  if (above) return Interval{*above, *below};
  if (!(*below > 0.0)) {
    reader.fail(at.own("below"), shown(*below), "positive without above, as a bound on the size");
  }
  return Below{*below};
}

Bound read_bound(SceneReader& reader, const GateTable& at) {
  if (reader.has(at.own("published"))) return read_published(reader, at);
  if (reader.has(at.own("of")) || reader.has(at.own("within"))) return read_relative(reader, at);
  const std::string equals = at.own("equals");
  if (!reader.has(equals)) return read_interval(reader, at);
  for (const char* const key : {"below", "above"}) refuse_both(reader, at.own(key), "equals");
  return Equals{reader.is_text(equals) ? Json(reader.text(equals)) : Json(reader.number(equals))};
}

std::string required_text(SceneReader& reader, const std::string& key) {
  const std::string text = reader.text(key);
  if (text.empty()) reader.fail(key, "\"\"", "some text");
  return text;
}

Gate read_gate(SceneReader& reader, const GateTable& at, const std::filesystem::path& file,
               const std::filesystem::path& results) {
  Gate gate;
  gate.file = file;
  gate.line = reader.line(at.table());
  gate.id = required_text(reader, at.own("id"));
  gate.bound = read_bound(reader, at);
  const auto* const published = std::get_if<Published>(&gate.bound);
  gate.status = reader.choice_or(at.shared("status"), gate.status, kStatuses);
  if (published != nullptr && published->expected == Comparison::differs) gate.status = GateStatus::expected_failure;
  if (published == nullptr || published->expected != Comparison::not_compared)
    gate.source = read_source(reader, at, results);
  gate.quantity = required_text(reader, at.own("quantity"));
  gate.platform_spread = reader.number_or(at.shared("platform_spread"), gate.platform_spread);
  gate.reason = reader.text_or(at.shared("reason"), "");
  gate.basis = reader.text_or(at.shared("basis"), "");
  if (gate.status == GateStatus::active && gate.basis.empty() && published == nullptr) {
    reader.fail(at.own("basis"), "(missing)", "the origin of the bound, for an active gate");
  }
  return gate;
}

/// Adds the ids of a file to the ids of earlier files. Throws InputError for an id that is in use.
void claim_ids(const std::vector<Gate>& gates, std::map<std::string, std::string>& places) {
  std::map<std::string, std::string> claimed = places;
  for (const Gate& gate : gates) {
    const std::string place = fmt::format("{}:{}", gate.file.string(), gate.line);
    const auto [taken, is_new] = claimed.emplace(gate.id, place);
    if (!is_new)
      throw InputError(place, "id", gate.id, "an id that no other gate has; this one is at " + taken->second);
  }
  places = std::move(claimed);
}

/// The keys of a gate that its group may have instead.
solver::SettingKeys shared_keys() {
  using namespace solver;
  constexpr const char* kOne = "one of scene, study, result is required";
  return {
      {"status", KeyType::word, "", word_of(kStatuses, Gate{}.status), one_of(kStatuses),
       "active: the run fails if the gate fails; expected_failure: the run fails if the gate passes; "
       "report_only: the gate has no effect."},
      {"scene", KeyType::file, "", kOne, kAny, "Scene file (TOML) to solve."},
      {"study", KeyType::file, "", kOne, kAny, "Study file (TOML) to run."},
      {"result", KeyType::file, "", kOne, kAny, "Result file (JSON) of any program."},
      {"set", KeyType::table, "", "none", kAny, "Keys of the scene that differ from its file."},
      {"published_in", KeyType::text, "", "required with published", kAny,
       "Source of the published number: author, year, title, table or equation, page."},
      {"seen_in", KeyType::text, "", "the publication itself", kAny,
       "The text in which the number was read, if it is another one."},
      {"own_error", KeyType::number, "", "the error that the result states", kNotNegative,
       "Relative error of our number, where the result states none; `basis` gives its origin."},
      {"times", KeyType::number, "", fmt::format("{:g}", Published{}.times), kPositive,
       "The published number is `times` x the quantity."},
      {"inverse", KeyType::flag, "", "false", kAny, "The published number is `times` over the quantity."},
      {"differs", KeyType::text, "", "none", kAny, "Why the published number differs: then the gate must not hold."},
      {"undecided", KeyType::text, "", "none", kAny,
       "Why our own error is larger than the printed digits: then agreement is reported as undecided."},
      {"not_compared", KeyType::text, "", "none", kAny, "Why the number cannot be compared: then nothing is solved."},
      {"platform_spread", KeyType::number, "the quantity's", fmt::format("{:g}", Gate{}.platform_spread), kNotNegative,
       "Largest difference between machines and compilers."},
      {"basis", KeyType::text, "", "required of an active gate", kAny, "Origin of the bound."},
      {"reason", KeyType::text, "", "none", kAny, "Why the number matters."}};
}

/// The keys that each gate has for itself.
solver::SettingKeys own_keys() {
  using namespace solver;
  constexpr const char* kBound = "one of below, above, equals, of, published is required";
  return {{"id", KeyType::text, "", kRequired, kAny, "Name of the gate; it is unique in the run."},
          {"quantity", KeyType::text, "", kRequired, kAny,
           "Path of a number in the result, as --json writes it: steps[3].traction_error.averaged.l2."},
          {"below", KeyType::number, "the quantity's", kBound, kFinite,
           "Without `above`: the size of the number is smaller. With `above`: the signed number is smaller."},
          {"above", KeyType::number, "the quantity's", kBound, kFinite, "The signed number is larger."},
          {"equals", KeyType::number, "the quantity's", kBound, kFinite,
           "The value is this number or, in quotes, this word."},
          {"published", KeyType::text, "", kBound, kAny,
           "Published number as printed, in quotes. The quantity agrees within half a unit of the last digit, "
           "`argument_error` and our own error."},
          {"argument_error", KeyType::number, "the published", "0", kNotNegative,
           "Error of the published number by the printed digits of its argument."},
          {"of", KeyType::file, "", kBound, kAny,
           "Result file (JSON), or scene or study (TOML, solved with the same `set`), whose quantity this one "
           "must equal."},
          {"within", KeyType::number, "", "required with of", kPositive,
           "Allowed difference from the quantity of `of`, over the size of that quantity."}};
}

solver::SettingKeys all_keys() {
  using namespace solver;
  SettingKeys keys{
      {"made_by", KeyType::text, "", "none", kAny,
       "Command that writes the result files of the gates; only for gates with `result`."},
      {"gate", KeyType::tables, "", "none", kAny, "Tables `[[gate]]`, one for each gate."},
      {"group", KeyType::tables, "", "none", kAny,
       "Tables `[[group]]`: keys that several gates share, and these gates as `[[group.gate]]`. A key of the "
       "gate replaces the group's key; the assignments in its `set` are added to the group's."}};
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

GateFiles read_gate_files(const std::vector<std::string>& files, const std::filesystem::path& results_folder) {
  GateFiles result;
  std::map<std::string, std::string> places;
  for (const std::string& file : files) {
    try {
      const std::vector<Gate> gates = read_gates(file, results_folder);
      claim_ids(gates, places);
      result.gates.insert(result.gates.end(), gates.begin(), gates.end());
    } catch (const InputError& error) {
      Gate gate;
      gate.file = gate.id = file;
      result.unreadable.push_back(refuse(gate, error.what()));
    }
  }
  return result;
}

std::vector<Gate> select_gates(const std::vector<Gate>& gates, const std::vector<std::string>& patterns) {
  if (patterns.empty()) return gates;
  std::set<std::string> selected;
  for (const std::string& pattern : patterns) {
    const bool is_id = std::ranges::find(gates, pattern, &Gate::id) != gates.end();
    std::vector<std::string> matching;
    std::vector<std::string> known;
    for (const Gate& gate : gates) {
      known.push_back(gate.id);
      if (is_id ? gate.id == pattern : fnmatch(pattern.c_str(), gate.id.c_str(), 0) == 0) matching.push_back(gate.id);
    }
    if (matching.empty()) {
      throw InputError("--only " + pattern,
                       known.empty() ? "there is no gate"
                                     : "no gate has this id; the nearest is " + solver::nearest_word(pattern, known));
    }
    selected.insert(matching.begin(), matching.end());
  }
  std::vector<Gate> chosen;
  std::ranges::copy_if(gates, std::back_inserter(chosen), [&](const Gate& gate) { return selected.contains(gate.id); });
  return chosen;
}

}  // namespace slipstick::convergence
