// The readers of studies, gates and hard cases read every key of their tables.

#include <gmock/gmock.h>

#include <fstream>

#include "convergence/gates/gate_reader.hpp"
#include "convergence/hard/hard_case.hpp"
#include "convergence/studies/study.hpp"

namespace slipstick::convergence {
namespace {

using testing::HasSubstr;

/// A file with every key.
constexpr const char* kWholeStudy = R"(
name = "all"
scene = "scene.toml"
set = { "load.moment_ratio" = 0.5 }
cells = [16, 32]
shifts = 2
tolerances = [1e-2, 1e-4]
quantities = ["twist"]
[[vary]]
key = "contact.friction"
values = [0.1, 0.2]
)";
constexpr const char* kWholeGates = R"(
made_by = "make it"
[[gate]]
id = "a"
status = "report_only"
scene = "scene.toml"
set = { "load.moment_ratio" = 0.5 }
quantity = "twist"
above = 0
below = 1
platform_spread = 1e-9
basis = "theory"
reason = "all keys"
[[group]]
study = "study.toml"
[[group.gate]]
id = "b"
quantity = "verdict"
equals = "asymptotic"
basis = "theory"
[[gate]]
id = "c"
result = "result.json"
quantity = "number"
of = "other.json"
within = 1e-3
basis = "theory"
[[gate]]
id = "d"
scene = "scene.toml"
quantity = "number"
published = "1.10"
published_in = "Somebody"
seen_in = "somewhere"
argument_error = 1e-3
own_error = 1e-3
times = 2
inverse = true
differs = "a misprint"
basis = "theory"
[[gate]]
id = "e"
quantity = "number"
published = "1"
published_in = "Somebody"
not_compared = "no such scene"
[[gate]]
id = "f"
scene = "scene.toml"
quantity = "number"
published = "1"
published_in = "Somebody"
undecided = "a coarse study"
)";
constexpr const char* kWholeCases = R"([[family]]
name = "all"
why = "every key"
scene = "scene.toml"
set = { "load.moment_ratio" = 0.5 }
[[family.vary]]
key = "contact.friction"
values = [0.1, 0.2]
)";

/// Writes the text, reads it, and looks for each key of the table in it.
template <class Read>
void expect_all_read(const std::string& text, const solver::SettingKeys& keys, const Read& read) {
  const std::filesystem::path file = testing::TempDir() + "setting_keys.toml";
  std::ofstream(file) << text;
  EXPECT_NO_THROW(read(file));  // unknown keys are refused
  for (const solver::SettingKey& key : keys) {
    const bool tables = key.type == solver::KeyType::tables;
    const std::string last = key.name.substr(key.name.rfind('.') + 1);
    EXPECT_THAT(text, HasSubstr(tables ? "[[" + key.name + "]]" : "\n" + last + " = ")) << key.name;
  }
}

TEST(SettingKeys, OfAStudyAreRead) {
  expect_all_read(kWholeStudy, study_keys(), [](const auto& file) { read_study(file); });
}

TEST(SettingKeys, OfAGateAreRead) {
  expect_all_read(kWholeGates, gate_keys(), [](const auto& file) { read_gates(file); });
}

TEST(SettingKeys, OfHardCasesAreRead) {
  expect_all_read(kWholeCases, hard_keys(), [](const auto& file) { read_hard_cases(file); });
}

}  // namespace
}  // namespace slipstick::convergence
