// Accuracy gates: what a gate file may say, which numbers pass, what is written about those that do not, and
// the program's exit codes.

#include "convergence/gates/gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "convergence/gates/gate_reader.hpp"
#include "convergence/gates/gate_report.hpp"
#include "convergence/programs/tests/program_run.hpp"
#include "convergence/results/quantity.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/tests/complaint.hpp"

namespace slipstick::convergence {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
namespace fs = std::filesystem;

/// A solve's result as far as gates look at it; its reference is good to 1e-15.
Json solve_with(const std::string& quantity, const Json& value) {
  Json result{{"status", "converged"}, {"exact", {{"relative_uncertainty", 1e-15}}}};
  result[quantity] = value;
  return result;
}

Gate gate_on(const std::string& quantity) {
  Gate gate;
  gate.file = "gates/some.toml";
  gate.line = 12;
  gate.id = "some-gate";
  gate.quantity = quantity;
  gate.basis = "measured 1e-6, factor 10";
  gate.reason = "users read this number";
  return gate;
}

Gate below(const std::string& quantity, double bound) {
  Gate gate = gate_on(quantity);
  gate.below = bound;
  return gate;
}

Gate between(const std::string& quantity, double low, double high) {
  Gate gate = below(quantity, high);
  gate.above = low;
  return gate;
}

Gate equals(const std::string& quantity, const Json& value) {
  Gate gate = gate_on(quantity);
  gate.equals = value;
  return gate;
}

Gate with_status(Gate gate, GateStatus status) {
  gate.status = status;
  return gate;
}

Outcome outcome(const Gate& gate, const Json& value) {
  return judge(gate, solve_with(gate.quantity, value)).outcome;
}

TEST(Gate, BelowAloneBoundsTheSize) {
  const Gate gate = below("twist_error", 2e-5);
  EXPECT_EQ(outcome(gate, 1.9e-5), Outcome::passed);
  EXPECT_EQ(outcome(gate, -1.9e-5), Outcome::passed);
  EXPECT_EQ(outcome(gate, 2e-5), Outcome::failed);
  EXPECT_EQ(outcome(gate, 2.1e-5), Outcome::failed);
  EXPECT_EQ(outcome(gate, -2.1e-5), Outcome::failed);
}

TEST(Gate, BelowAndAboveBoundTheSignedValue) {
  const Gate gate = between("order", 1.0, 2.0);
  EXPECT_EQ(outcome(gate, 1.5), Outcome::passed);
  for (const double value : {0.9, 1.0, 2.0, 2.1, -1.5})
    EXPECT_EQ(outcome(gate, value), Outcome::failed) << value;
  const Gate negative = between("twist_error", -3e-3, -1e-3);
  EXPECT_EQ(outcome(negative, -2e-3), Outcome::passed);
  EXPECT_EQ(outcome(negative, 2e-3), Outcome::failed);
  EXPECT_EQ(outcome(negative, 0.0), Outcome::failed);
}

TEST(Gate, AboveAloneBoundsTheSignedValue) {
  Gate gate = gate_on("stick_cells");
  gate.above = 3;
  EXPECT_EQ(outcome(gate, 4), Outcome::passed);
  for (const double value : {3.0, 2.0, -4.0}) EXPECT_EQ(outcome(gate, value), Outcome::failed) << value;
  EXPECT_DOUBLE_EQ(judge(gate, solve_with("stick_cells", 2)).factor, 1.5);
}

TEST(Gate, EqualsTakesWordsAndCounts) {
  EXPECT_EQ(outcome(equals("verdict", "asymptotic"), "asymptotic"), Outcome::passed);
  EXPECT_EQ(outcome(equals("verdict", "asymptotic"), "preasymptotic"), Outcome::failed);
  EXPECT_EQ(outcome(equals("verdict", "asymptotic"), 1.0), Outcome::failed);
  EXPECT_EQ(outcome(equals("steps", 8.0), 8), Outcome::passed);
  EXPECT_EQ(outcome(equals("steps", 8.0), 9), Outcome::failed);
  EXPECT_EQ(outcome(equals("steps", 8.0), "8"), Outcome::failed);
}

TEST(Gate, FactorSaysHowFarFromTheBound) {
  EXPECT_DOUBLE_EQ(judge(below("x", 2.0), solve_with("x", -3.0)).factor, 1.5);
  EXPECT_DOUBLE_EQ(judge(between("x", 1.0, 2.0), solve_with("x", 0.5)).factor, 2.0);
  EXPECT_DOUBLE_EQ(judge(between("x", 1.0, 2.0), solve_with("x", 1.5)).factor, 0.0);
  EXPECT_TRUE(std::isinf(judge(below("x", 2.0), solve_with("x", nullptr)).factor));
}

TEST(Gate, NoNumberFailsWithTheReasonBesideIt) {
  Json result = solve_with("twist_error", nullptr);
  result["twist_error_reason"] = "not axisymmetric";
  for (const Gate& gate : {below("twist_error", 1.0), equals("twist_error", "asymptotic")}) {
    const Judgement judgement = judge(gate, result);
    EXPECT_EQ(judgement.outcome, Outcome::failed);
    EXPECT_THAT(judgement.why, AllOf(HasSubstr("twist_error"), HasSubstr("not axisymmetric")));
  }
  result["traction_error"] = nullptr;
  result["traction_error_reason"] = "no exact tractions";
  EXPECT_THAT(judge(below("traction_error.averaged.l2", 1.0), result).why, HasSubstr("no exact tractions"));
  result["list"] = {1.0, 2.0};
  EXPECT_EQ(judge(below("list", 3.0), result).outcome, Outcome::failed);
  const double nan = std::nan("");
  for (const Gate& gate : {below("x", 1.0), between("x", -1.0, 1.0)}) {
    EXPECT_EQ(judge(gate, solve_with("x", nan)).outcome, Outcome::failed);
  }
}

TEST(Gate, MissingQuantityFailsAndNamesTheNearest) {
  const Judgement judgement = judge(below("twist_eror", 1.0), solve_with("twist_error", 1e-6));
  EXPECT_EQ(judgement.outcome, Outcome::failed);
  EXPECT_THAT(judgement.why, AllOf(HasSubstr("no twist_eror"), HasSubstr("nearest is twist_error")));
  const Json failed{{"status", "failed"}, {"message", "killed by signal 9"}};
  EXPECT_THAT(judge(below("twist_error", 1.0), failed).why, HasSubstr("killed by signal 9"));
}

TEST(Gate, SolveThatDidNotConvergeFailsWhateverItsNumber) {
  Json result = solve_with("twist_error", 1e-7);
  result["status"] = "not_converged";
  result["message"] = "out of steps";
  const Judgement judgement = judge(below("twist_error", 1e-5), result);
  EXPECT_EQ(judgement.outcome, Outcome::failed);
  EXPECT_THAT(judgement.why, AllOf(HasSubstr("tolerance"), HasSubstr("out of steps")));
  EXPECT_EQ(judge(equals("status", "not_converged"), result).outcome, Outcome::passed);
}

TEST(Gate, TighterThanTenTimesReferenceAndSpreadIsRefused) {
  Json result = solve_with("twist_error", 1e-9);
  result["exact"]["relative_uncertainty"] = 3e-8;
  Gate gate = below("twist_error", 0.9e-6);
  gate.platform_spread = 5e-8;
  EXPECT_EQ(judge(gate, result).outcome, Outcome::passed);
  gate.platform_spread = 7e-8;
  const Judgement refused = judge(gate, result);
  EXPECT_EQ(refused.outcome, Outcome::refused);
  EXPECT_THAT(refused.why, AllOf(HasSubstr("tighter"), HasSubstr("9e-07"), HasSubstr("1e-06")));
  EXPECT_EQ(exit_code({refused}), 2);
  gate.above = 0.0;  // half as wide as its upper bound says
  gate.platform_spread = 2e-8;
  EXPECT_EQ(judge(gate, result).outcome, Outcome::refused);
  gate.above = -0.9e-6;
  EXPECT_EQ(judge(gate, result).outcome, Outcome::passed);
}

TEST(Gate, ReferenceCountsForErrorsOnly) {
  Json result{
      {"exact", {{"relative_uncertainty", 1e-3}}}, {"certificate", {{"gap", 1e-9}}}, {"twist_error", 1e-4}};
  EXPECT_EQ(judge(below("certificate.gap", 1e-8), result).outcome, Outcome::passed);
  EXPECT_EQ(judge(below("twist_error", 1e-3), result).outcome, Outcome::refused);
  result.erase("exact");
  const Judgement unknown = judge(below("twist_error", 1e-3), result);
  EXPECT_EQ(unknown.outcome, Outcome::refused);
  EXPECT_THAT(unknown.why, HasSubstr("does not say"));
}

TEST(Gate, NearestReferenceIsTheOneThatCounts) {
  const Json result{
      {"exact", {{"relative_uncertainty", 1e-2}}},
      {"steps", {{{"exact", {{"relative_uncertainty", 1e-9}}}, {"twist_error", 1e-4}}}},
      {"series",
       {{"nu-0.3", {{"reference_uncertainty", 2e-5}, {"order", {{"twist_error", {{"value", 2.0}}}}}}}}}};
  EXPECT_EQ(reference_error(result, "steps[0].twist_error"), 1e-9);
  EXPECT_EQ(reference_error(result, "series.nu-0.3.order.twist_error.value"), 2e-5);
  EXPECT_EQ(reference_error(result, "iterations"), 0.0);
}

TEST(Gate, OfAResultFileTheReferenceCountsWhereItIsStated) {
  Gate gate = below("counts.errors", 10.0);
  gate.kind = GateSource::result;
  Json result{{"counts", {{"errors", 3}}}};
  EXPECT_EQ(judge(gate, result).outcome, Outcome::passed) << "the file says nothing of a reference";
  result["counts"]["reference_uncertainty"] = 0.9;
  EXPECT_EQ(judge(gate, result).outcome, Outcome::passed);
  result["counts"]["reference_uncertainty"] = 1.1;
  EXPECT_EQ(judge(gate, result).outcome, Outcome::refused);
  gate.kind = GateSource::scene;
  EXPECT_EQ(judge(gate, {{"counts", {{"errors", 3}}}}).outcome, Outcome::refused);
}

TEST(Gate, BoundsAreSaidInFull) {
  EXPECT_EQ(bound_text(equals("x", 1535605.0)), "equal to 1535605");
  EXPECT_EQ(bound_text(equals("x", "asymptotic")), "equal to \"asymptotic\"");
  EXPECT_EQ(bound_text(between("x", 1535605.0, 1535607.0)), "between 1535605 and 1535607");
  EXPECT_EQ(bound_text(below("x", 2e-5)), "below 2e-05 in size");
}

TEST(Gate, ExpectedFailureMustFail) {
  const Gate gate = with_status(below("x", 1.0), GateStatus::expected_failure);
  EXPECT_EQ(outcome(gate, 2.0), Outcome::failed_as_expected);
  const Judgement passed = judge(gate, solve_with("x", 0.5));
  EXPECT_EQ(passed.outcome, Outcome::passed_unexpectedly);
  EXPECT_THAT(passed.why, HasSubstr("remove the entry"));
  EXPECT_EQ(exit_code({passed}), 1);
  EXPECT_EQ(judge(gate, solve_with("y", 2.0)).outcome, Outcome::failed) << "a misspelt quantity";
}

/// A run that died is no answer of any kind: whatever was expected, it fails.
TEST(Gate, RunsThatDiedFailAGateOfAnyStatus) {
  const Json died{{"status", "failed"}, {"message", "killed by signal 9"}};
  Json study = {{"failed_runs",
                 {{"count", 1}, {"of", 35}, {"first", {{"run", "paper"}, {"message", "memory ran out"}}}}},
                {"x", 0.5}};
  for (const GateStatus status :
       {GateStatus::active, GateStatus::expected_failure, GateStatus::report_only}) {
    Gate gate = with_status(below("x", 1.0), status);
    const Judgement solve = judge(gate, died);
    EXPECT_EQ(solve.outcome, Outcome::failed);
    EXPECT_THAT(solve.why, HasSubstr("killed by signal 9"));
    EXPECT_EQ(exit_code({solve}), 1);
    gate.kind = GateSource::study;
    const Judgement some = judge(gate, study);
    EXPECT_EQ(some.outcome, Outcome::failed);
    EXPECT_THAT(some.why, HasSubstr("1 of 35 runs failed; the first (paper): memory ran out"));
    EXPECT_EQ(some.value, 0.5);
  }
  study["failed_runs"]["count"] = 0;
  EXPECT_EQ(judge(below("x", 1.0), study).outcome, Outcome::passed);
}

TEST(Gate, ExitCodeIsThatOfTheWorst) {
  const auto judged = [](GateStatus status, double value) {
    return judge(with_status(below("x", 1.0), status), solve_with("x", value));
  };
  const Judgement passed = judged(GateStatus::active, 0.5);
  const Judgement failed = judged(GateStatus::active, 2.0);
  const Judgement reported = judged(GateStatus::report_only, 2.0);
  const Judgement expected = judged(GateStatus::expected_failure, 2.0);
  const Judgement refused = refuse(gate_on("x"), "no such file");
  EXPECT_EQ(exit_code({}), 2);
  EXPECT_EQ(exit_code({passed, reported, expected}), 0);
  EXPECT_EQ(exit_code({passed, failed, passed}), 1);
  EXPECT_EQ(exit_code({failed, refused, passed}), 2);
}

TEST(Quantity, IsFoundByItsPath) {
  const Json result{{"a", {{"b.c", {{"d", 1}}}, {"b", {{"c", {{"d", 2}, {"e", 3}}}}}}},
                    {"list", {{{"x", 4}}, {{"x", {5, 6}}}}},
                    {"none", nullptr},
                    {"none_reason", "because"}};
  const auto at = [&](const std::string& path) {
    const FoundQuantity found = find_quantity(result, path);
    return found.value == nullptr ? -1 : found.value->get<int>();
  };
  EXPECT_EQ(at("a.b.c.d"), 1);
  EXPECT_EQ(at("a.b.c.e"), 3) << "the key with a dot leads nowhere, the other does";
  EXPECT_EQ(at("list[0].x"), 4);
  EXPECT_EQ(at("list[1].x[1]"), 6);
  for (const char* path :
       {"", "a.b.x", "lis", "list[2].x", "list[-1].x", "list[1", "list[].x", "list[1x].x", "list.x"}) {
    EXPECT_EQ(at(path), -1) << path;
  }
  EXPECT_EQ(find_quantity(result, "none.deeper").reason, "because");
  EXPECT_EQ(find_quantity(result, "a.b.c.e").reason, "");
  EXPECT_THAT(quantity_paths(result), ElementsAre("a.b.c.d", "a.b.c.d", "a.b.c.e", "list[0].x",
                                                  "list[1].x[0]", "list[1].x[1]", "none", "none_reason"));
}

/// A folder of its own for each test.
class GateFolder : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("slipstick-" + std::string(test->test_suite_name()) + test->name() + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }

  fs::path folder_;
};

class GateFile : public GateFolder {
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
  EXPECT_EQ(gates[0].source, folder_ / "scenes/paper.toml");
  EXPECT_EQ(gates[0].kind, GateSource::scene);
  EXPECT_THAT(gates[0].overrides,
              testing::UnorderedElementsAre("load.moment_ratio=0.9", "grid.cells=[256, 256]",
                                            "contact.pressure='hertz'"));
  EXPECT_EQ(gates[0].below, 2e-5);
  EXPECT_EQ(gates[0].above, std::nullopt);
  EXPECT_EQ(gates[0].status, GateStatus::active);
  EXPECT_EQ(gates[1].line, 10);
  EXPECT_EQ(gates[1].kind, GateSource::study);
  EXPECT_EQ(gates[1].equals, "asymptotic");
  EXPECT_EQ(gates[1].status, GateStatus::report_only);
  EXPECT_EQ(gates[1].reason, "to know");
  EXPECT_EQ(gates[1].platform_spread, 0.1);
  EXPECT_EQ(gates[2].source, "/elsewhere/cone.toml");
  EXPECT_EQ(gates[2].above, 1.0);
  EXPECT_EQ(gates[2].below, 7.0);
}

TEST_F(GateFile, BadEntriesAreNamedWithTheirLine) {
  const std::string good = kGate;
  const auto with = [&](const std::string& line) { return good + line + "\n"; };
  const auto without = [&](const std::string& key) {
    const auto begin = good.find("\n" + key) + 1;
    return good.substr(0, begin) + good.substr(good.find('\n', begin) + 1);
  };
  EXPECT_THAT(complaint(with("bellow = 1")), AllOf(HasSubstr("bad.toml:9"), HasSubstr("gate[0].bellow"),
                                                   HasSubstr("nearest known one is gate[0].below")));
  EXPECT_THAT(complaint(with("study = 'a.toml'")), HasSubstr("one of scene and study"));
  EXPECT_THAT(complaint(without("scene")), HasSubstr("one of scene and study"));
  EXPECT_THAT(complaint(without("id")), HasSubstr("gate[0].id"));
  EXPECT_THAT(complaint(without("quantity")), HasSubstr("gate[0].quantity"));
  EXPECT_THAT(complaint(without("below")), HasSubstr("below, above, both, or equals"));
  EXPECT_THAT(complaint(without("basis")), AllOf(HasSubstr("gate[0].basis"), HasSubstr("active gate")));
  EXPECT_THAT(complaint(without("basis") + "basis = ''\n"), HasSubstr("gate[0].basis"));
  EXPECT_THAT(complaint(with("equals = 3")), HasSubstr("one or the other"));
  EXPECT_THAT(complaint(with("above = 2e-5")), HasSubstr("less than below"));
  EXPECT_THAT(complaint(without("below") + "below = -1\n"), HasSubstr("positive"));
  EXPECT_THAT(complaint(without("below") + "below = nan\n"), HasSubstr("finite"));
  EXPECT_THAT(complaint(with("status = 'off'")), AllOf(HasSubstr("\"off\""), HasSubstr("expected_failure")));
  EXPECT_THAT(complaint(with("platform_spread = -1")), HasSubstr("platform_spread"));
  EXPECT_THAT(complaint("[[gates]]\nid = 1\n"), HasSubstr("gates"));
  EXPECT_THAT(complaint("[[gate]\n"), HasSubstr("bad.toml:1"));
  EXPECT_EQ(complaint(with("status = 'report_only'")), "");
  EXPECT_EQ(complaint(without("basis") + "status = 'report_only'\n"), "");
}

constexpr const char* kResultGate = R"([[gate]]
id = "counted"
result = "work.json"
quantity = "counts.some-case.applications"
above = 17
below = 21
basis = "counted 19"
)";

TEST_F(GateFile, NamesResultsBesideItOrInAFolder) {
  const std::string file = write("gates.toml", std::string("made_by = 'make gate'\n") + kResultGate);
  const Gate gate = read_gates(file).at(0);
  EXPECT_EQ(gate.kind, GateSource::result);
  EXPECT_EQ(gate.source, folder_ / "work.json");
  EXPECT_EQ(gate.made_by, "make gate");
  EXPECT_THAT(rerun_command(gate), Not(HasSubstr("--results")));
  const Gate elsewhere = read_gates(file, "some where").at(0);
  EXPECT_EQ(elsewhere.source, "some where/work.json");
  EXPECT_THAT(rerun_command(elsewhere), HasSubstr("--results 'some where' --only counted"));
}

TEST_F(GateFile, ResultStandsAlone) {
  const std::string good = kResultGate;
  EXPECT_EQ(complaint(good), "");
  EXPECT_THAT(complaint(good + "scene = 'a.toml'\n"), HasSubstr("one of scene and study"));
  EXPECT_THAT(complaint(good + "study = 'a.toml'\n"), HasSubstr("one of scene and study"));
  EXPECT_THAT(complaint(good + "set = { 'grid.cells' = [8, 8] }\n"),
              AllOf(HasSubstr("gate[0].set"), HasSubstr("left out beside result")));
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
                AllOf(HasSubstr("--only frist"), HasSubstr("nearest is first")));
  }
  EXPECT_THROW(select_gates({}, {"first"}), solver::InputError);
}

// Every kind of gate, with all that XML, Markdown and annotations take for markup.
std::vector<Judgement> one_of_each() {
  const auto named = [](Gate gate, const std::string& id) {
    gate.id = id;
    return gate;
  };
  std::vector<Judgement> judgements{
      judge(named(below("x", 1.0), "good"), solve_with("x", 0.5)),
      judge(named(below("x", 1.0), "bad <a> & \"b\" | c, d: 100 %"), solve_with("x", 4.0)),
      judge(with_status(named(below("x", 1.0), "known"), GateStatus::expected_failure), solve_with("x", 2.0)),
      judge(with_status(named(below("x", 1.0), "repaired"), GateStatus::expected_failure),
            solve_with("x", 0.5)),
      judge(with_status(named(below("x", 1.0), "watched"), GateStatus::report_only), solve_with("x", 3.0)),
      refuse(named(below("x", 1.0), "unreadable"), "no\nsuch \x01 scene <here>"),
  };
  judgements[1].dominant_error = "discretisation";
  judgements[1].seconds = 1.5;
  judgements[2].gate.file = "gates/other.toml";
  return judgements;
}

TEST(GateReport, TextExplainsWhatDoesNotPass) {
  const std::string text = gates_text(one_of_each());
  EXPECT_THAT(text, AllOf(HasSubstr("x is 4, must be below 1 in size: 4 times the bound"),
                          HasSubstr("likely to blame: discretisation"), HasSubstr("users read this number"),
                          HasSubstr("measured 1e-6, factor 10"),
                          HasSubstr("slipstick gate gates/some.toml --only 'bad <a> & \"b\" | c, d: 100 %'"),
                          HasSubstr("slipstick gate gates/some.toml --only repaired")));
  EXPECT_THAT(
      text,
      HasSubstr("6 gates: 1 passed, 1 failed as expected, 1 reported, 1 refused, 1 passed unexpectedly, "
                "1 failed\n"));
  EXPECT_THAT(text, Not(HasSubstr("--only good")));
}

/// What Python's parser finds in JUnit XML: a line for every element.
std::string parse_xml(const fs::path& file) {
  const fs::path script = file.string() + ".py";
  std::ofstream(script) << "import sys, xml.etree.ElementTree as tree\n"
                           "for e in tree.parse(sys.argv[1]).iter():\n"
                           "    print(e.tag, dict(e.attrib), repr(e.text))\n";
  const ProgramEnd end = run_program({SLIPSTICK_PYTHON, script, file}, {.captured = Captured::output});
  return end.code == 0 ? end.output : "not XML";
}

class GateJunit : public GateFolder {};

TEST_F(GateJunit, IsReadBackByAParser) {
  const std::string seen = parse_xml(write("junit.xml", gates_junit(one_of_each())));
  EXPECT_THAT(
      seen, HasSubstr("testsuites {'name': 'slipstick gates', 'tests': '6', 'failures': '2', 'errors': '1', "
                      "'skipped': '2', 'time': '1.500'}"));
  EXPECT_THAT(
      seen, HasSubstr("testsuite {'name': 'gates/other.toml', 'tests': '1', 'failures': '0', 'errors': '0', "
                      "'skipped': '1', 'time': '0.000'}"));
  EXPECT_THAT(
      seen,
      HasSubstr("testcase {'classname': 'some', 'name': 'bad <a> & \"b\" | c, d: 100 %', 'time': '1.500'}"));
  EXPECT_THAT(seen,
              HasSubstr("failure {'message': 'x is 4, must be below 1 in size: 4 times the bound', 'type': "
                        "'failed'}"));
  EXPECT_THAT(seen, HasSubstr("error {'message': 'no\\nsuch  scene <here>', 'type': 'refused'}"));
  EXPECT_THAT(
      seen, HasSubstr("skipped {'message': 'reported: x is 3, must be below 1 in size: 3 times the bound'}"));
  EXPECT_THAT(seen, HasSubstr("likely to blame: discretisation"));
}

/// Failing gates, gate i by the factor 2 + i, in an order that hides the worst.
std::vector<Judgement> many_failures(int count) {
  std::vector<Judgement> judgements;
  for (int i = 0; i < count; ++i) {
    Gate gate = below("x", 1.0);
    const int rank = (i * 7919) % count;
    gate.id = "gate-" + std::to_string(rank);
    judgements.push_back(judge(gate, solve_with("x", 2.0 + rank)));
  }
  return judgements;
}

TEST(GateReport, MarkdownStaysBelow64kBWithTheWorstFirst) {
  const std::string text = gates_markdown(many_failures(5000));
  EXPECT_LT(text.size(), 64000U);
  EXPECT_GT(text.size(), 60000U) << "cut off earlier than needed";
  std::istringstream lines(text);
  std::string line;
  int expected = 4999;
  int rows = 0;
  while (std::getline(lines, line)) {
    if (!line.starts_with("| failed | ")) continue;
    EXPECT_THAT(line, HasSubstr("| gate-" + std::to_string(expected--) + " |"));
    ++rows;
  }
  EXPECT_THAT(text, HasSubstr(std::to_string(5000 - rows) + " more gates"));
  EXPECT_THAT(text, HasSubstr("5000 gates: 5000 failed"));
}

TEST(GateReport, MarkdownHoldsEveryGateInItsOrderOfBadness) {
  const std::string text = gates_markdown(one_of_each());
  std::size_t last = 0;
  for (const char* id : {"bad &lt;a>", "repaired", "unreadable", "watched", "known", "| good |"}) {
    const std::size_t at = text.find(id);
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_GT(at, last) << id;
    last = at;
  }
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (line.starts_with("|")) {
      const auto bars =
          std::count(line.begin(), line.end(), '|') -
          static_cast<long>(line.find("\\|") != std::string::npos ? 2
                                                                  : 0);  // in the id, and again to rerun it
      EXPECT_EQ(bars, 8) << line;
    }
  }
  EXPECT_THAT(text, Not(HasSubstr("more gates")));
}

TEST(GateReport, AnnotationsStandAtTheGateAndAreEscaped) {
  const std::string text = gates_annotations(one_of_each());
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_THAT(
      text,
      HasSubstr("::error file=gates/some.toml,line=12,title=Gate bad <a> & \"b\" | c%2C d%3A 100 %25::x is "
                "4, must be below 1 in size: 4 times the bound%0Alikely to blame: discretisation%0A"));
}

TEST(GateReport, JsonHasEveryNumberOrAReason) {
  const Json json = gates_json(one_of_each());
  EXPECT_EQ(json["exit_code"], 2);
  EXPECT_EQ(json["counts"]["failed"], 1);
  ASSERT_EQ(json["gates"].size(), 6);
  EXPECT_EQ(json["gates"][1]["value"], 4.0);
  EXPECT_EQ(json["gates"][1]["factor"], 4.0);
  EXPECT_EQ(json["gates"][1]["outcome"], "failed");
  EXPECT_TRUE(json["gates"][5]["value"].is_null());
  EXPECT_THAT(json["gates"][5]["value_reason"].get<std::string>(), HasSubstr("scene"));
}

/// The program with gates on a coarse grid.
class GateProgram : public GateFolder {
 protected:
  ProgramRun run(const std::string& arguments) const {
    return run_program_with("gate --output " + (folder_ / "points").string() + " " + arguments);
  }

  std::string gate(const std::string& id, const std::string& bound, const std::string& more = "") const {
    return "[[gate]]\nid = '" + id + "'\nscene = '" + std::string(SLIPSTICK_SCENES) +
           "/paper.toml'\nset = { 'grid.cells' = [16, 16] }\nquantity = 'certificate.gap'\n" + bound +
           "\nbasis = 'the tolerance'\n" + more + "\n";
  }
};

TEST_F(GateProgram, ExitCodesSayWhatHappened) {
  const std::string loose = "below = 1e-7";
  const std::string tight = "below = 1e-30";
  const std::string good = write("good.toml", gate("good", loose));
  const std::string bad =
      write("bad.toml", gate("bad", tight) + gate("known", tight, "status = 'expected_failure'"));
  const std::string repaired = write("repaired.toml", gate("repaired", loose, "status = 'expected_failure'"));
  const std::string refused = write("refused.toml", gate("refused", loose, "platform_spread = 1"));
  const std::string empty = write("empty.toml", "");
  EXPECT_EQ(run(good).exit_code, 0);
  EXPECT_EQ(run(good + " " + bad).exit_code, 1);
  EXPECT_EQ(run(bad + " --only known").exit_code, 0);
  EXPECT_EQ(run(repaired).exit_code, 1);
  const ProgramRun tightened = run(refused);
  EXPECT_EQ(tightened.exit_code, 2);
  EXPECT_THAT(tightened.output, HasSubstr("tighter than its reference allows"));
  const ProgramRun none = run(empty);
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.output, HasSubstr("no gate ran"));
  EXPECT_EQ(run(good + " --only goood").exit_code, 2);
  EXPECT_EQ(run("").exit_code, 2);
  EXPECT_EQ(run((folder_ / "missing.toml").string()).exit_code, 2);
}

TEST_F(GateProgram, WritesItsReportsWhateverElseIsWrong) {
  const std::string good = write("good.toml", gate("good", "below = 1e-7"));
  const std::string bad = write("bad.toml", gate("bad", "below = 1e-30"));
  const std::string broken = write("broken.toml", "[[gate]]\nname = 'x'\n");
  const std::string lost = write("lost.toml",
                                 "[[gate]]\nid = 'lost'\nscene = 'nowhere.toml'\nquantity = 'x'\n"
                                 "below = 1\nbasis = 'none'\n");
  const ProgramRun out = run(
      broken + " " + good + " " + lost + " " + bad + " --github --junit " + (folder_ / "junit.xml").string() +
      " --summary " + (folder_ / "summary.md").string() + " --json " + (folder_ / "gates.json").string());
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_THAT(out.output,
              AllOf(HasSubstr("::error file=" + bad + ",line=1,title=Gate bad::certificate.gap is "),
                    HasSubstr("nowhere.toml"), HasSubstr("broken.toml")));
  EXPECT_THAT(parse_xml(folder_ / "junit.xml"), HasSubstr("'tests': '4', 'failures': '1', 'errors': '2'"));
  EXPECT_THAT(read("summary.md"), HasSubstr("| passed | good | certificate.gap |"));
  const Json json = Json::parse(read("gates.json"));
  EXPECT_EQ(json["counts"]["passed"], 1);
  EXPECT_EQ(json["counts"]["refused"], 2);
}

TEST_F(GateProgram, SaysWhatIsToBlame) {
  const std::string file =
      write("coarse.toml", "[[gate]]\nid = 'coarse'\nscene = '" + std::string(SLIPSTICK_SCENES) +
                               "/paper.toml'\nset = { 'grid.cells' = [16, 16] }\n"
                               "quantity = 'twist_error'\nbelow = 1e-6\nbasis = 'none'\n");
  const ProgramRun out = run(file);
  EXPECT_EQ(out.exit_code, 1);
  EXPECT_THAT(out.output, AllOf(HasSubstr("likely to blame: discretisation"), HasSubstr("--only coarse")));
}

TEST_F(GateProgram, JudgesStudies) {
  write("study.toml", "scene = '" + std::string(SLIPSTICK_SCENES) + "/paper.toml'\ncells = [12, 16]\n");
  const auto study = [](const std::string& id, const std::string& file, const std::string& equals) {
    return "[[gate]]\nid = '" + id + "'\nstudy = '" + file +
           "'\nset = { 'load.moment_ratio' = 0.5 }\nquantity = 'series.paper.rows[1].cells[0]'\nequals = " +
           equals + "\nbasis = 'asked for'\n";
  };
  EXPECT_EQ(run(write("good.toml", study("good", "study.toml", "16"))).exit_code, 0);
  EXPECT_EQ(run(write("bad.toml", study("bad", "study.toml", "12"))).exit_code, 1);
  const ProgramRun lost = run(write("lost.toml", study("lost", "nowhere.toml", "16")));
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_THAT(lost.output, HasSubstr("nowhere.toml"));
}

TEST_F(GateProgram, JudgesResultFilesOfAnyProgram) {
  const std::string file = write("gates.toml", std::string("made_by = 'make counts'\n") + kResultGate);
  const auto counted = [](const std::string& number) {
    return R"({"counts": {"some-case": {"applications": )" + number + "}}}";
  };
  const ProgramRun lost = run(file);
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_THAT(lost.output, AllOf(HasSubstr("work.json"), HasSubstr("make counts")));
  write("work.json", counted("19"));
  EXPECT_EQ(run(file).exit_code, 0);
  for (const char* wrong : {"16", "22", "null", "\"19\""}) {
    write("work.json", counted(wrong));
    EXPECT_EQ(run(file).exit_code, 1) << wrong;
  }
  fs::create_directory(folder_ / "results");
  write("results/work.json", counted("18"));
  EXPECT_EQ(run(file + " --results " + (folder_ / "results").string()).exit_code, 0);
  for (const char* broken : {"{", "", "{\"counts\": NaN}", "{\"counts\": 1e400}"}) {
    write("work.json", broken);
    const ProgramRun out = run(file);
    EXPECT_EQ(out.exit_code, 2) << broken;
    EXPECT_THAT(out.output, AllOf(HasSubstr("work.json"), HasSubstr("is not JSON")));
  }
}

TEST_F(GateProgram, ComputesEqualScenesOnce) {
  const std::string file = write("two.toml", gate("one", "below = 1e-7") + gate("two", "below = 1e-6"));
  const ProgramRun first = run(file);
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_THAT(first.output, HasSubstr("[1/1]"));
  EXPECT_THAT(run(file).output, Not(HasSubstr("[1/1]")));
}

}  // namespace
}  // namespace slipstick::convergence
