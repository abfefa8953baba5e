// The program as users run it: what goes out, where, and with which exit code.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "convergence/programs/tests/program_run.hpp"

namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string kScenes = SLIPSTICK_SCENES;
const std::string kSmall = " --set grid.cells=[24,24]";

using slipstick::ProgramRun;

ProgramRun run(const std::string& arguments) { return slipstick::run_program_with(arguments); }

std::string solve(const std::string& scene) { return "solve " + kScenes + "/" + scene + ".toml" + kSmall; }

fs::path temporary(const std::string& name) {
  const fs::path folder =
      fs::path(testing::TempDir()) / ("slipstick-program-test-" + std::to_string(getpid()));
  fs::create_directories(folder);
  return folder / name;
}

TEST(Program, EveryCommandHasHelpWithAnExample) {
  for (const char* command : {"bench", "check", "compare", "exact", "gate", "report", "solve", "study"}) {
    const ProgramRun help = run(std::string(command) + " --help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.output, AllOf(HasSubstr("Example"), HasSubstr("slipstick " + std::string(command)),
                                   HasSubstr("--json"), HasSubstr("--quiet")));
  }
}

TEST(Program, BadCommandLineIsExitCode2) {
  EXPECT_EQ(run("").exit_code, 2);
  EXPECT_EQ(run("frobnicate").exit_code, 2);
  EXPECT_EQ(run("solve").exit_code, 2);
  EXPECT_EQ(run("solve --no-such-option").exit_code, 2);
}

TEST(Program, NamesTheNearestCommand) {
  const ProgramRun misspelt = run("slove scene.toml");
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_THAT(misspelt.output, AllOf(HasSubstr("slove"), HasSubstr("the nearest is solve")));
}

TEST(Program, SolveWritesEveryKeyOfTheContract) {
  const ProgramRun out = run(solve("paper") + " --json -");
  ASSERT_EQ(out.exit_code, 0) << out.output;
  const json result = json::parse(out.output);
  for (const char* key : {"status",
                          "method",
                          "operator",
                          "model",
                          "cells",
                          "cell_size",
                          "contact_cells",
                          "stick_cells",
                          "contact_radius",
                          "stick_radius",
                          "stick_radius_counted",
                          "stick_ratio",
                          "twist_angle",
                          "moment",
                          "moment_limit",
                          "moment_ratio",
                          "twist",
                          "displacement",
                          "iterations",
                          "operator_applications",
                          "certificate",
                          "seconds",
                          "peak_bytes",
                          "predicted_bytes",
                          "provenance",
                          "twist_error",
                          "stick_radius_error",
                          "traction_error"}) {
    EXPECT_TRUE(result.contains(key)) << key;
  }
  for (const char* key : {"gap", "moment", "force", "friction_bound"})
    EXPECT_TRUE(result["certificate"][key].is_number());
  for (const char* key : {"setup", "pressure", "traction", "total"})
    EXPECT_TRUE(result["seconds"][key].is_number());
  for (const char* key : {"version", "commit", "compiler", "flags", "libraries", "cpu", "threads"}) {
    EXPECT_TRUE(result["provenance"].contains(key)) << key;
  }
  EXPECT_EQ(result["status"], "converged");
  EXPECT_DOUBLE_EQ(result["moment_ratio"], 0.9);
}

TEST(Program, EverySceneInTheRepositorySolves) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".toml") continue;
    const bool height_map = entry.path().stem() == "honed_surface";  // its grid is that of its samples
    const ProgramRun out = run("solve " + entry.path().string() + (height_map ? "" : kSmall));
    EXPECT_EQ(out.exit_code, 0) << entry.path() << out.output;
    ++scenes;
  }
  EXPECT_GE(scenes, 16);
}

TEST(Program, GrossSlipIsRefusedWithItsLimit) {
  const ProgramRun ratio = run(solve("paper") + " --set load.moment_ratio=1.0");
  EXPECT_EQ(ratio.exit_code, 2);
  EXPECT_THAT(ratio.output, AllOf(HasSubstr("load.moment_ratio"), HasSubstr("gross slip")));

  const ProgramRun moment = run(solve("paper") + " --set load.moment=0.05");
  EXPECT_EQ(moment.exit_code, 2);
  EXPECT_THAT(moment.output,
              AllOf(HasSubstr("load.moment = 0.05 N m"), HasSubstr("below 0.0287"), HasSubstr("paper.toml")));
}

TEST(Program, ASolveThatMissesItsToleranceIsExitCode1AndStillWritten) {
  const fs::path file = temporary("missed.json");
  const ProgramRun out = run(solve("paper") + " --set solver.max_iterations=3 --json " + file.string());
  EXPECT_EQ(out.exit_code, 1);
  EXPECT_THAT(out.output, HasSubstr("within 3 operator applications"));
  const json result = json::parse(std::ifstream(file));
  EXPECT_EQ(result["status"], "not_converged");
  EXPECT_GT(result["certificate"]["gap"], 1e-8);
}

TEST(Program, BadScenesAreExitCode2AndSayWhatIsAllowed) {
  const ProgramRun unknown = run(solve("paper") + " --set contact.fricton=0.2");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.output, AllOf(HasSubstr("contact.fricton"), HasSubstr("contact.friction")));
  const ProgramRun missing = run("solve no-such-scene.toml");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.output, HasSubstr("no-such-scene.toml"));
  EXPECT_EQ(run("exact --moment-ratio 1.5").exit_code, 2);
  EXPECT_EQ(run("exact --moment-ratio 0.5 --twist 0.1").exit_code, 2);
}

/// A link to a device that is full: that shows while writing, after the solve.
fs::path full_device(const std::string& name) {
  fs::path link = temporary(name);
  fs::remove(link);
  fs::create_symlink("/dev/full", link);
  return link;
}

TEST(Program, ResultIsNotLostWhenTheFieldsCannotBeWritten) {
  const fs::path file = temporary("kept.json");
  const fs::path full = full_device("full.csv");
  const ProgramRun out = run(solve("paper") + " --fields " + full.string() + " --json " + file.string());
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_THAT(out.output, HasSubstr(full.string()));
  EXPECT_EQ(json::parse(std::ifstream(file))["status"], "converged");
}

TEST(Program, WhatHasNoPlaceIsRefusedBeforeTheSolve) {
  const fs::path file = temporary("refused.json");
  for (const std::string option : {"--fields /no/such/folder/f.h5", "--figure /no/such/folder/f.svg"}) {
    const ProgramRun out = run(solve("paper") + " " + option + " --json " + file.string());
    EXPECT_EQ(out.exit_code, 2);
    EXPECT_THAT(out.output, HasSubstr(option.substr(option.find(' ') + 1)));
    EXPECT_FALSE(fs::exists(file)) << option;
  }
}

TEST(Program, FigureIsWrittenBesideTheResult) {
  if (std::string(SLIPSTICK_PYTHON).empty()) GTEST_SKIP() << "no Python was found";
  for (const std::string& scene : {solve("ellipse"), solve("cone") + " --model exact"}) {
    const fs::path figure = temporary("figure.svg");
    fs::remove(figure);
    const ProgramRun out = run(scene + " --figure " + figure.string());
    EXPECT_EQ(out.exit_code, 0) << out.output;
    EXPECT_GT(fs::file_size(figure), 10000U);
  }
}

TEST(Program, FigureOfAnUnknownKindIsRefusedBeforeTheSolve) {
  const fs::path file = temporary("refused.json");
  const ProgramRun out = run(solve("paper") + " --figure f.jpg --json " + file.string());
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_THAT(out.output, AllOf(HasSubstr("--figure"), HasSubstr("f.jpg"), HasSubstr(".svg, .pdf, .png")));
  EXPECT_FALSE(fs::exists(file));
}

TEST(Program, ResultIsNotLostWhenTheFigureCannotBeWritten) {
  const fs::path file = temporary("kept-without-figure.json");
  const fs::path full = full_device("full.svg");
  const ProgramRun out = run(solve("paper") + " --figure " + full.string() + " --json " + file.string());
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_THAT(out.output, AllOf(HasSubstr("moment"), HasSubstr("the result is complete, but")));
  EXPECT_EQ(json::parse(std::ifstream(file))["status"], "converged");
}

TEST(Program, SolvesExactlyWithTheNumbersOfExact) {
  const ProgramRun solved = run(solve("cone") + " --model exact --json -");
  ASSERT_EQ(solved.exit_code, 0) << solved.output;
  // 210 GPa and nu = 0.3 on both sides.
  const ProgramRun exact =
      run("exact --profile cone --moment-ratio 0.5 --normal-load 200 --shape 0.01 --friction 0.1 "
          "--effective-modulus 115384615384.61538 --shear-modulus 40384615384.615385 --json -");
  ASSERT_EQ(exact.exit_code, 0) << exact.output;
  const json result = json::parse(solved.output);
  const json units = json::parse(exact.output)["units"];
  EXPECT_EQ(result["method"], "exact");
  EXPECT_EQ(result["twist"], json::parse(exact.output)["twist"]);
  for (const char* key :
       {"contact_radius", "approach", "stick_radius", "moment_limit", "moment", "twist_angle"}) {
    EXPECT_NEAR(result[key].get<double>() / units[key].get<double>(), 1.0, 1e-14) << key;
  }
  EXPECT_EQ(run(solve("cone") + " --set solver.model=exact --quiet").output, "");
  EXPECT_THAT(run(solve("cone") + " --model exact").output, HasSubstr("exact solution"));
  EXPECT_THAT(run(solve("cone") + " --set solver.model=exact --model auto").output,
              HasSubstr("24 x 24 cells"));
}

TEST(Program, ExactModelRefusesWithExitCode2) {
  const ProgramRun ellipse = run(solve("ellipse") + " --model exact");
  EXPECT_EQ(ellipse.exit_code, 2);
  EXPECT_THAT(ellipse.output, AllOf(HasSubstr("ellipse.toml"), HasSubstr("solver.model = \"exact\""),
                                    HasSubstr("auto, full"), HasSubstr("ellipsoid")));
  const ProgramRun gross_slip = run(solve("paper") + " --model exact --set load.moment=0.05");
  EXPECT_EQ(gross_slip.exit_code, 2);
  EXPECT_THAT(gross_slip.output, AllOf(HasSubstr("load.moment = 0.05 N m"), HasSubstr("gross slip"),
                                       HasSubstr("M_lim = 0.02881")));
  const ProgramRun unknown = run(solve("paper") + " --model best");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.output, AllOf(HasSubstr("solver.model"), HasSubstr("auto, full, exact")));
}

TEST(Program, ExactFieldsHaveNoSlip) {
  const fs::path file = temporary("exact.csv");
  ASSERT_EQ(run(solve("flat_punch") + " --model exact --fields " + file.string()).exit_code, 0);
  std::ifstream stream(file);
  std::string header;
  std::getline(stream, header);
  EXPECT_EQ(header, "x1,x2,pressure,q1,q2,stick");
}

// A result on a grid has no error where the exact value is infinite, and says so.
TEST(Program, ErrorsBesideAnInfinitePeakAreNull) {
  const ProgramRun out = run(solve("cone") + " --json -");
  ASSERT_EQ(out.exit_code, 0) << out.output;
  const json result = json::parse(out.output);
  EXPECT_TRUE(result["twist_error"].is_number());
  EXPECT_TRUE(result["exact"]["twist"].is_number());
  EXPECT_TRUE(result["peak_pressure"].is_number());
  for (const json& null : {result["peak_pressure_error"], result["exact"]["peak_pressure"]}) {
    EXPECT_TRUE(null.is_null());
  }
  EXPECT_THAT(result["peak_pressure_error_reason"].get<std::string>(), HasSubstr("no finite peak"));
}

// The page redoes figures of a sphere.
TEST(Program, ReportIsForASphere) {
  const ProgramRun out = run("report " + kScenes + "/cone.toml --output " + temporary("page").string());
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_THAT(out.output, AllOf(HasSubstr("upper.shape = \"cone\""), HasSubstr("sphere")));
}

TEST(Program, QuietPrintsNothing) { EXPECT_EQ(run(solve("paper") + " --quiet").output, ""); }

TEST(Program, FieldsHoldTheColumnsOfTheContract) {
  const fs::path file = temporary("fields.csv");
  ASSERT_EQ(run(solve("paper") + " --fields " + file.string()).exit_code, 0);
  std::ifstream stream(file);
  std::string header;
  std::getline(stream, header);
  EXPECT_THAT(header, testing::StartsWith("x1,x2,pressure,q1,q2,slip1,slip2,stick"));
}

// A run that wrote its pressure can be given it back.
TEST(Program, PressureFromAFileGivesTheSameAnswer) {
  const fs::path fields = temporary("pressure.h5");
  const std::string extent = " --set grid.extent=[1.1e-3,1.1e-3]";
  const ProgramRun first = run(solve("paper") + extent + " --json - --fields " + fields.string());
  ASSERT_EQ(first.exit_code, 0) << first.output;
  const ProgramRun second =
      run(solve("paper") + extent +
          " --json - --set contact.pressure=file --set contact.pressure_file=" + fields.string());
  ASSERT_EQ(second.exit_code, 0) << second.output;
  const double twist = json::parse(first.output)["twist_angle"];
  EXPECT_NEAR(json::parse(second.output)["twist_angle"].get<double>() / twist, 1.0, 1e-12);
}

std::string check(const std::string& field) {
  return "check " + kScenes + "/paper.toml " + SLIPSTICK_FIELDS + "/" + field;
}

TEST(Program, CheckTellsAGoodFieldFromABadOne) {
  const ProgramRun good = run(check("contact-64-0.9.csv --twist 2.361048651456917e-3"));
  EXPECT_EQ(good.exit_code, 0) << good.output;
  EXPECT_THAT(good.output, testing::StartsWith("good: the moment is right"));
  const ProgramRun bad = run(check("cgcontact-64-0.9.csv --twist 2.21775472e-3"));
  EXPECT_EQ(bad.exit_code, 1) << bad.output;
  EXPECT_THAT(bad.output, AllOf(testing::StartsWith("bad: the moment is right"), HasSubstr("6.1 % too low"),
                                HasSubstr("FAILS")));
}

// The exact answer, sampled, is right within its mesh; it solves no grid's own problem.
TEST(Program, CheckAsksForMoreWhereItIsTold) {
  const std::string scene = kScenes + "/paper.toml --set grid.cells=[48,48]";
  const fs::path fields = temporary("sampled.csv");
  ASSERT_EQ(run("solve " + scene + " --set solver.model=exact --fields " + fields.string()).exit_code, 0);
  const std::string sampled = "check " + scene + " " + fields.string();
  EXPECT_EQ(run(sampled).exit_code, 0);
  EXPECT_EQ(run(sampled + " --strict").exit_code, 0);
  EXPECT_EQ(run(sampled + " --discrete").exit_code, 1);
  EXPECT_EQ(run(sampled + " --tolerance 0.02").exit_code, 0);
  EXPECT_EQ(run(sampled + " --tolerance 1e-6").exit_code, 1);
  EXPECT_EQ(run(sampled + " --tolerance 0").exit_code, 2);
  EXPECT_EQ(run(check("contact-64-0.9.csv --discrete --strict")).exit_code, 0);
}

TEST(Program, CheckWritesEveryKeyOfTheContract) {
  const ProgramRun out = run(check("cgcontact-64-0.9.csv --json -"));
  ASSERT_EQ(out.exit_code, 1) << out.output;
  const json result = json::parse(out.output);
  for (const char* key : {"twist_error", "moment_error", "stick_radius_error"}) {
    EXPECT_TRUE(result[key].is_number()) << key;
  }
  for (const char* key : {"l1", "l2", "max"}) EXPECT_TRUE(result["traction_error"][key].is_number()) << key;
  for (const char* key : {"gap", "moment", "force", "friction_bound"}) {
    EXPECT_TRUE(result["certificate"][key].is_number()) << key;
  }
  for (const char* key : {"mean", "max"}) EXPECT_TRUE(result["slip_direction"][key].is_number()) << key;
  EXPECT_EQ(result["verdict"], "bad");
  EXPECT_FALSE(result["why"].get<std::string>().empty());
}

// Whatever reads a file: none is waited for, and none is read for ever.
TEST(Program, FilesWithoutAnEndAreExitCode2) {
  const fs::path map = temporary("map.toml");
  std::ofstream(map) << "[upper]\nshape = \"height_map\"\nfile = \"/dev/zero\"\nspacing = [1e-5, 1e-5]\n"
                        "young_modulus = 1e11\npoisson_ratio = 0.3\n[lower]\nrigid = true\n[contact]\n"
                        "friction = 0.1\n[load]\nnormal = 1.0\nmoment_ratio = 0.5\n";
  const fs::path study = temporary("study.toml");
  std::ofstream(study) << "scene = \"map.toml\"\ntolerances = [1e-3, 1e-5]\n";
  const fs::path gates = temporary("gates.toml");
  std::ofstream(gates) << "[[gate]]\nid = \"a\"\nresult = \"/dev/zero\"\nquantity = \"twist\"\nbelow = 1.0\n"
                          "basis = \"b\"\n";
  const std::string paper = kScenes + "/paper.toml";
  for (const std::string& arguments :
       {"check " + paper + " /dev/zero", std::string("solve /dev/zero"), "solve " + map.string(),
        solve("paper") + " --set grid.extent=[1.1e-3,1.1e-3] --set contact.pressure=file"
                         " --set contact.pressure_file=/dev/zero",
        std::string("study /dev/zero"), "study " + study.string() + " --output " + temporary("runs").string(),
        std::string("gate /dev/zero"), "gate " + gates.string(), std::string("compare /dev/zero /dev/zero"),
        std::string("exact --profile file:/dev/zero --moment-ratio 0.5")}) {
    const ProgramRun out = run(arguments);
    EXPECT_EQ(out.exit_code, 2) << arguments;
    EXPECT_THAT(out.output, AllOf(HasSubstr("/dev/zero: cannot be read"), HasSubstr("allowed"))) << arguments;
  }
}

// Names of files need not be UTF-8, and JSON is.
TEST(Program, WritesJsonOfFilesWithAnyName) {
  const fs::path field = temporary("caf\xe9.csv");
  fs::copy_file(std::string(SLIPSTICK_FIELDS) + "/contact-64-0.9.csv", field,
                fs::copy_options::overwrite_existing);
  const ProgramRun out = run("check " + kScenes + "/paper.toml '" + field.string() + "' --json -");
  EXPECT_EQ(out.exit_code, 0) << out.output;
  EXPECT_TRUE(json::accept(out.output)) << out.output;
}

TEST(Program, CheckOfWhatCannotBeJudgedIsExitCode2) {
  const ProgramRun missing = run(check("no-such-field.csv"));
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.output, HasSubstr("no-such-field.csv"));
  const fs::path file = temporary("nan.csv");
  std::ofstream(file) << "x1,x2,pressure,q1,q2\n0,0,1,nan,0\n";
  const ProgramRun nan = run("check " + kScenes + "/paper.toml " + file.string());
  EXPECT_EQ(nan.exit_code, 2);
  EXPECT_THAT(nan.output, AllOf(HasSubstr("nan.csv:2"), HasSubstr("a finite number")));
  std::ofstream(file) << "x1,x2,p,q1,q2\n0,0,1,0,0\n";
  EXPECT_THAT(run("check " + kScenes + "/paper.toml " + file.string()).output,
              HasSubstr("no column pressure; its columns: x1, x2, p, q1, q2"));
}

TEST(Program, ExactWritesEveryKeyOfTheContract) {
  const ProgramRun out = run("exact --stick-ratio 0.5 --radius 0.25,0.75 --json -");
  ASSERT_EQ(out.exit_code, 0) << out.output;
  const json result = json::parse(out.output);
  for (const char* key : {"moment_ratio", "moment_deficit", "stick_ratio", "stick_complement", "twist",
                          "moment", "tangent_stiffness", "traction", "printed"}) {
    EXPECT_TRUE(result.contains(key)) << key;
  }
  ASSERT_EQ(result["traction"].size(), 2);
  EXPECT_DOUBLE_EQ(result["traction"][1]["value"], std::sqrt(1.0 - 0.75 * 0.75));  // slip: mu p
  EXPECT_DOUBLE_EQ(result["tangent_stiffness"], 16.0 / 3.0 * 0.125);
}

}  // namespace
