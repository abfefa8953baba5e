// The numbers of a study of made results with known order, constant, limit, spread and noise; and of one whose results
// are missing: means over the others, null with a reason for an unknown number, the failed runs.

#include "convergence/studies/study_judgement.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "convergence/runs/run_spec.hpp"

namespace slipstick::convergence {
namespace {

using testing::HasSubstr;

const std::string kTwist = "twist_error";
const Json kKilled{{"status", "failed"}, {"message", "its process was killed by signal 9"}, {"run", "paper, this one"}};

/// A solve with one number; reference: the relative uncertainty of its exact answer, NaN: it has none.
Json solved(double value, double reference = 1e-15, const std::string& quantity = kTwist) {
  Json result{{"status", "converged"}, {quantity, value}};
  if (std::isfinite(reference)) result["exact"] = {{"relative_uncertainty", reference}};
  return result;
}

/// A study of one quantity on four meshes with `grids` grids each.
struct MadeStudy {
  Study study;
  Series series;
  std::vector<MeshResults> results;
  std::string quantity;

  MadeStudy(const std::string& scene, const std::string& path, int grids) : quantity(path) {
    study.source = "study.toml";
    study.scene = std::string(SLIPSTICK_SCENES) + "/" + scene + ".toml";
    study.cells = {16, 32, 64, 128};
    study.shifts = grids;
    study.quantities = {path};
    series = make_series(study).front();
    results.resize(series.meshes.size());
  }

  std::size_t meshes() const { return series.meshes.size(); }

  /// A power of (cell size / cell size of the coarsest mesh), for the first grid and for the mean of the grids.
  double of_first(std::size_t mesh, double power = 2.0) const {
    return std::pow(series.meshes[mesh].grids[0].size / series.meshes[0].grids[0].size, power);
  }
  double of_mean(std::size_t mesh, double power = 2.0) const {
    double sum = 0.0;
    for (const GridChoice& grid : series.meshes[mesh].grids) sum += grid.size;
    const double mean = sum / static_cast<double>(series.meshes[mesh].grids.size());
    return std::pow(mean / series.meshes[0].grids[0].size, power);
  }
  /// A constant at size 1, as it is at the size of the coarsest mesh.
  double at_coarsest(const Json& constant, double power = 2.0) const {
    return constant.get<double>() * std::pow(series.meshes[0].grids[0].size, power);
  }

  /// The values of the grids of a mesh, of its first grid to a tighter tolerance, and the change by rounding.
  void set(std::size_t mesh, const std::vector<double>& grids, double tightened, double rounding,
           double reference = 1e-15) {
    MeshResults& at = results[mesh] = {};
    const auto with = [&](double value) { return solved(value, reference, quantity); };
    for (const double value : grids) at.grids.push_back(with(value));
    at.tightened = with(tightened);
    if (series.meshes[mesh].rounded) at.rounded = {with(tightened + rounding), with(tightened - 0.5 * rounding)};
  }

  Json judged() const { return to_json(judge_series(study, series, results)); }
};

/// within: a part of the expected number.
void expect_part(const Json& found, double expected, double within) {
  ASSERT_TRUE(found.is_number()) << found;
  EXPECT_NEAR(found.get<double>(), expected, std::abs(within * expected));
}

constexpr double kConstant = 2e-3;  ///< error at the size of the coarsest mesh

// Stopping takes a thousandth off each error.
TEST(StudyNumbers, OfErrorsAreTheMadeOnes) {
  constexpr double kReference = 3e-9;
  constexpr double kRounding = 5e-9;
  MadeStudy made("paper", kTwist, 1);
  const auto error = [&](std::size_t mesh) { return kConstant * made.of_first(mesh); };
  for (std::size_t i = 0; i < made.meshes(); ++i)
    made.set(i, {(1.0 - 1e-3) * error(i)}, error(i), kRounding, kReference);
  const Json json = made.judged();
  const Json& order = json["order"][kTwist];
  expect_part(order["value"], 2.0, 1e-9);
  EXPECT_NEAR(made.at_coarsest(order["constant"]), (1.0 - 1e-3) * kConstant, 1e-9 * kConstant);
  EXPECT_EQ(json["reference_uncertainty"], kReference);
  for (std::size_t i = 0; i < made.meshes(); ++i) {
    const Json& part = json["budget"][i];
    expect_part(part["observed"], (1.0 - 1e-3) * error(i), 1e-12);
    expect_part(part["discretisation"], error(i), 1e-12);
    expect_part(part["iteration"], -1e-3 * error(i), 1e-9);
    expect_part(part["rounding"], kRounding, 1e-6);
    EXPECT_EQ(part["reference"], kReference);
    expect_part(part["trend"], (1.0 - 1e-3) * error(i), 1e-9);
    expect_part(part["staircase"], 1e-3 * error(i), 1e-6);
    // A bound of both together, whatever their signs.
    expect_part(json["meshes"][i][kTwist]["noise"], 1e-3 * error(i) + kRounding, 1e-6);
  }
}

// Values L (1 + A h^1.5) of a negative L: errors are relative to the limit, sizes and bounds to its size. The
// uncertainty of the limit of a fit without residuals is 1.25 times the finest mesh's distance from it (Eca
// and Hoekstra 2014), plus the noise.
TEST(StudyNumbers, OfValuesAreRelativeToTheirLimit) {
  const std::string quantity = "moment_limit";
  const double limit = -0.03;
  const double amplitude = 0.1;
  const double power = 1.5;
  const double iteration = 1e-9;
  const double rounding = 1e-10;
  MadeStudy made("dissimilar", quantity, 2);
  for (std::size_t i = 0; i < made.meshes(); ++i) {
    const double first = limit * (1.0 + amplitude * made.of_mean(i, power)) + 1e-6;
    made.set(i, {first, first - 2e-6}, first - iteration, rounding, NAN);
  }
  const Json json = made.judged();
  const double finest = amplitude * made.of_mean(made.meshes() - 1, power);
  const double scatter = std::sqrt(2.0) * 1e-6;  // of two grids, from their mean
  const Json& found = json["extrapolated"][quantity];
  expect_part(found["value"], limit, 1e-9);
  // The mean of two: its noise, and two standard errors.
  const double of_finest = iteration + rounding + 2.0 * scatter / std::sqrt(2.0);
  const double uncertainty = 1.25 * finest * std::abs(limit) + of_finest;
  expect_part(found["uncertainty"], uncertainty, 1e-5);
  EXPECT_NEAR(made.at_coarsest(json["order"][quantity]["constant"], power), amplitude, 1e-6);
  for (std::size_t i = 0; i < made.meshes(); ++i) {
    const double trend = amplitude * made.of_first(i, power);
    const double observed = amplitude * made.of_mean(i, power) + 1e-6 / limit;
    const Json& part = json["budget"][i];
    EXPECT_NEAR(part["observed"].get<double>(), observed, 1e-8);
    EXPECT_NEAR(part["discretisation"].get<double>(), observed - iteration / limit, 1e-8);
    expect_part(part["iteration"], iteration / limit, 1e-6);
    expect_part(part["rounding"], rounding / std::abs(limit), 1e-5);
    expect_part(part["reference"], uncertainty / std::abs(limit), 1e-5);
    EXPECT_NEAR(part["trend"].get<double>(), trend, 1e-6 * trend);
    EXPECT_NEAR(part["staircase"].get<double>(), observed - trend, 1e-7);
    const Json& mesh = json["meshes"][i][quantity];
    EXPECT_NEAR(mesh["mean"].get<double>(), amplitude * made.of_mean(i, power), 1e-8);
    expect_part(mesh["spread"], scatter / std::abs(limit), 1e-6);
    expect_part(mesh["noise"], (iteration + rounding) / std::abs(limit), 1e-5);
  }
}

// stopping, rounding, reference: parts of one mesh's error. From a tenth of the error on a tighter tolerance
// is needed, but none removes the errors by rounding and by the reference.
TEST(StudyNumbers, NeedATighterToleranceAboveTheFloor) {
  const auto tightens = [](double stopping, double rounding, double reference) {
    MadeStudy made("paper", kTwist, 1);
    for (std::size_t i = 0; i < made.meshes(); ++i) {
      const double error = kConstant * made.of_first(i);
      const bool here = made.series.meshes[i].rounded;
      made.set(i, {here ? (1.0 + stopping) * error : error}, error, rounding * error, reference * error);
    }
    return needs_tightening(made.study, made.series, made.results);
  };
  for (const double sign : {1.0, -1.0}) {
    EXPECT_FALSE(tightens(sign * 0.095, 1e-3, 1e-3));
    EXPECT_TRUE(tightens(sign * 0.105, 1e-3, 1e-3));
  }
  EXPECT_TRUE(tightens(0.2, 0.04, 0.15));
  EXPECT_FALSE(tightens(0.2, 0.06, 0.15));
  EXPECT_FALSE(tightens(0.2, 0.15, 0.06));
}

/// A study of errors h^2 (1 +- 1/10) on two grids a mesh; each test takes some results away.
class Judged : public testing::Test {
 protected:
  static constexpr double kIteration = 1e-9;  ///< error by stopping
  static constexpr double kRounding = 1e-13;

  Judged() {
    for (std::size_t i = 0; i < made_.meshes(); ++i) {
      const double error = 1e-3 * made_.of_first(i);
      made_.set(i, {1.1 * error + kIteration, 0.9 * error + kIteration}, 1.1 * error, kRounding);
    }
  }

  /// The judgement; `failed`: the number of failed runs. Every null has a reason.
  Json judged(int failed) const {
    Json json = made_.judged();
    EXPECT_EQ(json["failed_runs"]["count"], failed);
    expect_explained(json);
    return json;
  }

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

  MadeStudy made_{"paper", kTwist, 2};
  std::vector<MeshResults>& results_ = made_.results;
};

TEST_F(Judged, OfAllResultsSaysSo) {
  const Json json = judged(0);
  EXPECT_EQ(json["failed_runs"]["of"], 4 * 3 + 2);
  EXPECT_EQ(failed_runs_text(json), "");
  EXPECT_EQ(json["order"][kTwist]["verdict"], "asymptotic") << json["order"].dump(1);
  for (const Json& mesh : json["meshes"]) {
    EXPECT_EQ(mesh[kTwist]["grids"], 2);
    expect_part(mesh[kTwist]["noise"], kIteration + kRounding, 1e-3);
  }
}

TEST_F(Judged, AGridThatDiedLeavesTheOthersOfItsMesh) {
  results_[1].grids[1] = kKilled;
  const Json json = judged(1);
  const Json& mesh = json["meshes"][1][kTwist];
  EXPECT_EQ(mesh["grids"], 1);
  EXPECT_EQ(mesh["mean"], results_[1].grids[0][kTwist]);
  EXPECT_TRUE(mesh["spread"].is_null());  // of one grid
  expect_part(mesh["noise"], kIteration + kRounding, 1e-3);
  const Json& order = json["order"][kTwist];
  EXPECT_THAT(order["why"].get<std::string>(),
              testing::AllOf(HasSubstr("1 of 14"), HasSubstr("paper, this one"), HasSubstr("signal 9")));
  EXPECT_TRUE(order["value"].is_number());
}

TEST_F(Judged, SpreadIsOverTheGridsThatAreThere) {
  made_.study.shifts = 3;
  made_.series = make_series(made_.study).front();
  for (MeshResults& at : results_) at.grids.push_back(at.grids[1]);
  results_[2].grids = {kKilled, solved(2e-5), solved(4e-5)};
  const Json mesh = judged(1)["meshes"][2][kTwist];
  expect_part(mesh["mean"], 3e-5, 1e-12);
  expect_part(mesh["spread"], 1e-5 * std::sqrt(2.0), 1e-12);
}

/// The budget of a mesh is determined from its first grid: without it the noise is unknown, which is not
/// zero, and the mesh is not fitted.
TEST_F(Judged, WithoutItsFirstGridAMeshHasNoNoise) {
  results_[1].grids[0] = kKilled;
  const Json json = judged(1);
  const Json& mesh = json["meshes"][1][kTwist];
  const Json& budget = json["budget"][1];
  EXPECT_EQ(mesh["mean"], results_[1].grids[1][kTwist]);
  for (const auto& [at, part] : {std::pair{mesh, "noise"}, {budget, "observed"}, {budget, "iteration"}}) {
    EXPECT_TRUE(at[part].is_null()) << part;
    EXPECT_THAT(at[std::string(part) + "_reason"].get<std::string>(), HasSubstr("signal 9"));
  }
  EXPECT_TRUE(budget["discretisation"].is_number());
  EXPECT_EQ(json["order"][kTwist]["sizes"].size(), 3U);
  EXPECT_THAT(json["order"][kTwist]["why"].get<std::string>(), HasSubstr("no noise is known at size"));
}

TEST_F(Judged, WithoutATighterSolveAMeshHasNoNoise) {
  results_[0].tightened = kKilled;
  const Json json = judged(1);
  EXPECT_TRUE(json["meshes"][0][kTwist]["noise"].is_null());
  EXPECT_TRUE(json["budget"][0]["observed"].is_number());
  EXPECT_TRUE(json["budget"][0]["discretisation"].is_null());
  EXPECT_TRUE(json["budget"][0]["iteration"].is_null());
  EXPECT_TRUE(json["budget"][1]["rounding"].is_number());
}

/// Rounding is measured on one mesh for all of them.
TEST_F(Judged, WithoutARoundedSolveNoMeshHasANoise) {
  const auto all = results_;
  for (const std::size_t direction : {0U, 1U}) {
    results_ = all;
    results_[3].rounded[direction] = kKilled;
    const Json json = judged(1);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_TRUE(json["meshes"][i][kTwist]["noise"].is_null()) << i;
      EXPECT_TRUE(json["budget"][i]["rounding"].is_null()) << i;
      EXPECT_TRUE(json["budget"][i]["iteration"].is_number()) << i;
    }
    EXPECT_EQ(json["order"][kTwist]["verdict"], "too_few");
    EXPECT_THAT(json["order"][kTwist]["why"].get<std::string>(), HasSubstr("1 of 14"));
  }
}

// A result of any grid gives the quantities.
TEST_F(Judged, WithoutAnyResultTheQuantitiesOfTheStudyAreMissing) {
  for (MeshResults& at : results_) at.grids[0] = kKilled;
  made_.study.quantities.clear();
  EXPECT_TRUE(judged(4)["order"].contains(kTwist));
  made_.study.quantities = {kTwist};
  for (MeshResults& at : results_) {
    at.grids[1] = at.tightened = kKilled;
    for (Json& rounded : at.rounded) rounded = kKilled;
  }
  const Json json = judged(14);
  EXPECT_TRUE(json["order"][kTwist]["value"].is_null());
  EXPECT_TRUE(json["meshes"][0][kTwist]["mean"].is_null());
  EXPECT_TRUE(json["meshes"][0][kTwist]["spread"].is_null());
}

// Rounding up and down lean to either side: what it does is the larger of the two.
TEST(Budget, HasTheLargerOfTwoRoundingsWhereBothAreKnown) {
  const auto budget = [](const Json& tightened, const std::vector<Json>& rounded) {
    return split_error(kTwist, solved(1e-3), tightened, rounded);
  };
  const Json tightened = solved(0.9e-3);
  const Json up = solved(0.9e-3 + 1e-9);
  const Json down = solved(0.9e-3 - 4e-9);
  EXPECT_NEAR(budget(tightened, {up, down}).rounding, 4e-9, 1e-18);
  EXPECT_NEAR(budget(tightened, {down, up}).rounding, 4e-9, 1e-18);
  for (const std::vector<Json>& rounded : std::vector<std::vector<Json>>{{kKilled, up}, {up, kKilled}, {}})
    EXPECT_TRUE(std::isnan(budget(tightened, rounded).rounding));
  const Budget without = budget(kKilled, {up, up});
  for (const double part : {without.discretisation, without.iteration, without.rounding}) EXPECT_TRUE(std::isnan(part));
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
