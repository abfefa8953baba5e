// Histories of loads as the program solves them: what goes out, where, and with which exit code.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "convergence/programs/tests/program_run.hpp"

namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class ProgramHistory : public testing::Test {
 protected:
  ~ProgramHistory() override { fs::remove_all(folder_); }

  fs::path file(const std::string& name) const { return folder_ / name; }

  struct Run {
    int exit_code;
    std::string output;  ///< standard output
    std::string errors;
  };
  /// `solve` of steel bodies on 24 x 24 cells, W = 1000 N, through the steps.
  Run solve(const std::string& steps, const std::string& options = "") const {
    const fs::path scene = file("scene.toml");
    std::ofstream(scene)
        << "name = \"history\"\n"
           "[upper]\nshape = \"sphere\"\nradius = 0.018\nyoung_modulus = 210e9\npoisson_ratio = 0.3\n"
           "[lower]\nyoung_modulus = 210e9\npoisson_ratio = 0.3\n"
           "[contact]\nfriction = 0.1\n[load]\nnormal = 1000.0\n[grid]\ncells = [24, 24]\n"
        << steps;
    const auto end = slipstick::run_command(std::string(SLIPSTICK_PROGRAM) + " solve " + scene.string() +
                                            " " + options + " 2>" + file("errors").string());
    Run run{end.exit_code, end.output, ""};
    std::getline(std::ifstream(file("errors")), run.errors, '\0');
    return run;
  }

  json read(const std::string& name) const { return json::parse(std::ifstream(file(name))); }

 private:
  fs::path folder_ = [] {
    fs::path folder = fs::path(testing::TempDir()) / ("slipstick-history-" + std::to_string(getpid()));
    fs::create_directories(folder);
    return folder;
  }();
};

std::string turning(const std::string& name, const std::string& ratio) {
  return "[[step]]\nname = \"" + name + "\"\nmoment_ratio = " + ratio + "\n";
}

const std::string kCycle = turning("out", "0.8") + turning("back", "-0.8") + turning("again", "0.8");

/// Paths of nulls without a reason beside them, and of texts that stand for numbers.
void collect_unexplained(const json& node, const std::string& path, std::vector<std::string>& found) {
  if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      if (node[i].is_null()) found.push_back(path + "[" + std::to_string(i) + "]");
      collect_unexplained(node[i], path + "[" + std::to_string(i) + "]", found);
    }
  }
  if (!node.is_object()) return;
  for (const auto& [key, value] : node.items()) {
    if (value.is_null() && !node.contains(key + "_reason")) found.push_back(path + "." + key);
    if (key.ends_with("_reason") && value.get<std::string>().empty()) found.push_back(path + "." + key);
    collect_unexplained(value, path + "." + key, found);
  }
}

/// A number that is not finite is written as null.
std::vector<std::string> unexplained(const json& result) {
  std::vector<std::string> found;
  collect_unexplained(result, "", found);
  return found;
}

TEST_F(ProgramHistory, HasALineAndAResultForEachStep) {
  const Run run = solve(kCycle, "--json " + file("r.json").string());
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const char* name : {"\n  out ", "\n  back ", "\n  again "}) EXPECT_THAT(run.output, HasSubstr(name));
  EXPECT_THAT(run.output, HasSubstr("3 steps"));
  const json result = read("r.json");
  ASSERT_EQ(result["steps"].size(), 3);
  EXPECT_EQ(result["history"]["steps"], 3);
  double dissipated = 0.0;
  double applications = 0.0;
  double gap = 0.0;
  for (const json& step : result["steps"]) {
    EXPECT_EQ(step["status"], "converged");
    EXPECT_EQ(step["cycle"], 1);
    dissipated += step["dissipated"].get<double>();
    applications += step["operator_applications"].get<double>();
    gap = std::max(gap, step["certificate"]["gap"].get<double>());
  }
  EXPECT_EQ(result["steps"][1]["name"], "back");
  EXPECT_DOUBLE_EQ(result["steps"][1]["moment_ratio"], -0.8);
  EXPECT_DOUBLE_EQ(result["history"]["dissipated"], dissipated);
  EXPECT_DOUBLE_EQ(result["history"]["operator_applications"], applications);
  EXPECT_EQ(result["history"]["worst_gap"], gap);
  for (const char* key : {"twist_angle", "moment", "dissipated", "twist_error", "stick_radius", "limit"}) {
    EXPECT_EQ(result[key], result["steps"][2][key]) << key;  // the whole is the last step's
  }
}

TEST_F(ProgramHistory, ShowsTheSizeOfTheForce) {
  const Run run =
      solve("[[step]]\nname = \"pull\"\nforce = [30.0, 40.0]\n[[step]]\nforce = [0.0, 0.0]\n", "");
  const std::string line = run.output.substr(run.output.find("\n  pull ") + 1);
  std::istringstream words(line);
  std::string name, normal, moment, force;
  words >> name >> normal >> moment >> force;
  EXPECT_EQ(force, "50") << line;
}

TEST_F(ProgramHistory, CyclesRepeatTheSteps) {
  const Run run = solve(kCycle, "--set cycles=2 --json -");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json result = json::parse(run.output);
  ASSERT_EQ(result["steps"].size(), 6);
  EXPECT_EQ(result["steps"][3]["cycle"], 2);
  EXPECT_EQ(result["steps"][3]["name"], "out");
}

TEST_F(ProgramHistory, KeepsTheStepsBeforeGrossSlip) {
  const Run run = solve(kCycle, "--set step[2].moment=0.05 --json " + file("r.json").string());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors, AllOf(HasSubstr("step[2].moment = 0.05"), HasSubstr("slips everywhere")));
  const json result = read("r.json");
  EXPECT_EQ(result["status"], "not_converged");
  EXPECT_THAT(result["message"].get<std::string>(), HasSubstr("step[2].moment = 0.05"));
  ASSERT_EQ(result["steps"].size(), 2);
  EXPECT_EQ(result["steps"][1]["name"], "back");
  EXPECT_EQ(result["history"]["steps"], 2);
  EXPECT_EQ(unexplained(result), std::vector<std::string>{});
}

TEST_F(ProgramHistory, NothingIsWrittenWhereTheFirstStepIsRefused) {
  EXPECT_EQ(solve(kCycle, "--set step[0].moment=0.05 --json " + file("r.json").string()).exit_code, 2);
  EXPECT_FALSE(fs::exists(file("r.json")));
}

/// The first step needs no iterations, the second one more than are allowed.
TEST_F(ProgramHistory, StopsAtAStepThatMissesItsTolerance) {
  const Run run = solve(turning("rest", "0.0") + turning("far", "0.9") + turning("back", "0.0"),
                        "--set solver.max_iterations=3 --json " + file("r.json").string());
  EXPECT_EQ(run.exit_code, 1) << run.errors;
  const json result = read("r.json");
  EXPECT_EQ(result["status"], "not_converged");
  ASSERT_EQ(result["steps"].size(), 2);
  EXPECT_EQ(result["steps"][0]["status"], "converged");
  EXPECT_EQ(result["steps"][1]["status"], "not_converged");
  EXPECT_THAT(result["steps"][1]["message"].get<std::string>(), HasSubstr("within 3 operator applications"));
  EXPECT_EQ(unexplained(result), std::vector<std::string>{});
}

TEST_F(ProgramHistory, FieldsOfEachStepOrOfTheLast) {
  ASSERT_EQ(solve(kCycle, "--quiet --fields " + file("f-{step}.csv").string()).exit_code, 0);
  ASSERT_EQ(solve(kCycle, "--quiet --fields " + file("last.csv").string()).exit_code, 0);
  const auto text = [&](const std::string& name) {
    std::string content;
    std::getline(std::ifstream(file(name)), content, '\0');
    return content;
  };
  for (const char* name : {"f-1.csv", "f-2.csv", "f-3.csv"}) EXPECT_FALSE(text(name).empty()) << name;
  EXPECT_FALSE(fs::exists(file("f-4.csv")));
  EXPECT_NE(text("f-2.csv"), text("f-3.csv"));
  EXPECT_EQ(text("last.csv"), text("f-3.csv"));
}

TEST_F(ProgramHistory, OverridesALoadOfOneStep) {
  const Run run = solve(kCycle, "--json - --set step[1].moment_ratio=-0.3");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const json result = json::parse(run.output);
  constexpr double kBalanced = 1e-13;  // loads are met to 1e-14 of what the cells carry
  EXPECT_NEAR(result["steps"][0]["moment_ratio"].get<double>(), 0.8, kBalanced);
  EXPECT_NEAR(result["steps"][1]["moment_ratio"].get<double>(), -0.3, kBalanced);
  const Run beyond = solve(kCycle, "--set step[3].moment_ratio=0.1");
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_THAT(beyond.errors, HasSubstr("step[3]"));
}

/// What stays after unloading is, by Masing's rule, the twist of first loading less twice that of half the
/// moment.
TEST_F(ProgramHistory, ExactModelAnswersTheLastStep) {
  const auto answer = [&](const std::string& steps) {
    const Run run = solve(steps, "--model exact --json -");
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return json::parse(run.output);
  };
  const json a = answer(turning("out", "0.8") + turning("rest", "0.0"));
  const double loaded = answer(turning("out", "0.8"))["twist_angle"];
  const double half = answer(turning("half", "0.4"))["twist_angle"];
  EXPECT_EQ(a["moment"].get<double>(), 0.0);
  EXPECT_NEAR(a["twist_angle"].get<double>() / (loaded - 2.0 * half), 1.0, 1e-13);
  EXPECT_EQ(unexplained(a), std::vector<std::string>{});
  const Run refused = solve(kCycle, "--model exact --set step[1].moment=-0.05");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, AllOf(HasSubstr("step[1].moment = -0.05"), HasSubstr("gross slip")));
}

/// The stick ratio alone is known where the shear has its part in the pressure.
TEST_F(ProgramHistory, ExactModelSaysWhatSpenceDoesNot) {
  const std::string steel_on_rubber =
      " --set lower.young_modulus=1e9 --set lower.poisson_ratio=0.0 --set contact.friction=0.3";
  const std::string steps = "[[step]]\nnormal = 500.0\n[[step]]\nnormal = 1000.0\n";
  for (const std::string coupling : {"pressure", "full"}) {
    const Run run =
        solve(steps, "--json - --model exact --set contact.coupling=" + coupling + steel_on_rubber);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const json result = json::parse(run.output);
    EXPECT_EQ(unexplained(result), std::vector<std::string>{});
    EXPECT_TRUE(result["stick_ratio"].is_number());
    EXPECT_EQ(result["contact_radius"].is_null(), coupling == "full");
    const Run text = solve(steps, "--model exact --fields " + file("f.csv").string() +
                                      " --set contact.coupling=" + coupling + steel_on_rubber);
    EXPECT_THAT(text.output, HasSubstr("stick ratio      0."));
    EXPECT_EQ(text.exit_code, 2);  // there are no tractions to write
    EXPECT_THAT(text.errors, AllOf(HasSubstr("solver.model = \"exact\""), HasSubstr("stick ratio alone")));
    EXPECT_FALSE(fs::exists(file("f.csv")));
    ASSERT_EQ(solve(steps, "--fields " + file("f.csv").string() + " --set contact.coupling=" + coupling +
                               steel_on_rubber)
                  .exit_code,
              0);
    std::string header;
    std::ifstream fields(file("f.csv"));
    std::getline(fields, header);
    EXPECT_THAT(header, Not(HasSubstr("q1_exact")));
    fs::remove(file("f.csv"));
  }
}

/// How far the loads are from the limit, and how the contact would slide: at 0.8 of the limit moment, 1/0.8,
/// about the axis.
TEST_F(ProgramHistory, SaysHowFarTheLimitIs) {
  const json torsion = json::parse(solve(kCycle, "--json -").output);
  for (const json& step : torsion["steps"]) {
    EXPECT_NEAR(step["limit"]["factor"].get<double>(), 1.25, 1e-9);
    for (const json& x : step["limit"]["centre"])
      EXPECT_NEAR(x.get<double>(), 0.0, 1e-9 * step["contact_radius"].get<double>());
  }
  // mu W = 100 N.
  const json force =
      json::parse(solve("[[step]]\nforce = [30.0, 40.0]\n[[step]]\nforce = [0.0, 0.0]\n", "--json -").output);
  EXPECT_NEAR(force["steps"][0]["limit"]["factor"].get<double>(), 2.0, 1e-6);
  EXPECT_FALSE(force["steps"][0]["limit"].contains("centre"));
  EXPECT_NEAR(force["steps"][0]["limit"]["direction"][0].get<double>(), 0.6, 1e-6);
  EXPECT_TRUE(force["steps"][1]["limit"]["factor"].is_null());
  EXPECT_EQ(unexplained(force), std::vector<std::string>{});
}

/// Histories of every kind: with and without an exact answer, at rest, without friction, in mixed loads.
TEST_F(ProgramHistory, EveryNumberIsFiniteOrHasAReason) {
  const std::string mixed =
      "[[step]]\nforce = [20.0, 0.0]\nmoment_ratio = 0.3\n[[step]]\nnormal = 800.0\n[[step]]\ntwist = 0.0\n"
      "[[step]]\ndisplacement = [0.0, 1e-7]\n[[step]]\nmoment_ratio = 0.0\nforce = [0.0, 0.0]\n";
  int written = 0;
  for (const std::string& steps : {kCycle, turning("rest", "0.0") + turning("on", "0.5"), mixed}) {
    for (const char* options : {"", "--set contact.friction=0", "--set lower.young_modulus=70e9",
                                "--set contact.pressure=hertz", "--set solver.max_iterations=2"}) {
      const Run run = solve(steps, std::string("--json ") + file("r.json").string() + " " + options);
      if (!fs::exists(file("r.json"))) {
        EXPECT_EQ(run.exit_code, 2) << options;
        continue;
      }
      EXPECT_EQ(unexplained(read("r.json")), std::vector<std::string>{}) << options << '\n' << steps;
      fs::remove(file("r.json"));
      ++written;
    }
  }
  EXPECT_GE(written, 10);  // mixed loads have no answer without friction
}

}  // namespace
