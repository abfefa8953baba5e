// Onto the friction discs, and onto those of their tractions that carry a moment.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "solver/contact/certificate.hpp"
#include "solver/grid/grid.hpp"
#include "solver/newton/admissible.hpp"
#include "solver/newton/tests/project_with_moment.hpp"
#include "solver/tests/limits.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr double kProjectionRounding = 1e-13;

ArrayXd random_values(Index count, double low, double high, std::mt19937& generator) {
  std::uniform_real_distribution<double> value(low, high);
  return ArrayXd::NullaryExpr(count, [&] { return value(generator); });
}

/// Vectors of all lengths below and above their bounds, a third of the cells out of contact.
struct ProjectionCase {
  explicit ProjectionCase(unsigned seed) : generator(seed) {
    const ArrayXd chance = random_values(grid.cells(), 0.0, 1.0, generator);
    bound = (chance < 0.3).select(0.0, random_values(grid.cells(), 0.2, 3.0, generator));
    z = random_values(2 * grid.cells(), -4.0, 4.0, generator);
    limit = (bound * norms(t)).sum();
  }
  double moment_of(const ArrayXd& q) const { return (q * t).sum(); }
  double excess(const ArrayXd& q) const { return (norms(q) - bound).maxCoeff(); }
  ArrayXd projected(double moment, double* alpha = nullptr) const {
    ArrayXd q = z;
    const double multiplier = project_with_moment(q, bound, grid, moment);
    if (alpha != nullptr) *alpha = multiplier;
    return q;
  }
  /// Some traction within the discs with that moment, by a path that shares nothing with the projection: from
  /// a random field within the discs straight towards the one at gross slip.
  ArrayXd random_admissible(double moment) {
    ArrayXd q = random_values(z.size(), -1.0, 1.0, generator);
    q *=
        (bound / norms(q)).replicate(2, 1) * random_values(bound.size(), 0.0, 1.0, generator).replicate(2, 1);
    const double sign = moment > moment_of(q) ? 1.0 : -1.0;
    const ArrayXd gross = sign * t * (bound / norms(t)).replicate(2, 1);
    const double part = (moment - moment_of(q)) / (moment_of(gross) - moment_of(q));
    return q + part * (gross - q);
  }

  Grid grid{8, 6, 1.0, 0.5};
  std::mt19937 generator;
  ArrayXd t = rotation_field(grid);
  ArrayXd bound, z;
  double limit = 0.0;
};

constexpr double kRatios[] = {-0.999999, -0.9, -0.3, 0.0, 0.5, 0.99, 0.999999};

TEST(FrictionDiscs, CutLongerVectorsAndLeaveOthers) {
  ArrayXd q(8);
  q << 3.0, 0.3, 1.0, 0.0,  //
      4.0, 0.4, 0.0, 2.0;
  ArrayXd bound(4);
  bound << 1.0, 1.0, 1.0, 0.0;
  FrictionDiscs(bound).project(q);
  ArrayXd expected(8);
  expected << 0.6, 0.3, 1.0, 0.0,  //
      0.8, 0.4, 0.0, 0.0;
  EXPECT_LE((q - expected).abs().maxCoeff(), kProjectionRounding);
  EXPECT_EQ(q[1], 0.3);
  q[1] = kNaN;
  FrictionDiscs(bound).project(q);
  EXPECT_TRUE(std::isnan(q[1]));
}

TEST(Projection, IsAdmissible) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const ProjectionCase of(seed);
    for (const double ratio : kRatios) {
      const ArrayXd q = of.projected(ratio * of.limit);
      EXPECT_LE(of.excess(q), kProjectionRounding);
      EXPECT_NEAR(of.moment_of(q) / of.limit, ratio, kProjectionRounding);
    }
  }
}

/// The projection of z + alpha t onto the discs: q - z - alpha t is zero within a disc and points inwards on
/// its rim.
TEST(Projection, FulfilsTheConditionsOfKarushKuhnAndTucker) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const ProjectionCase of(seed);
    for (const double ratio : kRatios) {
      double alpha = 0.0;
      const ArrayXd q = of.projected(ratio * of.limit, &alpha);
      const ArrayXd pull = of.z + alpha * of.t - q;
      const double scale = pull.abs().maxCoeff();
      const ArrayXd along = dot_products(pull, q);
      const ArrayXd size = norms(q);
      for (Index i = 0; i < of.bound.size(); ++i) {
        if (size[i] < of.bound[i] * (1.0 - kProjectionRounding)) {
          EXPECT_LE(norms(pull)[i], kProjectionRounding * scale);
        } else {
          EXPECT_NEAR(along[i], norms(pull)[i] * size[i], kProjectionRounding * scale);
        }
      }
    }
  }
}

TEST(Projection, IsNearerThanOtherAdmissibleTractions) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    ProjectionCase of(seed);
    for (const double ratio : {-0.9, 0.0, 0.5}) {
      const ArrayXd q = of.projected(ratio * of.limit);
      const double distance = (q - of.z).matrix().norm();
      for (int trial = 0; trial < 20; ++trial) {
        const ArrayXd other = of.random_admissible(ratio * of.limit);
        ASSERT_LE(of.excess(other), kProjectionRounding);
        ASSERT_NEAR(of.moment_of(other) / of.limit, ratio, kProjectionRounding);
        EXPECT_LT(distance, (other - of.z).matrix().norm());
        // Nor does a little of the way there lead nearer.
        EXPECT_LE(distance, (q + 1e-3 * (other - q) - of.z).matrix().norm());
      }
    }
  }
}

TEST(Projection, LeavesWhatItHasProjected) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const ProjectionCase of(seed);
    for (const double ratio : {-0.9, 0.0, 0.5}) {
      const ArrayXd once = of.projected(ratio * of.limit);
      ArrayXd twice = once;
      const double alpha = project_with_moment(twice, of.bound, of.grid, ratio * of.limit);
      EXPECT_LE((twice - once).abs().maxCoeff(), kProjectionRounding);
      EXPECT_NEAR(alpha, 0.0, kProjectionRounding);
    }
  }
}

TEST(Projection, DoesNotDependOnTheGuess) {
  const ProjectionCase of(1);
  double alpha = 0.0;
  const ArrayXd q = of.projected(0.7 * of.limit, &alpha);
  for (const double guess : {alpha, -1.0, 1e3, -1e9, kNaN, std::numeric_limits<double>::infinity()}) {
    ArrayXd other = of.z;
    EXPECT_NEAR(project_with_moment(other, of.bound, of.grid, 0.7 * of.limit, guess), alpha,
                kProjectionRounding);
    EXPECT_LE((other - q).abs().maxCoeff(), kProjectionRounding);
  }
}

/// At gross slip the other way round every cell lies on its rim and turns nowhere: the moment is flat in
/// alpha.
TEST(Projection, LeavesGrossSlipTheOtherWayRound) {
  ProjectionCase of(2);
  of.z = -1e6 * of.t;
  double alpha = 0.0;
  const ArrayXd q = of.projected(0.5 * of.limit, &alpha);
  EXPECT_GT(alpha, 1e6 - 100.0);
  EXPECT_NEAR(of.moment_of(q) / of.limit, 0.5, 1e-9);  // alpha t + z cancel to 1e-16 of 1e6
  EXPECT_LE(of.excess(q), kProjectionRounding);
}

TEST(Projection, OntoMomentsThatNothingCarriesFails) {
  ProjectionCase of(3);
  for (const double moment : {1.001 * of.limit, -1.1 * of.limit, kNaN}) {
    double alpha = 0.0;
    of.projected(moment, &alpha);
    EXPECT_TRUE(std::isnan(alpha)) << moment;
  }
  of.bound.setZero();
  double alpha = kNaN;
  EXPECT_TRUE((of.projected(0.0, &alpha) == 0.0).all());
  EXPECT_EQ(alpha, 0.0);
}

TEST(Projection, OfWhatIsNotFiniteFails) {
  ProjectionCase of(4);
  Index at = 0;
  of.bound.maxCoeff(&at);
  of.z[at] = kNaN;
  double alpha = 0.0;
  of.projected(0.5 * of.limit, &alpha);
  EXPECT_TRUE(std::isnan(alpha));
}

}  // namespace
}  // namespace slipstick::solver
