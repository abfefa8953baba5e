#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "convergence/hard/hard_case.hpp"
#include "convergence/hard/hard_run.hpp"
#include "convergence/runs/variant.hpp"
#include "convergence/system/run_program.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using namespace testing;

class HardFile : public ScratchFolder {
 protected:
  fs::path write(const std::string& families) const {
    return ScratchFolder::write("families.toml", families);
  }
  static std::string family(const std::string& rest) {
    return "[[family]]\nname = 'small'\nwhy = 'made up'\nscene = '" SLIPSTICK_SCENES "/paper.toml'\n" + rest;
  }
  /// What `hard` says of such families.
  Json run(const std::string& families, int code, std::vector<std::string> options = {}) const {
    std::vector<std::string> words{SLIPSTICK_PROGRAM, "hard", write(families), "--output", folder_ / "kept",
                                   "--json",          "-",    "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramEnd end = run_program(words, {.captured = Captured::output});
    EXPECT_EQ(end.code, code);
    return Json::parse(end.output);
  }
};

TEST_F(HardFile, VariesItsKeysInAllCombinations) {
  const auto cases = read_hard_cases(write(family(
      "[family.set]\n\"grid.cells\" = [8, 8]\n"
      "[[family.vary]]\nkey = 'contact.friction'\nvalues = [0.1, 0.2]\n"
      "[[family.vary]]\nkey = 'solver.method'\nvalues = ['coulomb', 'paper', 'projected_gradient']\n")));
  ASSERT_EQ(cases.size(), 6U);
  std::set<std::string> names;
  for (const HardCase& made : cases) names.insert(made.name);
  EXPECT_EQ(names.size(), 6U);
  EXPECT_THAT(cases[1].run.overrides,
              ElementsAre(HasSubstr("grid.cells"), HasSubstr("contact.friction=0.1"), HasSubstr("paper")));
}

TEST_F(HardFile, NamesWhatIsWrong) {
  const auto refused = [&](const std::string& text, const auto& message) {
    const fs::path file = write(text);
    EXPECT_THAT([&] { read_hard_cases(file); }, ThrowsMessage<solver::InputError>(message)) << text;
  };
  refused("", AllOf(HasSubstr("families.toml"), HasSubstr("[[family]]")));
  refused("[[family]]\nname = 'a'\n", HasSubstr("why"));
  refused(family("[[family.vary]]\nkey = 'a'\nvalues = []\n"), HasSubstr("values"));
  refused(family("speed = 3\n"), HasSubstr("speed"));
}

// A mirror twice and the other side twice are the first view; so are four quarter turns, but for a full
// angle.
TEST(Variant, ComesBack) {
  for (const char* name : {"turned_ellipse", "torsion_and_force", "off_centre", "imposed_displacement"}) {
    const solver::Scene scene = example(name);
    for (const auto& [variant, times] :
         {std::pair{Variant::mirrored, 2}, {Variant::exchanged, 2}, {Variant::turned, 4}}) {
      solver::Scene seen = scene;
      for (int i = 0; i < times; ++i) seen = seen_as(seen, variant);
      const double angle = seen.surfaces[0].angle - scene.surfaces[0].angle;
      EXPECT_NEAR(std::remainder(angle, 2.0 * std::numbers::pi), 0.0, 1e-14) << name;
      EXPECT_EQ(seen.surfaces[0].at, scene.surfaces[0].at) << name;
      EXPECT_EQ(seen.steps[0].force, scene.steps[0].force) << name;
      EXPECT_EQ(seen.steps[0].displacement, scene.steps[0].displacement) << name;
      EXPECT_EQ(seen.cells, scene.cells) << name;
      EXPECT_EQ(seen.upper.young_modulus, scene.upper.young_modulus) << name;
    }
  }
}

TEST(Variant, ShiftsByWholeCellsOfTheSameSize) {
  solver::Scene scene = example("paper");
  scene.cells = {64, 48};
  scene.extent = {1.0e-3, 2.4e-3};
  const solver::Scene seen = seen_as(scene, Variant::shifted);
  for (std::size_t i = 0; i < 2; ++i) {
    const double cell = (*scene.extent)[i] / static_cast<double>(scene.cells[i]);
    EXPECT_NEAR((*seen.extent)[i] / static_cast<double>(seen.cells[i]) / cell, 1.0, 1e-14);
    const double cells = (seen.surfaces[0].at[i] - scene.surfaces[0].at[i]) / cell;
    EXPECT_NEAR(cells, std::round(cells), 1e-12);
    EXPECT_GT(std::abs(cells), 0.5);
  }
}

TEST(Variant, IsRefusedWhereItWouldBeAnotherContact) {
  EXPECT_NE(why_not(example("rough_sphere"), Variant::turned), "");
  EXPECT_EQ(why_not(example("rough_sphere"), Variant::exchanged), "");
  EXPECT_NE(why_not(example("mindlin"), Variant::shifted), "");
  EXPECT_EQ(why_not(example("paper"), Variant::shifted), "");
  EXPECT_THROW(seen_as(example("paper"), Variant::shifted), std::invalid_argument);  // without its extent
  EXPECT_THROW(variant_of("upside_down"), std::invalid_argument);
}

Json made_result(double error, double uncertainty, double gap = 1e-9) {
  return {{"status", "converged"},
          {"method", "coulomb"},
          {"tolerance", 1e-8},
          {"twist_error", error},
          {"resolved", {{"uncertainty", uncertainty}}},
          {"certificate",
           {{"gap", gap}, {"rounding", 1e-14}, {"moment", 1e-15}, {"force", 0.0}, {"friction_bound", -1.0}}}};
}

TEST(HardJudgement, BelievesAnAnswerWithinWhatItSays) {
  EXPECT_EQ(judge_alone(made_result(0.009, 0.01)).verdict, HardVerdict::certified);
  EXPECT_EQ(judge_alone(made_result(-0.009, 0.01)).verdict, HardVerdict::certified);
  for (const double error : {0.011, -0.011}) {
    const JudgedCase judged = judge_alone(made_result(error, 0.01));
    EXPECT_EQ(judged.verdict, HardVerdict::wrong);
    EXPECT_THAT(judged.reason, AllOf(HasSubstr("0.011"), HasSubstr("0.01")));
  }
}

// An infinite uncertainty is one that is explained.
TEST(HardJudgement, WantsAnUncertaintyOrWhyThereIsNone) {
  Json result = made_result(3.0, 0.01);
  result["resolved"] = {{"uncertainty", nullptr},
                        {"uncertainty_reason", "the stick area lies within a cell"}};
  EXPECT_EQ(judge_alone(result).verdict, HardVerdict::certified);
  for (const Json& resolved : {Json::object(), Json({{"uncertainty", nullptr}})}) {
    result["resolved"] = resolved;
    EXPECT_EQ(judge_alone(result).verdict, HardVerdict::wrong);
  }
  result.erase("resolved");
  EXPECT_EQ(judge_alone(result).verdict, HardVerdict::wrong);
}

TEST(HardJudgement, HoldsACertificateToItsPromise) {
  EXPECT_EQ(judge_alone(made_result(0.0, 0.01, 2e-8)).verdict, HardVerdict::wrong);
  Json result = made_result(0.0, 0.01, 2e-8);
  result["certificate"]["rounding"] = 3e-8;  // no gap below can be computed
  EXPECT_EQ(judge_alone(result).verdict, HardVerdict::certified);
  result["certificate"]["rounding"] = nullptr;  // then the tolerance alone counts
  EXPECT_EQ(judge_alone(result).verdict, HardVerdict::wrong);
  for (const char* member : {"gap", "moment", "force", "friction_bound"}) {
    for (const Json& bad : {Json(1e-6), Json()}) {
      result = made_result(0.0, 0.01);
      result["certificate"][member] = bad;
      EXPECT_EQ(judge_alone(result).verdict, HardVerdict::wrong) << member << bad;
    }
  }
}

TEST(HardJudgement, TellsRefusedFromNotConvergedFromDead) {
  EXPECT_EQ(judge_alone({{"status", "refused"}, {"message", "beyond the limit"}}).verdict,
            HardVerdict::refused);
  EXPECT_EQ(judge_alone({{"status", "refused"}, {"message", ""}}).verdict, HardVerdict::wrong);
  EXPECT_EQ(judge_alone({{"status", "failed"}, {"message", "signal 9"}}).verdict, HardVerdict::wrong);
  EXPECT_EQ(judge_alone({{"status", "not_converged"}, {"message", "rounding"}}).verdict,
            HardVerdict::not_converged);
}

TEST(HardJudgement, HoldsAnAnswerToThoseOnFinerMeshes) {
  // A value of second order, 10 % off: the finer meshes are 2.5 and 0.625 % off.
  EXPECT_TRUE(judge_by_finer(1.1, 0.11, 1.025, 1.00625).holds);
  EXPECT_NEAR(judge_by_finer(1.1, 0.1, 1.025, 1.00625).error, 0.09375 / 1.00625, 1e-15);
  EXPECT_FALSE(judge_by_finer(1.1, 0.05, 1.025, 1.00625).holds);
  EXPECT_FALSE(judge_by_finer(0.9, 0.045, 0.975, 0.99375).holds);
  EXPECT_TRUE(judge_by_finer(-1.1, 0.11, -1.025, -1.00625).holds);
  EXPECT_TRUE(judge_by_finer(5.0, 5.0, 1.2, 1.1).holds);  // off by its own size, it says
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(judge_by_finer(1.0, 0.1, nan, 1.0).holds);
  for (const double uncertainty : {0.1, 5.0}) {
    EXPECT_FALSE(judge_by_finer(1.0, uncertainty, 1.0, nan).holds);
    EXPECT_FALSE(judge_by_finer(nan, uncertainty, 1.0, 1.0).holds);
  }
}

TEST(HardJudgement, LooksAtTheNumberThatTheUncertaintyIsOf) {
  Json result{{"twist_angle", -2e-3}, {"displacement", {3e-6, 4e-6}}, {"force", {0.0, 0.0}}};
  const auto value_of = [&](const char* number) {
    result["resolved"]["number"] = number;
    return main_value(result);
  };
  EXPECT_EQ(value_of("twist_angle"), -2e-3);
  EXPECT_DOUBLE_EQ(value_of("displacement"), 5e-6);
  EXPECT_TRUE(std::isnan(value_of("force")));   // nothing to be relative to
  EXPECT_TRUE(std::isnan(value_of("moment")));  // missing
  result["resolved"]["absolute"] = 0.0;         // no load acts: what moves is rounding
  EXPECT_TRUE(std::isnan(value_of("twist_angle")));
}

// Away from the limit 1e-6; where 1e-5 of the load is missing to it, what a tolerance of 1e-8 is of that.
TEST(HardJudgement, AllowsMoreOfAnAnswerNextToTheLimit) {
  const auto allowed = [](const Json& factor) {
    return same_answer({{"tolerance", 1e-8}, {"limit", {{"factor", factor}}}});
  };
  EXPECT_NEAR(allowed(2.0), 1.01e-6, 1e-12);
  EXPECT_NEAR(allowed(1.0 + 1e-5), 1e-3 + 1e-6, 1e-9);
  EXPECT_EQ(allowed(nullptr), 1e-6);
}

// The distance from the answer on four times the cells.
TEST_F(HardFile, ProgramComparesWithFinerMeshes) {
  std::string text = family("[family.set]\n\"grid.cells\" = [24, 12]\n");
  text.replace(text.find("paper.toml"), 10, "patches.toml");
  const Json row = run(text, 0)["rows"][0];
  std::vector<double> twists;
  solver::Scene scene = example("patches", {"grid.cells=[24,12]"});
  const solver::Grid grid = solver::make_model(scene).grid_in_m();
  scene.extent = {24.0 * grid.h1, 12.0 * grid.h2};
  for (const int finer : {1, 2, 4}) {
    scene.cells = {24L * finer, 12L * finer};
    scene.substeps = finer;
    twists.push_back(solver::solve(scene).twist_angle);
  }
  EXPECT_NEAR(row["finer_meshes.error"], std::abs(twists[0] / twists[2] - 1.0), 1e-7);
  EXPECT_NEAR(row["finer_meshes.change"], std::abs(twists[1] / twists[2] - 1.0), 1e-7);
}

TEST(HardJudgement, ComparesSignsAndUnits) {
  const Json first{{"twist_angle", 1e-3}, {"moment", 0.02}, {"moment_limit", 0.03}, {"contact_radius", 5e-4}};
  Json seen = first;
  EXPECT_EQ(variant_difference(first, seen, Variant::turned), 0.0);
  EXPECT_EQ(variant_difference(first, seen, Variant::mirrored), 2.0);
  seen["twist_angle"] = -1e-3;
  seen["moment"] = -0.02;
  EXPECT_EQ(variant_difference(first, seen, Variant::mirrored), 0.0);
  seen = {{"twist_angle", 1e-3}, {"moment", 20.0}, {"moment_limit", 30.0}, {"contact_radius", 0.5}};
  EXPECT_LE(variant_difference(first, seen, Variant::in_other_units), 1e-15);
  seen["moment"] = nullptr;
  EXPECT_TRUE(std::isnan(variant_difference(first, seen, Variant::in_other_units)));
}

Json answer_of(const char* method, double twist) {
  Json answer = made_result(0.0, 0.02);
  answer.update({{"method", method},
                 {"twist_angle", twist},
                 {"moment", 0.02},
                 {"moment_limit", 0.03},
                 {"contact_radius", 5e-4},
                 {"slip_direction", {{"mean", 1e-4}, {"max", 1e-3}}}});
  return answer;
}

MethodVerdict beside(const Json& other) {
  const ComparedAnswer compared = compare_answer(answer_of("coulomb", 1e-3), other);
  EXPECT_EQ(compared.reason.empty(), compared.verdict == MethodVerdict::agrees);
  return compared.verdict;
}

TEST(MethodComparison, AgreesWithinOnePercent) {
  for (const double off : {0.0, 0.009, -0.009}) {
    EXPECT_EQ(beside(answer_of("paper", (1.0 + off) * 1e-3)), MethodVerdict::agrees) << off;
  }
  for (const double off : {0.011, -0.011, -2.0}) {
    EXPECT_EQ(beside(answer_of("paper", (1.0 + off) * 1e-3)), MethodVerdict::other_answer) << off;
  }
  Json nothing = answer_of("paper", 1e-3);
  nothing["twist_angle"] = nullptr;
  EXPECT_EQ(beside(nothing), MethodVerdict::other_answer);
}

// Slip that is turned counts where it costs energy: where everything sticks, what slips is rounding.
TEST(MethodComparison, SeesSlipThatDoesNotOpposeTraction) {
  Json turned = answer_of("paper", 1e-3);
  turned["certificate"]["gap"] = 1e-4;
  EXPECT_EQ(beside(turned), MethodVerdict::agrees);
  turned["slip_direction"]["mean"] = 1.1;
  EXPECT_EQ(beside(turned), MethodVerdict::other_direction);
  turned["certificate"]["gap"] = 1e-9;
  EXPECT_EQ(beside(turned), MethodVerdict::agrees);
  turned["certificate"]["gap"] = nullptr;
  EXPECT_EQ(beside(turned), MethodVerdict::other_direction);
}

TEST(MethodComparison, KeepsWhatTheMethodSaysItself) {
  EXPECT_EQ(beside({{"status", "refused"}, {"message", "this method knows torsion alone"}}),
            MethodVerdict::refused);
  EXPECT_EQ(beside({{"status", "not_converged"}, {"message", "every cell slips"}}),
            MethodVerdict::not_converged);
  EXPECT_EQ(beside({{"status", "failed"}, {"message", "signal 11"}}), MethodVerdict::other_answer);
  Json broken = answer_of("paper", 1e-3);
  broken["certificate"]["moment"] = 0.1;
  EXPECT_EQ(beside(broken), MethodVerdict::other_answer);
}

TEST(MethodComparison, BelievesNothingWithoutACertifiedAnswer) {
  const Json refused{{"status", "refused"}, {"message", "beyond the limit"}};
  EXPECT_EQ(compare_answer(refused, answer_of("paper", 1e-3)).verdict, MethodVerdict::other_answer);
  EXPECT_EQ(compare_answer(refused, refused).verdict, MethodVerdict::refused);
}

TEST_F(HardFile, ProgramJudgesEachCaseAndItsViews) {
  const Json result = run(family("[family.set]\n\"grid.cells\" = [12, 12]\n\"solver.tolerance\" = 1e-10\n"
                                 "[[family.vary]]\nkey = 'load.moment_ratio'\nvalues = [0.5, 2.0]\n") +
                              family("[[family.vary]]\nkey = 'solver.max_iterations'\nvalues = [1]\n"),
                          1);
  EXPECT_EQ(result["counts"], Json({{"certified", 1}, {"refused", 1}, {"not_converged", 1}, {"wrong", 0}}));
  const Json& views = result["rows"][0]["variants"];
  for (const Variant variant : kVariants) EXPECT_LE(views[to_string(variant)], 1e-10) << to_string(variant);
  EXPECT_THAT(result["rows"][1]["reason"].get<std::string>(), HasSubstr("gross slip"));
}

TEST_F(HardFile, ProgramComparesMethods) {
  const Json result = run(family("[family.set]\n\"grid.cells\" = [12, 12]\n"
                                 "[[family.vary]]\nkey = 'load.moment_ratio'\nvalues = [0.5, 2.0]\n"),
                          0, {"--once", "--beside", "projected_gradient"});
  EXPECT_EQ(result["methods"]["projected_gradient"], Json({{"agrees", 1},
                                                           {"refused", 1},
                                                           {"not_converged", 0},
                                                           {"other_direction", 0},
                                                           {"other_answer", 0}}));
  const Json& beside = result["rows"][0]["methods"]["projected_gradient"];
  EXPECT_EQ(beside["verdict"], "agrees");
  EXPECT_GT(beside["difference"], 0.0);  // another method, not the first again
  EXPECT_GT(beside["operator_applications"], result["rows"][0]["operator_applications"]);
}

}  // namespace
}  // namespace slipstick::convergence
