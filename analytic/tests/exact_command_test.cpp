#include "analytic/exact_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace slipstick::analytic {
namespace {

using std::numbers::pi;
using ::testing::AllOf;
using ::testing::HasSubstr;
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
  EXPECT_THAT([] { run("--twist 0.1 --profile cone"); },
              ThrowsMessage<CLI::ValidationError>(
                  AllOf(HasSubstr("--profile"), HasSubstr("cone"), HasSubstr("hertz"))));
}

}  // namespace
}  // namespace slipstick::analytic
