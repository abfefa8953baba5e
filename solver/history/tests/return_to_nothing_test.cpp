#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>

#include "solver/solve.hpp"
#include "solver/tests/scene_file.hpp"

/// Loads that fall to zero or nearly to zero, and numbers that nearly vanish.
namespace slipstick::solver {
namespace {

using testing::HasSubstr;

/// The part of earlier tractions and motions that rounding leaves.
constexpr double kNothing = 1e-8;

class Nothing : public SceneFile {
 protected:
  /// Each "[[step]]" with these keys, after the short scene with these changes.
  std::vector<Solution> steps_of(const std::vector<std::string>& steps, std::vector<std::string> changes = {},
                                 const std::string& above = "") const {
    std::string text = above + kShortScene;
    for (const std::string& step : steps) text += "[[step]]\n" + step + "\n";
    std::vector<Solution> solved;
    SolveOptions options;
    options.observer.step = [&](const Solution& at) {
      EXPECT_EQ(at.status, Status::converged) << at.loads.key << ": " << at.message;
      solved.push_back(at);
    };
    solve(read(text, changes), options);
    return solved;
  }

  static double largest(const Eigen::ArrayXd& field) { return field.abs().maxCoeff(); }

  /// Its pressure is infinite at the edge; 300 N are its limit.
  const std::vector<std::string> punch_{"upper.shape=flat_punch", "upper.radius=0.0005",
                                        "contact.friction=0.3", "load.moment_ratio=0"};
};

/// Where nothing slips the answer is linear in the load: nothing is left, and a part leaves that part.
TEST_F(Nothing, IsLeftWhereAllStuck) {
  for (const std::string force : {"1", "30", "120"}) {
    for (const std::string part : {"0", "e-5"}) {
      const std::string least = part == "0" ? part : force + part;
      const auto steps = steps_of({"force = [" + force + ", 0]", "force = [" + least + ", 0]"}, punch_);
      ASSERT_EQ(steps[0].stick_cells, steps[0].contact_cells);
      const double left = part == "0" ? 0.0 : 1e-5;
      EXPECT_LE(largest(steps[1].traction - left * steps[0].traction), kNothing * largest(steps[0].traction));
      EXPECT_NEAR(steps[1].displacement[0] / steps[0].displacement[0], left, kNothing);
      EXPECT_NEAR(steps[1].certificate.energy / steps[0].elastic_energy, 1.0, kNothing);
    }
  }
}

/// Near zero load, the remaining energy is hardly above the rounding of the energy before.
TEST_F(Nothing, IsReachedThroughTheRoundingOfEnergies) {
  for (const char* part : {"1.255e-4", "1.842e-4", "2.012e-4", "3e-4", "4.319e-4", "5.439e-4"}) {
    const auto steps = steps_of({"force = [1, 0]", fmt::format("force = [{}, 0]", part)},
                                {"upper.shape=flat_punch", "upper.radius=0.0005", "contact.friction=0.3",
                                 "load.moment_ratio=0", "grid.cells=[24, 24]"});
    EXPECT_LE(steps[1].certificate.gap, 1e-8);
  }
}

/// The tractions that stay meet Coulomb's law under the load that stays, over an energy that this load can
/// hold.
TEST_F(Nothing, IsLeftOfTheNormalLoad) {
  for (const double load : {1.0, 1e-4}) {
    const auto steps =
        steps_of({"moment_ratio = 0.4", fmt::format("normal = {}\nmoment_ratio = 0", load)}, punch_);
    EXPECT_LE(steps[1].certificate.friction_bound, kNothing);
    EXPECT_LE(std::abs(steps[1].moment), kNothing * steps[1].moment_limit);
    EXPECT_LE(steps[1].certificate.energy,
              std::max(steps[1].elastic_energy, 1e-3 * load * steps[0].elastic_energy));
  }
}

/// A cell does not push itself aside.
TEST_F(Nothing, IsCarriedByOneCellOfDissimilarBodies) {
  const Solution one =
      steps_of({""}, {"lower.young_modulus=70e9", "upper.at=[1e-4, 1e-4]", "load.normal=1",
                      "load.moment_ratio=0", "grid.cells=[16, 16]", "grid.extent=[0.0032, 0.0032]"})[0];
  EXPECT_EQ(one.contact_cells, 1);
  EXPECT_EQ(largest(one.traction), 0.0);
  EXPECT_EQ(one.certificate.gap, 0.0);
  EXPECT_TRUE(std::isnan(one.slip_direction.mean) && std::isnan(one.slip_direction.max));
}

/// A load that a step leaves out stays as it was, in the second cycle too: to the bits of the steps written
/// out.
TEST_F(Nothing, IsForgottenBetweenCycles) {
  const std::vector<std::string> steps{"moment_ratio = 0.1", "normal = 700\nforce = [0, 0]"};
  const auto in_cycles = steps_of(steps, {"load.force=[30, 0]"}, "cycles = 2\n");
  const auto written = steps_of({steps[0], steps[1], steps[0], steps[1]}, {"load.force=[30, 0]"});
  ASSERT_EQ(in_cycles.size(), written.size());
  for (std::size_t k = 0; k < written.size(); ++k) {
    EXPECT_EQ(in_cycles[k].twist_angle, written[k].twist_angle);
    EXPECT_TRUE((in_cycles[k].traction == written[k].traction).all());
  }
  EXPECT_NEAR(in_cycles[2].normal_load, 700.0, 1e-6);
  EXPECT_TRUE(std::isnan(in_cycles[2].slip_direction.mean));  // nothing changes, so nothing slips
  EXPECT_LE(in_cycles[1].slip_direction.mean, 1e-3);
}

/// A model with a last digit leaves out the same as one without it, and gives the same twist.
TEST_F(Nothing, IsTheCostOfALastDigit) {
  const Solution plain = solve(read(kShortScene));
  ASSERT_EQ(plain.left_out.size(), 5U);  // coupling, translations, the grid's rim, three quarters, one field
  for (const char* change : {"lower.poisson_ratio=0.30000000000000004", "upper.at=[1e-17, 0]",
                             "load.force=[1e-300, 0]", "upper.young_modulus=210000000000.0001"}) {
    const Solution changed = solve(read(kShortScene, {change}));
    EXPECT_NEAR(changed.twist_angle / plain.twist_angle, 1.0, 1e-10) << change;
    for (const Omission& part : plain.left_out) {
      EXPECT_THAT(changed.left_out, Contains(testing::Field(&Omission::what, part.what))) << change;
    }
  }
  EXPECT_NE(solve(read(kShortScene, {"load.force=[1e-7, 0]"})).force[0], 0.0);
  EXPECT_TRUE(read(kShortScene, {"solver.model=full", "load.force=[1e-300, 0]"}).left_out.empty());
}

/// The limit in numbers, where a factor of the loads would be 1.
TEST_F(Nothing, IsSaidByAFactorOfOne) {
  const auto refused = [&](const std::string& force) {
    return complaint([&] { steps_of({}, {"load.moment_ratio=0", "load.force=[" + force + ", 0]"}); });
  };
  EXPECT_THAT(refused("100.0000001"),
              testing::AllOf(HasSubstr("[99.99999"), testing::Not(HasSubstr("1 times"))));
  EXPECT_THAT(refused("125"), HasSubstr("0.8 times these: ["));
}

}  // namespace
}  // namespace slipstick::solver
