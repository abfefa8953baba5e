// solver.model = "exact": a scene answered without a grid.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "analytic/torsion.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/results/solution_fields.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/field_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

// A few roundings on the way from a scene's moduli to the number.
constexpr double kTolerance = 1e-14;

const std::vector<std::string> kBodies{"paper", "cone", "flat_punch"};

solver::Scene exact_scene(const std::string& name, std::vector<std::string> overrides = {}) {
  overrides.emplace_back("solver.model=exact");
  return example(name, overrides);
}

Json answer(const solver::Scene& scene) { return to_json(exact_record(scene, require_oracle(scene), 0.0)); }

double number(const Json& result, const char* key) { return result[key].get<double>(); }

const analytic::Profile& profile_of(const std::string& name) {
  return name == "cone"         ? analytic::cone_profile()
         : name == "flat_punch" ? analytic::flat_punch_profile()
                                : analytic::hertz_profile();
}

TEST(ExactModel, GivesTheNumbersOfTheExactSolution) {
  for (const std::string& name : kBodies) {
    for (const double ratio : {0.1, 0.5, 0.9, 0.99}) {
      const Json result = answer(exact_scene(name, {"load.moment_ratio=" + std::to_string(ratio)}));
      const analytic::TorsionState state = analytic::from_moment_ratio(ratio, profile_of(name));
      EXPECT_EQ(result["model"]["left_out"][0]["what"], "the grid");
      EXPECT_EQ(number(result, "moment_ratio"), ratio) << name;
      EXPECT_EQ(number(result, "stick_ratio"), state.stick_ratio) << name;
      EXPECT_EQ(number(result, "twist"), state.twist) << name;
      const double a = number(result, "contact_radius");
      const double force = 0.1 * number(result, "normal_load");
      const double shear_modulus = 210e9 / (2.0 * 1.3) / 2.0;
      EXPECT_DOUBLE_EQ(number(result, "stick_radius"), state.stick_ratio * a);
      EXPECT_NEAR(number(result, "moment") / (state.moment * force * a), 1.0, kTolerance);
      EXPECT_NEAR(number(result, "twist_angle") / (state.twist * force / (shear_modulus * a * a)), 1.0,
                  kTolerance);
    }
  }
}

TEST(ExactModel, SaysThatTheScenesCouplingIsLeftOut) {
  const Json result = answer(exact_scene("dissimilar", {"contact.coupling=none"}));
  ASSERT_EQ(result["model"]["left_out"].size(), 2);
  EXPECT_EQ(result["model"]["left_out"][1]["what"], "K13, K23");
}

class ExactFieldFile : public ScratchFolder {
 protected:
  std::vector<solver::Column> sampled(const solver::Scene& scene) const {
    const fs::path file = folder_ / "exact.csv";
    write_exact_fields(file, scene, require_oracle(scene));
    return solver::read_columns(file, {"x1", "x2", "pressure", "q1", "q2", "stick"});
  }
};

TEST_F(ExactFieldFile, HoldsPressureAndTractionsAtTheCellCentres) {
  for (const std::string& name : kBodies) {
    const solver::Scene small = exact_scene(name, {"grid.cells=[24,20]"});
    const Oracle oracle = require_oracle(small);
    const std::vector<solver::Column> columns = sampled(small);
    const Eigen::ArrayXd& x1 = columns[0].values;
    const Eigen::ArrayXd& x2 = columns[1].values;
    ASSERT_GT(x1.size(), 200);  // of 480; those in contact
    for (Eigen::Index i = 0; i < x1.size(); ++i) {
      const double r = std::hypot(x1[i], x2[i]);
      const double q = oracle.traction(r);
      const double edge = 1e-12 * (1.0 + 1.0 / std::abs(1.0 - r / oracle.contact_radius));
      EXPECT_NEAR(columns[2].values[i] / oracle.pressure(r), 1.0, edge);
      EXPECT_NEAR(columns[3].values[i], -q * x2[i] / r, edge * q);
      EXPECT_NEAR(columns[4].values[i], q * x1[i] / r, edge * q);
      EXPECT_EQ(columns[5].values[i], r < oracle.stick_radius ? 1.0 : 0.0);
    }
  }
}

}  // namespace
}  // namespace slipstick::convergence
