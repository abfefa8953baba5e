// Gate files: sources, bounds, groups, and the complaints about bad files.

#include "convergence/gates/gate_reader.hpp"

#include <gmock/gmock.h>

#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/tests/complaint.hpp"

namespace slipstick::convergence {
namespace {

using namespace testing;

class GateFile : public ScratchFolder {
 protected:
  std::string complaint(const std::string& text) const {
    return solver::complaint([&] { read_gates(write("bad.toml", text)); });
  }
};

constexpr const char* kGate = R"(# gates of a test
[[gate]]
id = "first"
scene = "scenes/paper.toml"
set = { "load.moment_ratio" = 0.9, "grid.cells" = [256, 256], "contact.pressure" = "hertz" }
quantity = "twist_error"
below = 2e-5
basis = "measured"
)";

constexpr const char* kResultGate = R"([[gate]]
id = "counted"
result = "work.json"
quantity = "counts.some-case.applications"
above = 17
below = 21
basis = "counted 19"
)";

TEST_F(GateFile, IsReadInFull) {
  const std::vector<Gate> gates = read_gates(write("some.toml", std::string(kGate) + R"(
[[gate]]
id = "second"
study = "order.toml"
quantity = "series.hertz.order.twist_error.verdict"
equals = "asymptotic"
status = "report_only"
reason = "to know"
platform_spread = 0.1
[[gate]]
id = "third"
scene = "/elsewhere/cone.toml"
quantity = "iterations"
above = 1
below = 7
basis = "counted"
status = "expected_failure"
)"));
  ASSERT_EQ(gates.size(), 3);
  EXPECT_EQ(gates[0].id, "first");
  EXPECT_EQ(gates[0].line, 2);
  const auto& scene = std::get<SceneSource>(gates[0].source);
  EXPECT_EQ(scene.file, folder_ / "scenes/paper.toml");
  EXPECT_THAT(scene.overrides, testing::UnorderedElementsAre("load.moment_ratio=0.9", "grid.cells=[256, 256]",
                                                             "contact.pressure='hertz'"));
  EXPECT_EQ(std::get<Below>(gates[0].bound).size, 2e-5);
  EXPECT_EQ(gates[0].status, GateStatus::active);
  EXPECT_EQ(gates[1].line, 10);
  EXPECT_EQ(std::get<StudySource>(gates[1].source).file, folder_ / "order.toml");
  EXPECT_EQ(std::get<Equals>(gates[1].bound).value, "asymptotic");
  EXPECT_EQ(gates[1].status, GateStatus::report_only);
  EXPECT_EQ(gates[1].reason, "to know");
  EXPECT_EQ(gates[1].platform_spread, 0.1);
  EXPECT_EQ(file_of(gates[2].source), "/elsewhere/cone.toml");
  EXPECT_EQ(std::get<Between>(gates[2].bound).low, 1.0);
  EXPECT_EQ(std::get<Between>(gates[2].bound).high, 7.0);
}

/// A gate's own keys count before its group's, `set` is both together, and gates come in the order of lines.
TEST_F(GateFile, GatesOfAGroupShareItsKeys) {
  const std::string group = R"([[group]]
scene = "scenes/paper.toml"
set = { "grid.cells" = [64, 64], "load.moment_ratio" = 0.5 }
basis = "measured"
platform_spread = 1e-9
[[group.gate]]
id = "of-group"
quantity = "twist_error"
below = 2e-5
[[group.gate]]
id = "own"
set = { "load.moment_ratio" = 0.9 }
quantity = "status"
equals = "converged"
basis = "asked for"
)";
  const std::vector<Gate> gates = read_gates(write("some.toml", group + kGate));
  ASSERT_EQ(gates.size(), 3);
  EXPECT_EQ(gates[0].id, "of-group");
  EXPECT_EQ(gates[0].line, 6);
  EXPECT_EQ(file_of(gates[0].source), folder_ / "scenes/paper.toml");
  EXPECT_THAT(std::get<SceneSource>(gates[0].source).overrides,
              testing::ElementsAre("grid.cells=[64, 64]", "load.moment_ratio=0.5"));
  EXPECT_EQ(gates[0].basis, "measured");
  EXPECT_EQ(gates[0].platform_spread, 1e-9);
  EXPECT_THAT(std::get<SceneSource>(gates[1].source).overrides,
              testing::ElementsAre("grid.cells=[64, 64]", "load.moment_ratio=0.5", "load.moment_ratio=0.9"));
  EXPECT_EQ(gates[1].basis, "asked for");
  EXPECT_EQ(gates[2].id, "first") << "which stands in no group";
  EXPECT_EQ(gates[2].platform_spread, 0.0);
  EXPECT_THAT(complaint(group + "study = 'a.toml'\n"), HasSubstr("gate[1].scene"));
  EXPECT_THAT(complaint("[[group]]\nscene = 'a.toml'\nbelow = 1.0\n" + group), HasSubstr("below"));
}

TEST_F(GateFile, NeedsNoBasisToReportOnly) {
  const std::string good = kGate;
  EXPECT_EQ(complaint(good.substr(0, good.find("basis")) + "status = 'report_only'\n"), "");
}

TEST_F(GateFile, FindsResultsInItsFolderOrInTheGivenOne) {
  const std::string file = write("gates.toml", std::string("made_by = 'make gate'\n") + kResultGate);
  const Gate gate = read_gates(file).at(0);
  const auto& result = std::get<ResultSource>(gate.source);
  EXPECT_EQ(result.file, folder_ / "work.json");
  EXPECT_EQ(result.made_by, "make gate");
  EXPECT_THAT(rerun_command(gate), Not(HasSubstr("--results")));
  const Gate elsewhere = read_gates(file, "some where").at(0);
  EXPECT_EQ(file_of(elsewhere.source), "some where/work.json");
  EXPECT_THAT(rerun_command(elsewhere), HasSubstr("--results 'some where' --only counted"));
}

TEST_F(GateFile, ResultExcludesSceneStudyAndSet) {
  const std::string good = kResultGate;
  EXPECT_EQ(complaint(good), "");
  EXPECT_THAT(complaint(good + "scene = 'a.toml'\n"), HasSubstr("gate[0].scene"));
  EXPECT_THAT(complaint(good + "study = 'a.toml'\n"), HasSubstr("gate[0].scene"));
  EXPECT_THAT(complaint(good + "set = { 'grid.cells' = [8, 8] }\n"),
              AllOf(HasSubstr("gate[0].set"), HasSubstr("result")));
}

TEST_F(GateFile, BadOneSparesTheOthers) {
  const std::string good = write("good.toml", kGate);
  const std::string broken = write("broken.toml", "[[gate]]\nid = 3\n");
  const std::string again = write("again.toml", kGate);
  const GateFiles files = read_gate_files({broken, good, folder_ / "missing.toml", again});
  ASSERT_EQ(files.gates.size(), 1);
  EXPECT_EQ(files.gates[0].file, good);
  ASSERT_EQ(files.unreadable.size(), 3);
  EXPECT_THAT(files.unreadable[0].why, HasSubstr("broken.toml:2"));
  EXPECT_THAT(files.unreadable[1].why, HasSubstr("missing.toml"));
  EXPECT_THAT(files.unreadable[2].why,
              AllOf(HasSubstr("again.toml:2"), HasSubstr("first"), HasSubstr("good.toml:2")));
  EXPECT_EQ(exit_code(files.unreadable), 2);
}

TEST_F(GateFile, OnlyPicksByIdAndNamesTheNearest) {
  const std::vector<Gate> gates = read_gates(write("good.toml", kGate));
  EXPECT_EQ(select_gates(gates, {}).size(), 1);
  EXPECT_EQ(select_gates(gates, {"first", "first"}).size(), 1);
  for (const auto& ids : {std::vector<std::string>{"frist"}, {"first", "frist"}}) {
    EXPECT_THAT(solver::complaint([&] { select_gates(gates, ids); }),
                AllOf(HasSubstr("--only frist"), HasSubstr(" first")));
  }
  EXPECT_THROW(select_gates({}, {"first"}), solver::InputError);
}

}  // namespace
}  // namespace slipstick::convergence
