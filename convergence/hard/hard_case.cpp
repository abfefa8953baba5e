#include "convergence/hard/hard_case.hpp"

#include <fmt/core.h>

#include <utility>

#include "solver/input/toml_reader.hpp"

namespace slipstick::convergence {
namespace {

using solver::SceneReader;

/// More in one file is a wrong list.
constexpr std::size_t kMaxCases = 100'000;

std::string unquoted(const std::string& value) {
  const bool quoted = value.size() > 1 && (value.front() == '"' || value.front() == '\'');
  return quoted ? value.substr(1, value.size() - 2) : value;
}

/// Each of some cases with each value of a key.
std::vector<HardCase> varied(const std::vector<HardCase>& cases, const std::string& key,
                             const std::vector<std::string>& values) {
  std::vector<HardCase> all;
  for (const HardCase& made : cases) {
    for (const std::string& value : values) {
      HardCase& one = all.emplace_back(made);
      if (!one.name.empty()) one.name += "-";
      one.name += unquoted(value);
      one.run.overrides.push_back(fmt::format("{}={}", key, value));
    }
  }
  return all;
}

std::vector<HardCase> read_family(SceneReader& reader, const std::string& at) {
  HardCase base;
  base.family = reader.text(at + "name");
  base.why = reader.text(at + "why");
  base.run.scene = reader.path(at + "scene").lexically_normal();
  base.run.overrides = reader.assignments(at + "set");
  std::vector<HardCase> cases{base};
  const std::size_t keys = reader.count(at + "vary");
  for (std::size_t i = 0; i < keys; ++i) {
    const std::string vary = fmt::format("{}vary[{}].", at, i);
    const std::string key = reader.text(vary + "key");
    const std::vector<std::string> values = reader.list(vary + "values");
    if (values.empty()) reader.fail(vary + "values", "(missing)", "a list of values");
    if (cases.size() * values.size() > kMaxCases) {
      reader.fail(vary + "values", fmt::format("{} cases", cases.size() * values.size()),
                  fmt::format("at most {}", kMaxCases));
    }
    cases = varied(cases, key, values);
  }
  return cases;
}

}  // namespace

const solver::SettingKeys& hard_keys() {
  using namespace solver;
  static const SettingKeys keys{
      {"family", KeyType::tables, "", kRequired, kAny, "Tables `[[family]]`: a scene with keys that vary."},
      {"family.name", KeyType::text, "", kRequired, kAny, "Names the family."},
      {"family.why", KeyType::text, "", kRequired, kAny, "The reason why it is hard."},
      {"family.scene", KeyType::file, "", kRequired, kAny, "Scene file (TOML), relative to this file."},
      {"family.set", KeyType::table, "", "none", kAny, "Keys of the scene that differ from its file."},
      {"family.vary", KeyType::tables, "", "none", kAny,
       "Tables `[[family.vary]]`: every combination of their values is a case."},
      {"family.vary.key", KeyType::text, "", kRequired, kAny, "The key of the scene that varies."},
      {"family.vary.values", KeyType::values, "", kRequired, kAny, "The values that it takes."}};
  return keys;
}

std::vector<HardCase> read_hard_cases(const std::filesystem::path& file) {
  SceneReader reader(file, {}, hard_keys());
  std::vector<HardCase> cases;
  const std::size_t families = reader.count("family");
  if (families == 0) reader.fail("family", "(missing)", "[[family]] tables");
  for (std::size_t i = 0; i < families; ++i) {
    for (HardCase& made : read_family(reader, fmt::format("family[{}].", i))) {
      cases.push_back(std::move(made));
    }
  }
  reader.reject_unknown();
  return cases;
}

}  // namespace slipstick::convergence
