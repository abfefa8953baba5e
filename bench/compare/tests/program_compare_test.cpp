// `slipstick compare` as users run it: exit codes, the second run, and what is written where.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/compare/tests/made_timings.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/programs/tests/program_run.hpp"
#include "convergence/runs/run_spec.hpp"

namespace slipstick::bench {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

ProgramRun run(const std::string& arguments) { return run_program_with(arguments); }

/// Files of one test, in a folder of its own.
class ProgramCompare : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_ / name.c_str(); }

  std::string write(const std::string& name, const Timings& timings) const {
    std::ofstream(file(name)) << google_json(timings);
    return file(name);
  }

  /// Two benchmarks, the first as many times slower as is asked for.
  std::string write(const std::string& name, double factor, int seed) const {
    return write(name, file_of(name, {steady("apply/dcfft/64", factor * 61.2e-3, 10, seed),
                                      steady("apply|(direct)/8", 1e-6, 10, seed + 1)}));
  }

  /// The arguments: base, and a new file that is as many times slower.
  std::string files(double factor) const {
    return "compare " + write("base.json", 1.0, 1) + " " + write("new.json", factor, 3);
  }

 private:
  convergence::TemporaryFolder folder_;
};

TEST_F(ProgramCompare, HasHelpWithAnExample) {
  const ProgramRun help = run("compare --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.output, AllOf(HasSubstr("Example"), HasSubstr("slipstick compare base.json new.json"),
                                 HasSubstr("--json"), HasSubstr("--quiet"), HasSubstr("Exit code")));
}

TEST_F(ProgramCompare, ExitCodeSaysWhatWasFound) {
  const ProgramRun same = run(files(1.0));
  EXPECT_EQ(same.exit_code, 0) << same.output;
  EXPECT_THAT(same.output, AllOf(HasSubstr("2 benchmarks: 2 same"), Not(HasSubstr("one run only"))));
  const ProgramRun slower = run(files(1.2));
  EXPECT_EQ(slower.exit_code, 1) << slower.output;
  EXPECT_THAT(slower.output, AllOf(HasSubstr("apply/dcfft/64    61."), HasSubstr(" ms  "),
                                   HasSubstr("slower (p "), HasSubstr("2 benchmarks: 1 same, 1 slower"),
                                   HasSubstr("one run only"), HasSubstr("--rerun")));
  EXPECT_EQ(run(files(0.8)).exit_code, 0);
  const ProgramRun rules = run(files(1.2) + " --effect 30% --level 0.02");
  EXPECT_EQ(rules.exit_code, 0);
  EXPECT_THAT(rules.output, HasSubstr("30 % or more, by chance in 2 of 100"));
  EXPECT_EQ(run(files(1.06) + " --effect 0.05").exit_code, 1);
  EXPECT_EQ(run(files(1.2) + " --level 1e-9").exit_code, 2);  // too few repetitions for that
}

TEST_F(ProgramCompare, WorstStandsFirst) {
  write("base.json",
        file_of("", {steady("a", 1e-3, 10, 1), steady("b", 1.0, 10, 2), steady("c", 1e-9, 10, 3)}));
  write("new.json",
        file_of("", {steady("a", 1e-3, 10, 4), steady("b", 1.2, 10, 5), steady("c", 2e-9, 10, 6)}));
  const std::string output = run("compare " + file("base.json") + " " + file("new.json")).output;
  EXPECT_LT(output.find("\n  c "), output.find("\n  b "));
  EXPECT_LT(output.find("\n  b "), output.find("\n  a "));
}

TEST_F(ProgramCompare, BadInputIsExitCode2) {
  const std::string good = write("base.json", 1.0, 1);
  const ProgramRun missing = run("compare " + good + " /no/such/file.json");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.output, HasSubstr("/no/such/file.json"));
  std::ofstream(file("other.json")) << "{\"results\": []}";
  const ProgramRun other = run("compare " + good + " " + file("other.json"));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.output, AllOf(HasSubstr("other.json"), HasSubstr("Google Benchmark")));
  EXPECT_EQ(run("compare " + good).exit_code, 2);
  for (const char* effect : {"10", "0", "-5%", "ten", "nan", "5%%", "150%"}) {
    const ProgramRun out = run(files(1.2) + " --effect=" + effect);
    EXPECT_EQ(out.exit_code, 2) << effect;
    EXPECT_THAT(out.output, AllOf(HasSubstr("--effect"), HasSubstr("10% or 0.10")));
  }
  for (const char* level : {"0", "0.6", "nan"}) EXPECT_EQ(run(files(1.2) + " --level " + level).exit_code, 2);
  EXPECT_EQ(run(files(1.2) + " --summary /no/such/folder/s.md").exit_code, 2);
}

TEST_F(ProgramCompare, WhatCannotBeJudgedIsExitCode2AndShown) {
  Timings elsewhere =
      file_of("", {steady("apply/dcfft/64", 1.0, 10, 8), steady("apply|(direct)/8", 1e-6, 10, 9)});
  elsewhere.context.host_name = "elsewhere";
  const std::string files = "compare " + write("base.json", 1.0, 1) + " " + write("new.json", elsewhere);
  const ProgramRun out = run(files);
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_THAT(out.output, AllOf(HasSubstr("machines differ"), HasSubstr("elsewhere"), HasSubstr("not judged"),
                                HasSubstr("1 s"), HasSubstr("2 benchmarks: 2 not judged")));
  EXPECT_EQ(run(files + " --same-machine").exit_code, 1);

  Timings renamed =
      file_of("", {steady("apply/fft/64", 61.2e-3, 10, 8), steady("apply|(direct)/8", 1e-6, 10, 9)});
  renamed.context.library_build_type = "debug";
  write("new.json", renamed);
  EXPECT_THAT(run(files).output, HasSubstr("--debug-library"));
  const ProgramRun name = run(files + " --debug-library");
  EXPECT_EQ(name.exit_code, 2);
  EXPECT_THAT(name.output, AllOf(HasSubstr("only in base"), HasSubstr("renamed to apply/fft/64?"),
                                 HasSubstr("1 only in new")));
}

TEST_F(ProgramCompare, ATimeThatIsNoneFails) {
  Timings bad =
      file_of("", {steady("apply/dcfft/64", 61.2e-3, 10, 8), steady("apply|(direct)/8", 1e-6, 10, 9)});
  bad.benchmarks[0].timings[2].real = std::nan("");
  const ProgramRun out = run("compare " + write("base.json", 1.0, 1) + " " + write("new.json", bad));
  EXPECT_EQ(out.exit_code, 1);
  EXPECT_THAT(out.output, AllOf(HasSubstr("failed"), HasSubstr("repetition 3 is nan")));
}

/// Leaves what the shell made of the filter in a file, and writes a file made before.
std::string second_run(const std::string& second, const std::string& filter_file) {
  return " --rerun \"printf %s {filter} > " + filter_file + "; cat " + second + "\"";
}

TEST_F(ProgramCompare, OnlyWhatTheSecondRunConfirmsCounts) {
  const std::string again = second_run(file("again.json"), file("filter"));
  write("again.json", 1.0, 5);
  const ProgramRun cleared = run(files(1.2) + again);
  EXPECT_EQ(cleared.exit_code, 0) << cleared.output;
  EXPECT_THAT(cleared.output, AllOf(HasSubstr("run again"), HasSubstr("first run: slower (1.2"),
                                    HasSubstr("second: same (1.00"), HasSubstr("2 same")));
  EXPECT_EQ(convergence::read_text(file("filter")), "^(apply/dcfft/64)$");

  write("again.json", 1.2, 5);
  const ProgramRun confirmed = run(files(1.2) + again);
  EXPECT_EQ(confirmed.exit_code, 1);
  EXPECT_THAT(confirmed.output, Not(HasSubstr("one run only")));

  fs::remove(file("filter"));
  EXPECT_EQ(run(files(1.0) + again).exit_code, 0);
  EXPECT_FALSE(fs::exists(file("filter")));  // nothing suspicious, nothing run
}

TEST_F(ProgramCompare, ASecondRunThatTellsNothingLeavesItUndecided) {
  const ProgramRun failed = run(files(1.2) + " --rerun 'exit 3'");
  EXPECT_EQ(failed.exit_code, 2);
  EXPECT_THAT(failed.output, AllOf(HasSubstr("ended with 3"), HasSubstr("1 undecided")));
  const ProgramRun other = run(files(1.2) + " --rerun 'echo hello'");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.output, HasSubstr("Google Benchmark"));
}

// The filter comes with quotes of its own; what else is quoted is the caller's.
TEST_F(ProgramCompare, TheFilterStandsWithoutQuotes) {
  for (const char* command :
       {"p --f=\"{filter}\"", "\"{filter}\"", "\"{filter} \"", "\" {filter}\"", "{filter}\""}) {
    const ProgramRun quoted = run(files(1.2) + fmt::format(" --rerun '{}'", command));
    EXPECT_EQ(quoted.exit_code, 2) << command;
    EXPECT_THAT(quoted.output, HasSubstr("without quotes")) << command;
  }
  for (const char* command : {"{filter} \"\"", "\"\" {filter} \"\"", "{filter}"}) {
    EXPECT_THAT(run(files(1.2) + fmt::format(" --rerun '{}'", command)).output, HasSubstr("ended with"))
        << command;
  }
}

TEST_F(ProgramCompare, WritesJson) {
  const ProgramRun out = run(files(1.2) + " --json -");
  EXPECT_EQ(out.exit_code, 1);
  const json result = json::parse(out.output);
  EXPECT_EQ(result["exit_code"], 1);
  EXPECT_EQ(result["counts"]["slower"], 1);
  ASSERT_EQ(result["benchmarks"].size(), 2U);
  const json& first = result["benchmarks"][0];
  EXPECT_EQ(first["name"], "apply/dcfft/64");
  EXPECT_EQ(first["finding"], "slower");
  EXPECT_NEAR(first["ratio"].get<double>(), 1.2, 0.01);
  EXPECT_LT(first["low"], first["ratio"]);
  EXPECT_GT(first["high"], first["ratio"]);
  EXPECT_EQ(run(files(1.2) + " --quiet").output, "");
}

// JSON has no NaN: what is in one file only has no ratio, and says so.
TEST_F(ProgramCompare, MissingNumbersAreNullWithAReason) {
  write("base.json", file_of("", {steady("a", 1e-3, 10, 1), steady("b", 1.0, 3, 2)}));
  write("new.json", file_of("", {steady("b", 1.2, 3, 5)}));
  const json result =
      json::parse(run("compare " + file("base.json") + " " + file("new.json") + " --json -").output);
  EXPECT_TRUE(result["benchmarks"][0]["ratio"].is_null());
  EXPECT_EQ(result["benchmarks"][0]["ratio_reason"], "no times to compare");
  EXPECT_TRUE(result["benchmarks"][1]["ratio"].is_number());
  for (const char* key : {"low", "high"}) {
    EXPECT_TRUE(result["benchmarks"][1][key].is_null());
    EXPECT_THAT(result["benchmarks"][1][std::string(key) + "_reason"], HasSubstr("too few"));
  }
}

TEST_F(ProgramCompare, WritesJunitAndMarkdown) {
  const ProgramRun out = run(files(1.2) + " --junit " + file("out.xml") + " --summary " + file("out.md"));
  EXPECT_EQ(out.exit_code, 1);
  EXPECT_THAT(convergence::read_text(file("out.xml")),
              AllOf(HasSubstr(R"(tests="2" failures="1" errors="0")"), HasSubstr("<failure message=\"slower"),
                    HasSubstr("name=\"apply|(direct)/8\"")));
  EXPECT_THAT(convergence::read_text(file("out.md")),
              AllOf(HasSubstr("### 2 benchmarks: 1 same, 1 slower"), HasSubstr("| apply/dcfft/64 | 61."),
                    HasSubstr("| apply\\|(direct)/8 | ")));
  Timings elsewhere = file_of("", {steady("apply/dcfft/64", 1.0, 10, 8), steady("other", 1e-6, 10, 9)});
  elsewhere.context.host_name = "a \"b\" & <c>";
  std::string text = google_json(elsewhere);
  text.replace(text.find("a \"b\""), 5, "a \\\"b\\\"");
  std::ofstream(file("new.json")) << text;
  EXPECT_EQ(
      run("compare " + file("base.json") + " " + file("new.json") + " --junit " + file("out.xml")).exit_code,
      2);
  EXPECT_THAT(
      convergence::read_text(file("out.xml")),
      AllOf(HasSubstr(R"(tests="4" failures="0" errors="4")"), HasSubstr("a &quot;b&quot; &amp; &lt;c&gt;")));
}

TEST_F(ProgramCompare, MarkdownStaysBelow64Kilobytes) {
  std::vector<TimedBenchmark> base;
  std::vector<TimedBenchmark> now;
  for (int i = 0; i < 1200; ++i) {
    const std::string name = fmt::format("{:060}", i);
    base.push_back(steady(name, 1e-3, 2, i));
    now.push_back(steady(name, 1e-3, 2, 5000 + i));
  }
  const ProgramRun out = run("compare " + write("base.json", file_of("", base)) + " " +
                             write("new.json", file_of("", now)) + " --quiet --summary " + file("out.md"));
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_LT(fs::file_size(file("out.md")), 64000U);
  EXPECT_THAT(convergence::read_text(file("out.md")), HasSubstr("none worse than these, are left out here"));
}

}  // namespace
}  // namespace slipstick::bench
