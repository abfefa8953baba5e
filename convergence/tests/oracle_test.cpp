#include "convergence/oracle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/scene.hpp"

namespace slipstick::convergence {
namespace {

// The paper's case with mu = 0.1, computed to 30 digits from Hertz's formulas and the elliptic integrals.
constexpr double kContactRadius = 0.48909732465087485e-3;
constexpr double kPeakPressure = 1995.9553043899548e6;
constexpr double kMomentLimit = 28.810210537755196e-3;
struct Case {
  const char* load;
  double stick_ratio;
  double twist;
};
constexpr Case kCases[] = {{"load.moment_ratio=0.1", 0.9693964204953627, 1.197249389022587e-4},
                           {"load.moment_ratio=0.5", 0.8135681261276496, 7.629453516649457e-4},
                           {"load.moment_ratio=0.9", 0.4958950522157781, 2.361048651456917e-3},
                           {"load.moment_ratio=0.99", 0.2369661925296642, 4.413921104595224e-3}};
// The published digits, and a few roundings on the way from a scene's moduli to the number.
constexpr double kTolerance = 1e-14;

solver::Scene paper(const std::vector<std::string>& overrides) {
  return solver::read_scene(SLIPSTICK_SCENES "/paper.toml", overrides);
}

TEST(Oracle, PaperCase) {
  for (const Case& c : kCases) {
    const OracleAnswer answer = find_oracle(paper({c.load}));
    ASSERT_TRUE(answer.oracle) << answer.reason;
    EXPECT_NEAR(answer.oracle->contact_radius / kContactRadius, 1.0, kTolerance);
    EXPECT_NEAR(answer.oracle->peak_pressure / kPeakPressure, 1.0, kTolerance);
    EXPECT_NEAR(answer.oracle->moment_limit / kMomentLimit, 1.0, kTolerance);
    EXPECT_NEAR(answer.oracle->state.stick_ratio / c.stick_ratio, 1.0, kTolerance) << c.load;
    EXPECT_NEAR(answer.oracle->twist_angle / c.twist, 1.0, kTolerance) << c.load;
  }
}

TEST(Oracle, TheSameStateByRatioMomentAndTwist) {
  const Oracle by_ratio = *find_oracle(paper({"load.moment_ratio=0.7"})).oracle;
  const auto with_load = [](const std::string& key, double value) {
    solver::Scene scene = paper({});
    scene.torsion = {};
    (key == "moment" ? scene.torsion.moment : scene.torsion.twist) = value;
    return *find_oracle(scene).oracle;
  };
  for (const Oracle& other :
       {with_load("moment", by_ratio.moment), with_load("twist", by_ratio.twist_angle)}) {
    EXPECT_NEAR(other.stick_radius / by_ratio.stick_radius, 1.0, kTolerance);
    EXPECT_NEAR(other.twist_angle / by_ratio.twist_angle, 1.0, kTolerance);
    EXPECT_NEAR(other.moment / by_ratio.moment, 1.0, kTolerance);
  }
}

TEST(Oracle, FieldsIntegrateToTheLoads) {
  const Oracle oracle = *find_oracle(paper({"load.moment_ratio=0.5"})).oracle;
  // Simpson's rule in r = a sin(t), piecewise about the stick edge, where the traction has a vertical
  // tangent.
  double force = 0.0;
  double moment = 0.0;
  const double edge = oracle.stick_radius;
  const double a = oracle.contact_radius;
  const auto integrate = [&](auto radius, auto slope) {
    constexpr int n = 2000;
    for (int i = 0; i <= n; ++i) {
      const double t = std::numbers::pi / 2 * i / n;
      const double weight = (i == 0 || i == n ? 1.0
                             : i % 2 == 1     ? 4.0
                                              : 2.0) *
                            std::numbers::pi / 2 / n / 3.0;
      const double r = radius(t);
      force += weight * slope(t) * 2.0 * std::numbers::pi * r * oracle.pressure(r);
      moment += weight * slope(t) * 2.0 * std::numbers::pi * r * r * oracle.traction(r);
    }
  };
  integrate([&](double t) { return edge * std::sin(t); }, [&](double t) { return edge * std::cos(t); });
  integrate([&](double t) { return edge + (a - edge) * std::sin(t); },
            [&](double t) { return (a - edge) * std::cos(t); });
  constexpr double quadrature_error = 1e-6;  // the traction behaves like a square root at t = pi/2
  EXPECT_NEAR(force / 1000.0, 1.0, quadrature_error);
  EXPECT_NEAR(moment / oracle.moment, 1.0, quadrature_error);
}

TEST(Oracle, SaysWhyThereIsNone) {
  const auto reason = [](const char* scene, const std::vector<std::string>& overrides) {
    const OracleAnswer answer =
        find_oracle(solver::read_scene(std::string(SLIPSTICK_SCENES) + scene, overrides));
    return answer.oracle ? std::string() : answer.reason;
  };
  EXPECT_NE(reason("/ellipse.toml", {}).find("ellipsoid"), std::string::npos);
  EXPECT_NE(reason("/dissimilar.toml", {}).find("coupling"), std::string::npos);
  EXPECT_EQ(reason("/dissimilar.toml", {"contact.coupling=none"}), "");
  EXPECT_NE(reason("/paper.toml", {"load.moment=0.02882"}).find("gross slip"), std::string::npos);
  EXPECT_NE(reason("/paper.toml", {"load.twist=1e3"}).find("range"), std::string::npos);
  EXPECT_NE(reason("/paper.toml", {"contact.friction=0"}).find("friction"), std::string::npos);
}

}  // namespace
}  // namespace slipstick::convergence
