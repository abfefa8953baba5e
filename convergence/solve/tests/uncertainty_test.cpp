// What uncertain inputs make of results, against the power laws of Hertz and of dimensions.

#include "convergence/solve/uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "convergence/results/exact_result.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "solver/input/input_error.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

const std::string kUncertainScene = std::string(SLIPSTICK_SCENES) + "/paper.toml";

Json uncertainty(std::vector<std::string> overrides, const std::vector<std::string>& words) {
  const SolveWith solve = [&](const std::vector<std::string>& changed) {
    std::vector<std::string> all = overrides;
    all.insert(all.end(), changed.begin(), changed.end());
    const solver::Scene scene = solver::read_scene(kUncertainScene, all);
    if (scene.model == solver::ModelChoice::exact) return exact_result(scene, require_oracle(scene), 0);
    return solve_scene(scene).result;
  };
  return uncertainty_json(solve({}), uncertain_inputs(kUncertainScene, overrides, words), solve);
}

/// At a given moment ratio the twist is mu W / (G a^2), the limit mu W a, and a^3 = W R / E* times constants.
struct Law {
  const char* output;
  double friction, normal, radius, modulus;  ///< exponents; of the modulus: of both bodies together
};
constexpr Law kLaws[] = {
    {"contact_radius", 0, 1. / 3, 1. / 3, -1. / 3}, {"moment_limit", 1, 4. / 3, 1. / 3, -1. / 3},
    {"moment", 1, 4. / 3, 1. / 3, -1. / 3},         {"stick_radius", 0, 1. / 3, 1. / 3, -1. / 3},
    {"peak_pressure", 0, 1. / 3, -2. / 3, 2. / 3},  {"approach", 0, 2. / 3, -1. / 3, -2. / 3},
    {"twist_angle", 1, 1. / 3, -2. / 3, -1. / 3}};

void expect_laws(const Json& found, double within) {
  const double parts[] = {0.05, 0.03, 0.01, 0.02};
  for (const Law& law : kLaws) {
    SCOPED_TRACE(law.output);
    const Json& output = found["outputs"][law.output];
    // Equal bodies: each has half of the modulus' exponent.
    const double exponents[] = {law.friction, law.normal, law.radius, law.modulus / 2, law.modulus / 2};
    double squares = 0;
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(output["parts"][i]["exponent"].get<double>(), exponents[i], within) << i;
      squares += std::pow(exponents[i] * parts[std::min(i, 3)], 2);
    }
    EXPECT_NEAR(output["relative"].get<double>(), std::sqrt(squares), within);
    EXPECT_NEAR(output["standard"].get<double>(),
                output["relative"].get<double>() * std::abs(output["value"].get<double>()),
                1e-12 * output["value"].get<double>());
  }
}

const std::vector<std::string> kFour = {"friction=5%", "load.normal=3%", "radius=1%", "young_modulus=2%"};

TEST(Uncertainty, OfExactAnswersFollowsThePowerLaws) {
  expect_laws(uncertainty({"solver.model=\"exact\""}, kFour), 1e-9);
}

TEST(Uncertainty, OfSolvesFollowsThePowerLawsAndSaysThatTheMeshIsFineEnough) {
  const Json found = uncertainty({"grid.cells=[48,48]"}, kFour);
  expect_laws(found, 1e-3);
  EXPECT_NE(found["sentence"].get<std::string>().find("a finer mesh tells nothing more"), std::string::npos);
}

TEST(Uncertainty, OfInputsThatAreBetterKnownThanTheMeshAllows) {
  const Json found = uncertainty({"grid.cells=[16,16]"}, {"friction=0.001%"});
  EXPECT_NE(found["sentence"].get<std::string>().find("a finer mesh matters more"), std::string::npos);
}

TEST(Uncertainty, StepsStayBelowTheLimit) {
  const Json found = uncertainty({"solver.model=\"exact\"", "load.moment_ratio=0.9999"}, {"moment_ratio=1%"});
  EXPECT_NEAR(found["outputs"]["moment"]["relative"].get<double>(), 0.01, 1e-9);
}

TEST(Uncertainty, OfOneBodyAlone) {
  const Json found = uncertainty({"solver.model=\"exact\""}, {"upper.young_modulus=2%"});
  EXPECT_EQ(found["inputs"].size(), 1);
  EXPECT_NEAR(found["outputs"]["contact_radius"]["relative"].get<double>(), 0.02 / 6, 1e-9);
}

TEST(Uncertainty, BadOnesAreRefusedWithWhatIsAllowed) {
  for (const char* word : {"fricton=5%", "shape=5%", "friction=5", "friction=-5%", "friction=five%",
                           "friction", "friction=0%", "friction=100%", "friction=nan%", "=5%", "cells=5%"}) {
    EXPECT_THROW(uncertain_inputs(kUncertainScene, {}, {word}), solver::InputError) << word;
  }
  EXPECT_THROW(uncertain_inputs(kUncertainScene, {}, {"friction=5%", "contact.friction=2%"}),
               solver::InputError);
}

}  // namespace
}  // namespace slipstick::convergence
