#include "analytic/exact_command.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "analytic/certified/certified.hpp"
#include "analytic/indentation.hpp"

namespace slipstick::analytic {
namespace {

using std::numbers::pi;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

std::pair<std::string, nlohmann::ordered_json> run(const std::string& arguments) {
  CLI::App app;
  const auto command = add_exact_command(app);
  app.parse("exact " + arguments);
  std::ostringstream text;
  nlohmann::ordered_json json;
  EXPECT_EQ(command(text, json), 0);
  return {text.str(), json};
}

TEST(ExactCommand, GivesTheStateAndTheTractions) {
  const auto [text, json] = run("--moment-ratio 0.5 --radius 0,0.5,0.9");
  EXPECT_EQ(json.at("moment_ratio"), 0.5);
  EXPECT_EQ(json.at("moment_deficit"), 0.5);
  EXPECT_NEAR(json.at("stick_ratio").get<double>(), 0.8135681261276496, 1e-15);
  EXPECT_NEAR(json.at("stick_complement").get<double>(), 1 - 0.8135681261276496, 1e-15);
  EXPECT_NEAR(json.at("moment").get<double>(), 3 * pi / 32, 1e-15);
  EXPECT_TRUE(json.at("twist").is_number());
  EXPECT_TRUE(json.at("tangent_stiffness").is_number());
  ASSERT_EQ(json.at("traction").size(), 3U);
  EXPECT_EQ(json.at("traction")[0].at("value"), 0);
  EXPECT_EQ(json.at("traction")[2].at("radius"), 0.9);
  EXPECT_NEAR(json.at("traction")[2].at("value").get<double>(), std::sqrt(0.19), 1e-15);
  EXPECT_THAT(text, AllOf(HasSubstr("M/M_lim"), HasSubstr("0.81356812612"), HasSubstr("Eq. (7)")));
}

TEST(ExactCommand, SetsThePrintedEquationsBeside) {
  const auto [text, json] = run("--moment-ratio 0.5 --radius 0.5,0.9");
  const auto& printed = json.at("printed");
  const auto exact = json.at("traction")[0].at("value").get<double>();
  EXPECT_NEAR(printed.at("equation_1")[0].at("value").get<double>() / exact, pi / 2, 1e-12);
  EXPECT_EQ(printed.at("equation_1")[1].at("radius"), 0.9);
  EXPECT_NEAR(printed.at("equation_5").get<double>(), 3 * pi / 32, 1e-13);
  EXPECT_LT(printed.at("equation_7").get<double>(), json.at("twist").get<double>());
}

TEST(ExactCommand, GivesAReasonForEachMissingNumber) {
  const auto [text, json] = run("--stick-ratio 1 --radius 0.5");
  const auto& printed = json.at("printed");
  EXPECT_TRUE(printed.at("equation_5").is_null());
  EXPECT_THAT(printed.at("equation_5_reason").get<std::string>(), HasSubstr("a_s/a = 1"));
  EXPECT_TRUE(printed.at("equation_1")[0].at("value").is_null());
  EXPECT_TRUE(printed.at("equation_1")[0].contains("value_reason"));
  EXPECT_EQ(printed.at("equation_7"), 0);
}

TEST(ExactCommand, TakesEveryArgument) {
  for (const std::string arguments : {"--moment-deficit 1e-9", "--stick-ratio 0.3", "--stick-complement 1e-9",
                                      "--twist 0.4", "--moment-ratio 0"})
    EXPECT_FALSE(run(arguments).first.empty()) << arguments;
}

TEST(ExactCommand, AnswersThroughoutTheRange) {
  for (const std::string value :
       {"1e-300", "1e-20", "1e-12", "1e-8", "1e-6", "1e-4", "1e-2", "0.5", "0.999999"}) {
    EXPECT_NO_THROW(run("--moment-deficit " + value + " --radius 0,1e-9,0.3,1")) << value;
    EXPECT_NO_THROW(run("--moment-ratio " + value + " --radius 0,1e-9,0.3,1")) << value;
  }
}

TEST(ExactCommand, WantsExactlyOneArgument) {
  EXPECT_THROW(run("--radius 0.5"), CLI::ParseError);
  EXPECT_THROW(run("--twist 0.1 --moment-ratio 0.1"), CLI::ParseError);
}

TEST(ExactCommand, NamesOptionValueAndRange) {
  EXPECT_THAT(
      [] { run("--moment-ratio 1.2"); },
      ThrowsMessage<std::domain_error>(AllOf(HasSubstr("--moment-ratio"), HasSubstr("1.2"),
                                             HasSubstr("gross slip"), HasSubstr("0 <= M/M_lim < 1"))));
  EXPECT_THAT([] { run("--twist 0.1 --radius 0.5,1.5"); },
              ThrowsMessage<std::domain_error>(
                  AllOf(HasSubstr("--radius"), HasSubstr("1.5"), HasSubstr("0 <= r/a <= 1"))));
  EXPECT_THAT([] { run("--twist 0.1 --profile disc"); },
              ThrowsMessage<std::domain_error>(
                  AllOf(HasSubstr("--profile"), HasSubstr("disc"), HasSubstr("hertz, cone, flat_punch"))));
  EXPECT_THAT([] { run("--twist 0.1x"); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("--twist"), HasSubstr("0.1x"))));
  EXPECT_THAT([] { run("--history 0.5,-1.5"); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("--history"), HasSubstr("-1.5"))));
  EXPECT_THAT([] { run("--twist 0.1 --profile file:"); },
              ThrowsMessage<std::domain_error>(HasSubstr("file:P.csv")));
  EXPECT_THAT([] { run("--twist 0.1 --profile power:x"); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("--profile"), HasSubstr("\"x\""))));
}

TEST(ExactProfiles, StickFullyUnderAFlatPunch) {
  const auto [text, json] = run("--moment-ratio 0.8 --profile flat_punch --radius 0.6,1");
  EXPECT_EQ(json.at("stick_ratio"), 1);
  EXPECT_NEAR(json.at("twist").get<double>(), 3.0 / 16 * 0.8 * pi / 4, 1e-15);
  EXPECT_NEAR(json.at("profile").at("full_stick").get<double>(), 8 / (3 * pi), 1e-15);
  // A bonded punch: q = 3 M r/(4 pi a^2 sqrt(a^2 - r^2)), with W = 2 pi p0 a^2.
  EXPECT_NEAR(json.at("traction")[0].at("value").get<double>(), 3.0 / 2 * 0.8 * pi / 4 * 0.6 / 0.8, 1e-15);
  EXPECT_TRUE(json.at("traction")[1].at("value").is_null());
  EXPECT_THAT(json.at("traction")[1].at("value_reason").get<std::string>(), HasSubstr("infinite"));
  EXPECT_FALSE(json.contains("printed"));
  EXPECT_THAT(text, HasSubstr("Everything sticks up to"));
}

TEST(ExactProfiles, AgreeWhereOneIsAnother) {
  const std::string state = "--moment-ratio 0.6 --radius 0.3";
  const auto sphere = run(state).second;
  const auto cone = run(state + " --profile cone").second;
  for (const auto& [one, other] : {std::pair{sphere, run(state + " --profile power:2").second},
                                   std::pair{cone, run(state + " --profile power:1").second}}) {
    for (const std::string key : {"stick_ratio", "twist", "moment", "energy_lost_per_cycle"})
      EXPECT_NEAR(one.at(key).get<double>() / other.at(key).get<double>(), 1, 1e-14) << key;
    EXPECT_NEAR(
        one.at("traction")[0].at("value").get<double>() / other.at("traction")[0].at("value").get<double>(),
        1, 1e-14);
  }
}

/// Hertz's pressure in a file, closer and closer towards the edge.
std::string hertz_table(int points) {
  const std::string file = ::testing::TempDir() + fmt::format("hertz_pressure_{}.csv", points);
  std::ofstream table(file);
  table << "radius,pressure\n";
  for (int i = 0; i < points; ++i) {
    const double angle = pi / 2 * i / (points - 1);
    table << fmt::format("{},{}\n", 3e-3 * std::sin(angle), i == points - 1 ? 0.0 : 5e8 * std::cos(angle));
  }
  return file;
}

TEST(ExactProfiles, ComeFromAFileWithAnErrorEstimate) {
  const std::string file = hertz_table(201);
  const auto exact = run("--moment-ratio 0.6 --radius 0.3").second;
  const auto [text, table] = run("--moment-ratio 0.6 --radius 0.3 --profile file:" + file);
  const auto& estimate = table.at("error_estimate");
  for (const std::string key : {"stick_ratio", "twist", "moment"}) {
    const double error = std::abs(table.at(key).get<double>() - exact.at(key).get<double>());
    EXPECT_LE(error, estimate.at(key).get<double>()) << key;
    EXPECT_LE(estimate.at(key).get<double>(), 1e-4) << key;
  }
  EXPECT_LE(std::abs(table.at("profile").at("moment_limit").get<double>() - 3 * pi / 16),
            estimate.at("moment_limit").get<double>());
  EXPECT_LE(std::abs(table.at("table").at("mean_pressure").get<double>() - 5e8 * 2 / 3),
            estimate.at("mean_pressure").get<double>());
  EXPECT_EQ(estimate.at("traction")[0].at("radius"), 0.3);
  EXPECT_LE(std::abs(table.at("pressure")[0].at("value").get<double>() - 1.5 * std::sqrt(1 - 0.09)),
            estimate.at("pressure")[0].at("value").get<double>());
  EXPECT_EQ(table.at("table").at("contact_radius"), 3e-3);
  EXPECT_THAT(text, AllOf(HasSubstr("+/-"), HasSubstr("an estimate, no proof")));
  EXPECT_THAT([] { run("--twist 0.1 --profile file:nowhere.csv"); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("--profile"), HasSubstr("nowhere.csv"))));
}

TEST(ExactProfiles, AreRefusedFromTooFewPoints) {
  const std::string file = hertz_table(9);
  EXPECT_THAT([&] { run("--moment-ratio 0.1 --profile file:" + file); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("--profile"), HasSubstr(file),
                                                     HasSubstr("9 points; allowed: at least 16"))));
}

TEST(ExactProfiles, SayWhereATableHasNoErrorEstimate) {
  const auto [text, history] = run("--history 0.6,-0.6 --profile file:" + hertz_table(17));
  EXPECT_FALSE(history.contains("error_estimate"));
  EXPECT_THAT(text, AllOf(HasSubstr("No number has an estimate of its error"), Not(HasSubstr("+/-"))));
}

TEST(ExactCycles, UnloadByMasing) {
  const auto up = run("--moment-ratio 0.7 --radius 0.2,0.9").second;
  const auto back = run("--moment-ratio 0.7 --radius 0.2,0.9 --unload-to=-0.7").second.at("unloaded");
  EXPECT_NEAR(back.at("twist").get<double>() / up.at("twist").get<double>(), -1, 1e-14);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(
        back.at("traction")[i].at("value").get<double>() / up.at("traction")[i].at("value").get<double>(), -1,
        1e-14);
  // Half a loop and the quarter of the first loading.
  EXPECT_NEAR(back.at("dissipated").get<double>() / up.at("energy_lost_per_cycle").get<double>(), 0.75,
              1e-13);
  const auto none = run("--moment-ratio 0.7 --unload-to 0.7").second;
  EXPECT_NEAR(none.at("unloaded").at("twist").get<double>() / none.at("twist").get<double>(), 1, 1e-15);
}

TEST(ExactCycles, GiveTheCurveOfAHistory) {
  const auto json = run("--history 0.8,-0.8,0.2,-0.1,0.2,0.8 --points 7 --radius 0.5").second;
  ASSERT_EQ(json.at("history").size(), 6U);
  EXPECT_EQ(json.at("curve").size(), 1U + 6 * 7);
  EXPECT_EQ(json.at("curve")[0].at("twist"), 0);
  for (const std::string key : {"moment_ratio", "twist", "stick_ratio"})
    EXPECT_EQ(json.at("history")[5].at(key), json.at("history")[0].at(key)) << "the loop closes: " << key;
  EXPECT_EQ(json.at("history")[5].at("traction"), json.at("history")[0].at("traction"));
  EXPECT_THROW(run("--history 0.5 --moment-ratio 0.1"), CLI::ParseError);
  EXPECT_THROW(run("--moment-ratio 0.1 --points 4"), CLI::ParseError);
}

TEST(ExactUnits, AreHertzs) {
  const auto json = run("--moment-ratio 0.5 --normal-load 1000 --effective-modulus 1.154e11 --shape 0.018 "
                        "--friction 0.1 --shear-modulus 4.04e10")
                        .second;
  const auto& units = json.at("units");
  const double a = std::cbrt(3 * 1000 * 0.018 / (4 * 1.154e11));
  EXPECT_NEAR(units.at("contact_radius").get<double>() / a, 1, 1e-14);
  EXPECT_NEAR(units.at("approach").get<double>() / (a * a / 0.018), 1, 1e-14);
  EXPECT_NEAR(units.at("reference_pressure").get<double>() / (1500 / (pi * a * a)), 1, 1e-14);
  EXPECT_NEAR(units.at("moment").get<double>() / (0.5 * 3 * pi / 16 * 0.1 * 1000 * a), 1, 1e-14);
  EXPECT_NEAR(
      units.at("twist_angle").get<double>() / (json.at("twist").get<double>() * 100 / (4.04e10 * a * a)), 1,
      1e-14);
}

TEST(ExactUnits, FindTheFlatRatioOfARoundedPunch) {
  const auto json =
      run("--moment-ratio 0.5 --profile rounded_punch --normal-load 1000 --effective-modulus 1.154e11 "
          "--shape 4e-4,0.018")
          .second;
  EXPECT_EQ(json.at("units").at("contact_radius"),
            indent_rounded_punch(1000, 4e-4, 0.018, 1.154e11).contact.contact_radius);
  EXPECT_FALSE(json.at("units").contains("moment"));  // needs the friction coefficient
  EXPECT_THAT([] { run("--twist 0.1 --normal-load 1 --effective-modulus 1 --shape 1,2"); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("--shape"), HasSubstr("sphere radius"))));
  EXPECT_THROW(run("--twist 0.1 --normal-load 1"), CLI::ParseError);
  EXPECT_THROW(run("--twist 0.1 --normal-load 1 --effective-modulus 1 --shape 1 --shear-modulus 1"),
               CLI::ParseError);
}

TEST(ExactCertified, GivesDecimalsOrSaysWhatToInstall) {
  const std::string arguments = "--moment-ratio 0.5 --radius 0.3 --certified 30";
  if (!certified::available()) {
    EXPECT_THAT([&] { run(arguments); }, ThrowsMessage<std::runtime_error>(HasSubstr("libflint-dev")));
    return;
  }
  const auto [text, json] = run(arguments);
  const auto number = json.at("stick_ratio");
  EXPECT_EQ(number.at("value").get<std::string>().substr(0, 16), "0.81356812612764");
  EXPECT_EQ(number.at("value").get<std::string>().size(), 32U);
  EXPECT_LE(std::stod(number.at("radius").get<std::string>()), 0.51e-30);
  EXPECT_EQ(json.at("traction")[0].at("radius"), "0.3");
  EXPECT_TRUE(json.at("traction")[0].at("value").contains("radius"));
  EXPECT_THAT(text, HasSubstr("+/-"));
  EXPECT_THAT([] { run("--twist 0.1 --certified 20 --profile rounded_punch:0.5"); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("rounded_punch:0.5"), HasSubstr("allowed"))));
}

TEST(ExactCertified, HasADigitsRangeAndNoHistories) {
  EXPECT_THROW(run("--moment-ratio 0.5 --certified 14"), CLI::ParseError);
  EXPECT_THROW(run("--moment-ratio 0.5 --certified 101"), CLI::ParseError);
  EXPECT_THROW(run("--history 0.5 --certified 20"), CLI::ParseError);
  EXPECT_THROW(run("--moment-ratio 0.5 --unload-to 0.1 --certified 20"), CLI::ParseError);
}

}  // namespace
}  // namespace slipstick::analytic
