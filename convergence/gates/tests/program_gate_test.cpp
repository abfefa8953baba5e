// The program's exit codes and files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "convergence/gates/tests/gate_folder.hpp"
#include "convergence/programs/tests/program_run.hpp"
#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

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
