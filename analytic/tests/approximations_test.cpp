#include "analytic/approximations.hpp"

#include <stdexcept>

#include "analytic/paper_equations.hpp"
#include "analytic/tests/values.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic {
namespace {

const double kLimit = hertz_profile().moment_limit();

double error(double (*twist)(double), double moment_ratio) {
  const auto state = from_moment_ratio(moment_ratio);
  return twist(state.moment) / state.twist - 1;
}

/// By how much a law's error falls when a small moment is halved: 2 to its order.
double error_ratio(double (*twist)(double)) {
  constexpr double kSmall = 1e-3;
  return error(twist, kSmall) / error(twist, kSmall / 2);
}

TEST(NoSlip, IsTheTangentAtNoLoad) {
  EXPECT_NEAR(error_ratio(no_slip_twist), 2, 0.01);
  EXPECT_NEAR(no_slip_twist(0.3), 0.3 / from_moment_ratio(0).tangent_stiffness, 1e-17);
}

TEST(SmallMoments, HoldToSecondOrder) { EXPECT_NEAR(error_ratio(small_moment_twist), 4, 0.02); }

TEST(DiscreteElements, CarryMoreThanTheContactCan) {
  EXPECT_NEAR(dem_moment_limit() / kLimit, 32 / (9 * pi), 1e-15);
  EXPECT_EQ(dem_moment(1), dem_moment_limit());
  EXPECT_EQ(dem_moment(HUGE_VAL), dem_moment_limit());
  EXPECT_GT(dem_moment(from_moment_ratio(0.999).twist) / kLimit, 1.13);
}

TEST(DiscreteElements, FollowTheirSpringUpToTheCap) {
  for (const double moment : {0.0, 1e-9, 0.3, 0.6}) EXPECT_DOUBLE_EQ(dem_moment(dem_twist(moment)), moment);
  EXPECT_DOUBLE_EQ(dem_twist(dem_moment_limit()), 1.0 / 8);
  for (const double moment : {1e-3, 0.5}) EXPECT_EQ(dem_twist(moment), no_slip_twist(moment));
}

/// The table at the head of approximations.hpp, in percent.
TEST(Approximations, AreOffAsTabulated) {
  struct Point {
    double moment_ratio, no_slip, small_moment, eq7, dem_moment;
  };
  for (const auto& point : {Point{0.1, -4.5, -0.29, -0.093, 4.7},
                            {0.5, -25.1, -8.5, -3.4, 33.5},
                            {0.9, -56.4, -39.1, -23.6, 25.8}}) {
    const double m = point.moment_ratio;
    EXPECT_NEAR(100 * error(no_slip_twist, m), point.no_slip, 0.05) << m;
    EXPECT_NEAR(100 * error(dem_twist, m), point.no_slip, 0.05) << m;
    EXPECT_NEAR(100 * error(small_moment_twist, m), point.small_moment, m < 0.5 ? 0.005 : 0.05) << m;
    EXPECT_NEAR(100 * error(paper::eq7_twist, m), point.eq7, m < 0.5 ? 0.0005 : 0.05) << m;
    const auto state = from_moment_ratio(m);
    EXPECT_NEAR(100 * (dem_moment(state.twist) / state.moment - 1), point.dem_moment, 0.05) << m;
  }
  EXPECT_NEAR(100 * (dem_moment(1.0 / 8) / from_twist(1.0 / 8).moment - 1), 62, 0.5);
}

/// Slip only softens: a law that neglects some of it is too stiff.
TEST(Approximations, AreAllTooStiff) {
  for (const auto& law : approximations()) {
    for (const double m : {0.01, 0.1, 0.5, 0.9, 0.9999})
      EXPECT_LT(error(law.twist, m), 0) << law.name << ' ' << m;
    EXPECT_EQ(law.twist(0), 0) << law.name;
    EXPECT_NO_THROW(law.twist(kLimit)) << law.name;
  }
}

TEST(Approximations, RefuseWhatLiesOutside) {
  for (const auto& law : approximations())
    for (const double bad : {-1e-300, 0.67, HUGE_VAL, kNan})
      EXPECT_THROW(law.twist(bad), std::domain_error) << law.name << ' ' << bad;
  for (const double beyond : {0.59, 0.66}) {
    EXPECT_THROW(no_slip_twist(beyond), std::domain_error);
    EXPECT_THROW(small_moment_twist(beyond), std::domain_error);
  }
  for (const double bad : {-1e-300, -HUGE_VAL, kNan}) EXPECT_THROW(dem_moment(bad), std::domain_error) << bad;
}

}  // namespace
}  // namespace slipstick::analytic
