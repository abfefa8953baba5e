// The numbers of a study of made results with known order, constant, limit, spread and noise.

#include <gtest/gtest.h>

#include <cmath>

#include "convergence/studies/study_judgement.hpp"

namespace slipstick::convergence {
namespace {

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

  /// A power of (cell size / cell size of the coarsest mesh), for the first grid and for the mean of the
  /// grids.
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

  Json with(double value, double reference) const {
    Json result{{"status", "converged"}, {quantity, value}};
    if (std::isfinite(reference)) result["exact"] = {{"relative_uncertainty", reference}};
    return result;
  }

  /// The values of the grids of a mesh, of its first grid to a tighter tolerance, and the change by rounding.
  void set(std::size_t mesh, const std::vector<double>& grids, double tightened, double rounding,
           double reference = NAN) {
    MeshResults& at = results[mesh];
    at = {};
    for (const double value : grids) at.grids.push_back(with(value, reference));
    at.tightened = with(tightened, reference);
    if (!series.meshes[mesh].rounded) return;
    at.rounded = {with(tightened + rounding, reference), with(tightened - 0.5 * rounding, reference)};
  }

  Json judged() const { return to_json(judge_series(study, series, results)); }
  bool is_tightened() const { return needs_tightening(study, series, results); }
};

/// within: a part of the expected number.
void expect_part(const Json& found, double expected, double within) {
  ASSERT_TRUE(found.is_number()) << found;
  EXPECT_NEAR(found.get<double>(), expected, std::abs(within * expected));
}

const std::string kMadeError = "twist_error";
constexpr double kMadeConstant = 2e-3;  ///< error at the size of the coarsest mesh
constexpr double kMadeReference = 3e-9;
constexpr double kMadeRounding = 5e-9;

// Stopping takes a thousandth off each error.
TEST(StudyNumbers, OfErrorsAreTheMadeOnes) {
  MadeStudy made("paper", kMadeError, 1);
  const auto error = [&](std::size_t mesh) { return kMadeConstant * made.of_first(mesh); };
  for (std::size_t i = 0; i < made.meshes(); ++i) {
    made.set(i, {(1.0 - 1e-3) * error(i)}, error(i), kMadeRounding, kMadeReference);
  }
  const Json json = made.judged();
  const Json& order = json["order"][kMadeError];
  expect_part(order["value"], 2.0, 1e-9);
  EXPECT_NEAR(made.at_coarsest(order["constant"]), (1.0 - 1e-3) * kMadeConstant, 1e-9 * kMadeConstant);
  EXPECT_EQ(json["reference_uncertainty"], kMadeReference);
  for (std::size_t i = 0; i < made.meshes(); ++i) {
    const Json& part = json["budget"][i];
    expect_part(part["observed"], (1.0 - 1e-3) * error(i), 1e-12);
    expect_part(part["discretisation"], error(i), 1e-12);
    expect_part(part["iteration"], -1e-3 * error(i), 1e-9);
    expect_part(part["rounding"], kMadeRounding, 1e-6);
    EXPECT_EQ(part["reference"], kMadeReference);
    expect_part(part["trend"], (1.0 - 1e-3) * error(i), 1e-9);
    expect_part(part["staircase"], 1e-3 * error(i), 1e-6);
    // A bound of both together, whatever their signs.
    expect_part(json["meshes"][i][kMadeError]["noise"], 1e-3 * error(i) + kMadeRounding, 1e-6);
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
    made.set(i, {first, first - 2e-6}, first - iteration, rounding);
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

/// Whether a study takes a tighter tolerance. stopping, rounding, reference: parts of one mesh's error.
bool tightens(double stopping, double rounding, double reference) {
  MadeStudy made("paper", kMadeError, 1);
  for (std::size_t i = 0; i < made.meshes(); ++i) {
    const double error = kMadeConstant * made.of_first(i);
    const bool here = made.series.meshes[i].rounded;
    made.set(i, {here ? (1.0 + stopping) * error : error}, error, rounding * error, reference * error);
  }
  return made.is_tightened();
}

TEST(StudyNumbers, NeedATighterToleranceFromATenthOfTheErrorOn) {
  EXPECT_FALSE(tightens(0.095, 1e-3, 1e-3));
  EXPECT_TRUE(tightens(0.105, 1e-3, 1e-3));
  EXPECT_FALSE(tightens(-0.095, 1e-3, 1e-3));
  EXPECT_TRUE(tightens(-0.105, 1e-3, 1e-3));
}

// No tolerance removes the errors by rounding and by the reference.
TEST(StudyNumbers, NeedNoTighterToleranceBelowTheFloor) {
  EXPECT_TRUE(tightens(0.2, 0.04, 0.15));
  EXPECT_FALSE(tightens(0.2, 0.06, 0.15));
  EXPECT_FALSE(tightens(0.2, 0.15, 0.06));
}

}  // namespace
}  // namespace slipstick::convergence
