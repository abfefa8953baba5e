// Studies with missing results: means over the others, null with a reason for an unknown number, and the
// failed runs.

#include "convergence/studies/study_judgement.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "convergence/runs/run_spec.hpp"

namespace slipstick::convergence {
namespace {

using testing::HasSubstr;

const std::string kTwist = "twist_error";
constexpr double kIteration = 1e-9;  ///< error by stopping
constexpr double kJudgementRounding = 1e-13;

Json solved(double error) {
  return {{"status", "converged"}, {"twist_error", error}, {"exact", {{"relative_uncertainty", 1e-15}}}};
}

const Json kKilled{
    {"status", "failed"}, {"message", "its process was killed by signal 9"}, {"run", "paper, this one"}};

/// A study of errors h^2 (1 +- 1/10) on two grids a mesh; each test takes some results away.
class Judged : public testing::Test {
 protected:
  Judged() {
    study_.source = "study.toml";
    study_.scene = std::string(SLIPSTICK_SCENES) + "/paper.toml";
    study_.cells = {16, 32, 64, 128};
    study_.shifts = 2;
    study_.quantities = {kTwist};
    series_ = make_series(study_).front();
    for (const Mesh& mesh : series_.meshes) {
      MeshResults& at = results_.emplace_back();
      const double error = 1e-3 * std::pow(mesh.grids.front().size / series_.meshes[0].grids.front().size, 2);
      at.grids = {solved(1.1 * error + kIteration), solved(0.9 * error + kIteration)};
      at.tightened = solved(1.1 * error);
      if (mesh.rounded)
        at.rounded = {solved(1.1 * error + kJudgementRounding), solved(1.1 * error - kJudgementRounding)};
    }
  }

  Json judged() const { return to_json(judge_series(study_, series_, results_)); }

  static double number(const Json& mesh, const std::string& key) { return mesh[kTwist][key].get<double>(); }

  /// Every null has a reason.
  static void expect_explained(const Json& at, const std::string& path = "") {
    if (!at.is_structured()) return;
    for (const auto& [key, value] : at.items()) {
      const std::string inner = path + "/" + key;
      if (value.is_null()) {
        EXPECT_TRUE(at.is_object() && at.contains(key + "_reason") && at[key + "_reason"] != "") << inner;
      }
      expect_explained(value, inner);
    }
  }

  Study study_;
  Series series_;
  std::vector<MeshResults> results_;
};

TEST_F(Judged, OfAllResultsSaysSo) {
  const Json json = judged();
  EXPECT_EQ(json["failed_runs"]["count"], 0);
  EXPECT_EQ(json["failed_runs"]["of"], 4 * 3 + 2);
  EXPECT_EQ(failed_runs_text(json), "");
  EXPECT_EQ(json["order"][kTwist]["verdict"], "asymptotic") << json["order"].dump(1);
  for (const Json& mesh : json["meshes"]) {
    EXPECT_EQ(mesh[kTwist]["grids"], 2);
    EXPECT_NEAR(number(mesh, "noise"), kIteration + kJudgementRounding, 1e-3 * kIteration);
  }
  expect_explained(json);
}

TEST_F(Judged, AGridThatDiedLeavesTheOthersOfItsMesh) {
  results_[1].grids[1] = kKilled;
  const Json json = judged();
  const Json& mesh = json["meshes"][1];
  EXPECT_EQ(mesh[kTwist]["grids"], 1);
  EXPECT_EQ(number(mesh, "mean"), results_[1].grids[0]["twist_error"]);
  EXPECT_TRUE(mesh[kTwist]["spread"].is_null());  // of one grid
  EXPECT_NEAR(number(mesh, "noise"), kIteration + kJudgementRounding, 1e-3 * kIteration);
  const Json& order = json["order"][kTwist];
  EXPECT_THAT(order["why"].get<std::string>(),
              testing::AllOf(HasSubstr("1 of 14"), HasSubstr("paper, this one"), HasSubstr("signal 9")));
  EXPECT_TRUE(order["value"].is_number());
  EXPECT_EQ(json["failed_runs"]["count"], 1);
  expect_explained(json);
}

TEST_F(Judged, SpreadIsOverTheGridsThatAreThere) {
  study_.shifts = 3;
  series_ = make_series(study_).front();
  for (MeshResults& at : results_) at.grids.push_back(at.grids[1]);
  results_[2].grids[0] = kKilled;
  results_[2].grids[1] = solved(2e-5);
  results_[2].grids[2] = solved(4e-5);
  const Json json = judged();
  EXPECT_NEAR(number(json["meshes"][2], "mean"), 3e-5, 1e-18);
  EXPECT_NEAR(number(json["meshes"][2], "spread"), 1e-5 * std::sqrt(2.0), 1e-18);
}

/// The budget of a mesh is determined from its first grid: without it the noise is unknown, which is not
/// zero, and the mesh is not fitted.
TEST_F(Judged, WithoutItsFirstGridAMeshHasNoNoise) {
  results_[1].grids[0] = kKilled;
  const Json json = judged();
  const Json& mesh = json["meshes"][1][kTwist];
  EXPECT_TRUE(mesh["noise"].is_null());
  EXPECT_THAT(mesh["noise_reason"].get<std::string>(), HasSubstr("signal 9"));
  EXPECT_EQ(mesh["mean"], results_[1].grids[1]["twist_error"]);
  for (const char* part : {"observed", "iteration"}) {
    EXPECT_TRUE(json["budget"][1][part].is_null()) << part;
    EXPECT_THAT(json["budget"][1][std::string(part) + "_reason"].get<std::string>(), HasSubstr("signal 9"));
  }
  EXPECT_TRUE(json["budget"][1]["discretisation"].is_number());
  EXPECT_EQ(json["order"][kTwist]["sizes"].size(), 3U);
  EXPECT_THAT(json["order"][kTwist]["why"].get<std::string>(), HasSubstr("no noise is known at size"));
  expect_explained(json);
}

TEST_F(Judged, WithoutATighterSolveAMeshHasNoNoise) {
  results_[0].tightened = kKilled;
  const Json json = judged();
  EXPECT_TRUE(json["meshes"][0][kTwist]["noise"].is_null());
  EXPECT_TRUE(json["budget"][0]["observed"].is_number());
  EXPECT_TRUE(json["budget"][0]["discretisation"].is_null());
  EXPECT_TRUE(json["budget"][0]["iteration"].is_null());
  EXPECT_TRUE(json["budget"][1]["rounding"].is_number());
  EXPECT_EQ(json["failed_runs"]["count"], 1);
  expect_explained(json);
}

/// Rounding is measured on one mesh for all of them.
TEST_F(Judged, WithoutARoundedSolveNoMeshHasANoise) {
  for (const std::size_t direction : {0U, 1U}) {
    const auto all = results_;
    results_[3].rounded[direction] = kKilled;
    const Json json = judged();
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_TRUE(json["meshes"][i][kTwist]["noise"].is_null()) << i;
      EXPECT_TRUE(json["budget"][i]["rounding"].is_null()) << i;
      EXPECT_TRUE(json["budget"][i]["iteration"].is_number()) << i;
    }
    EXPECT_EQ(json["order"][kTwist]["verdict"], "too_few");
    EXPECT_THAT(json["order"][kTwist]["why"].get<std::string>(), HasSubstr("1 of 14"));
    expect_explained(json);
    results_ = all;
  }
}

TEST_F(Judged, WithoutAnyResultTheQuantitiesOfTheStudyAreMissing) {
  for (MeshResults& at : results_) {
    for (Json& grid : at.grids) grid = kKilled;
    at.tightened = kKilled;
    for (Json& rounded : at.rounded) rounded = kKilled;
  }
  const Json json = judged();
  EXPECT_EQ(json["failed_runs"]["count"], 14);
  EXPECT_TRUE(json["order"][kTwist]["value"].is_null());
  EXPECT_TRUE(json["meshes"][0][kTwist]["mean"].is_null());
  EXPECT_TRUE(json["meshes"][0][kTwist]["spread"].is_null());
  expect_explained(json);
}

TEST_F(Judged, AResultOfAnyGridGivesTheQuantities) {
  for (MeshResults& at : results_) at.grids[0] = kKilled;
  study_.quantities.clear();
  EXPECT_TRUE(judged()["order"].contains(kTwist));
}

TEST(Budget, IsNotKnownWhereAPartIsMissing) {
  const Json observed = solved(1e-3);
  const Json tightened = solved(0.9e-3);
  const Json rounded = solved(0.9e-3 + kJudgementRounding);
  EXPECT_NEAR(split_error(kTwist, observed, tightened, {rounded, tightened}).rounding, kJudgementRounding,
              1e-18);
  EXPECT_TRUE(std::isnan(split_error(kTwist, observed, tightened, {kKilled, rounded}).rounding));
  EXPECT_TRUE(std::isnan(split_error(kTwist, observed, tightened, {rounded, kKilled}).rounding));
  EXPECT_TRUE(std::isnan(split_error(kTwist, observed, tightened, {}).rounding));
  const Budget without = split_error(kTwist, observed, kKilled, {rounded, rounded});
  EXPECT_TRUE(std::isnan(without.discretisation));
  EXPECT_TRUE(std::isnan(without.iteration));
  EXPECT_TRUE(std::isnan(without.rounding));
}

// Rounding up and down lean to either side: what it does is the larger of the two.
TEST(Budget, TakesTheLargerOfTwoRoundings) {
  const auto rounding = [](double up, double down) {
    return split_error(kTwist, solved(1e-3), solved(0.9e-3), {solved(0.9e-3 + up), solved(0.9e-3 + down)})
        .rounding;
  };
  EXPECT_NEAR(rounding(1e-9, -4e-9), 4e-9, 1e-18);
  EXPECT_NEAR(rounding(-4e-9, 1e-9), 4e-9, 1e-18);
}

TEST(FailedRunsTest, CountsARunOnceAndKeepsTheFirst) {
  FailedRuns failed;
  failed.add("a", solved(1.0));
  failed.add("b", kKilled);
  failed.add("b", kKilled);
  failed.add("c", {{"status", "refused"}, {"message", "gross slip"}, {"run", "c"}});
  failed.add("d", {{"status", "not_converged"}, {"message", "too few iterations"}});
  const Json json{{"failed_runs", failed.json()}};
  EXPECT_EQ(json["failed_runs"]["count"], 2);
  EXPECT_EQ(json["failed_runs"]["of"], 4);
  EXPECT_EQ(failed_runs_text(json),
            "2 of 4 runs failed; the first (paper, this one): its process was killed by signal 9");
}

}  // namespace
}  // namespace slipstick::convergence
