// Exact answers under laws of friction that do not follow the pressure: statics and Masing's rule.

#include <gtest/gtest.h>

#include "convergence/oracle/tests/histories.hpp"

namespace slipstick::convergence {
namespace {

using namespace solver;

constexpr double kPeak = 2e9;  // Pa, about as on the paper's sphere

FrictionLaw law_of(FrictionKind kind, double exponent = 1.0) {
  FrictionLaw law = 0.1 * std::pow(kPeak, 1.0 - exponent);
  law.kind = kind;
  law.exponent = exponent;
  law.shear_strength = 0.05 * kPeak;
  return law;
}

const std::vector<FrictionLaw>& laws() {
  static const std::vector<FrictionLaw> all{law_of(FrictionKind::tresca), law_of(FrictionKind::capped),
                                            law_of(FrictionKind::power, 0.5), law_of(FrictionKind::power, 2.0 / 3.0)};
  return all;
}

Scene under(const FrictionLaw& law, double moment_ratio, const std::string& body = "paper") {
  Scene scene = example(body);
  scene.contact.friction = law;
  scene.steps.front().torsion = solver::MomentRatio{moment_ratio};
  return scene;
}

TEST(FrictionLawOracle, TractionsCarryTheMomentWithinTheBound) {
  for (const FrictionLaw& law : laws()) {
    for (const double ratio : {0.2, 0.7, 0.97}) {
      const OracleAnswer answer = find_oracle(under(law, ratio));
      ASSERT_TRUE(answer.oracle) << answer.reason;
      const Oracle& oracle = *answer.oracle;
      EXPECT_NEAR(loads_carried_by(oracle).moment / oracle.friction.moment_limit, ratio, 2e-6);
      for (const double part : {0.01, 0.3, 0.6, 0.9, 0.99}) {
        const double radius = part * oracle.contact_radius;
        const double bound = law.bound(oracle.pressure(radius));
        if (radius < oracle.stick_radius) {
          EXPECT_LT(oracle.traction(radius), bound);
        } else {
          EXPECT_NEAR(oracle.traction(radius) / bound, 1.0, 1e-12);
        }
      }
    }
  }
}

/// After m1 and back to m2 the twist is phi(m1) - 2 phi((m1 - m2)/2).
TEST(FrictionLawOracle, FollowsMasingsRule) {
  for (const FrictionLaw& law : laws()) {
    const Scene scene = twisted(under(law, 0.8), {0.8, -0.4});
    auto history = exact_history(scene);
    history.advance(scene.steps[0]);
    const Oracle back = history.advance(scene.steps[1]).oracle.value();
    const auto first_loading = [&](double ratio) { return find_oracle(under(law, ratio)).oracle->twist_angle; };
    const double expected = first_loading(0.8) - 2.0 * first_loading(0.6);
    EXPECT_NEAR(back.twist_angle / expected, 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace slipstick::convergence
