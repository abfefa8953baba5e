// The rigid motion that Coulomb's law fits best.

#include "solver/contact/fitted_motion.hpp"

#include <gtest/gtest.h>

#include "solver/contact/certificate.hpp"
#include "solver/grid/grid.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::VectorXd;

/// A made state that keeps Coulomb's law in a motion: cells within half the radius stick, at half their
/// bound; the others slip, as any field says, against their traction.
struct MadeState {
  std::vector<ArrayXd> motions;
  ArrayXd bound, traction, displacement;
  VectorXd motion{{0.3, -0.2, 1.7}};

  MadeState() {
    const Grid grid{16, 12, 1.0, 1.2};
    const Eigen::Index cells = grid.cells();
    const ArrayXd radius = norms(rotation_field(grid)) / 8.0;
    bound = (1.0 - radius.square()).max(0.0);
    for (const int component : {0, 1}) {
      motions.push_back(ArrayXd::Zero(2 * cells));
      motions.back().segment(component * cells, cells).setOnes();
    }
    motions.push_back(rotation_field(grid));
    const ArrayXd slips = (radius > 0.5).cast<double>();
    const ArrayXd slip = slips.replicate(2, 1) * ArrayXd::Random(2 * cells);
    const ArrayXd size = norms(slip).max(1e-300);
    traction = 0.5 * (1.0 - slips).replicate(2, 1) * bound.replicate(2, 1) * ArrayXd::Random(2 * cells) -
               (slips * bound / size).replicate(2, 1) * slip;
    displacement = slip;
    for (Eigen::Index k = 0; k < 3; ++k) displacement += motion[k] * motions[static_cast<std::size_t>(k)];
  }
};

TEST(FittedMotion, IsTheOneInWhichCoulombsLawHolds) {
  const MadeState made;
  const FittedMotion fitted = fit_motion(made.displacement, made.traction, made.bound, made.motions);
  EXPECT_LE((fitted.coefficients - made.motion).norm(), 1e-7);
  EXPECT_LE(fitted.gap.sum(), 1e-6 * made.bound.sum());
}

// Convex: from the fitted motion the gap rises in every direction.
TEST(FittedMotion, HasTheLeastGapOfAnyTractions) {
  MadeState made;
  made.traction = made.bound.replicate(2, 1) * 0.6 * ArrayXd::Random(made.traction.size());
  const FittedMotion fitted = fit_motion(made.displacement, made.traction, made.bound, made.motions);
  const auto gap = [&](const VectorXd& z) {
    ArrayXd s = made.displacement;
    for (Eigen::Index k = 0; k < 3; ++k) s -= z[k] * made.motions[static_cast<std::size_t>(k)];
    return (dot_products(made.traction, s) + made.bound * norms(s)).sum();
  };
  EXPECT_NEAR(gap(fitted.coefficients), fitted.gap.sum(), 1e-12 * fitted.gap.sum());
  for (Eigen::Index k = 0; k < 3; ++k) {
    for (const double step : {-1e-3, 1e-3}) {
      EXPECT_GT(gap(fitted.coefficients + step * VectorXd::Unit(3, k)), fitted.gap.sum());
    }
  }
}

TEST(FittedMotion, OfNoFreeMotionLeavesTheDisplacement) {
  const MadeState made;
  const FittedMotion fitted = fit_motion(made.displacement, made.traction, made.bound, {});
  const ArrayXd contact = (made.bound > 0.0).cast<double>();
  EXPECT_TRUE((fitted.slip == contact.replicate(2, 1) * made.displacement).all());
}

}  // namespace
}  // namespace slipstick::solver
