#include "solver/resolution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// A step of a disc of radius a (in cells), or of a ring, whose pressure is constant, under a moment.
LoadStep disc_under_moment(const Grid& grid, double a, double moment_ratio, double inner = 0.0) {
  LoadStep loads{};
  const ArrayXd r = (cell_x1(grid).square() + cell_x2(grid).square()).sqrt();
  loads.problem.friction_bound = (r < a && r >= inner).cast<double>();
  loads.problem.moment = moment_ratio * moment_limit(grid, loads.problem.friction_bound);
  loads.limit = limit_of(loads.problem, grid);
  return loads;
}

TEST(Resolution, WidthsOfACircleAndItsRingAreThoseOfTheCircles) {
  const Grid grid{80, 80, 1.0, 1.0};
  const LoadStep loads = disc_under_moment(grid, 36.0, 0.5);
  const ArrayXd stick = (cell_x1(grid).square() + cell_x2(grid).square() < 20.0 * 20.0).cast<double>();
  const Resolution found = resolution({}, {}, grid, loads, stick);
  EXPECT_NEAR(found.stick_width, 40.0, 4.0);  // a staircase follows a circle to a tenth
  EXPECT_NEAR(found.slip_width, 16.0, 1.6);
}

// All of it sticks under a constant pressure: what h/r leaves everywhere, at a sharp edge and where slip is
// narrow, with h/r = pi/(2 n) along an axis of n cells. Which of them is the longer does not matter.
TEST(Resolution, OfAStripHasBothAxesInTheMean) {
  const double cell = std::numbers::pi * std::sqrt((1.0 / (40 * 40) + 1.0 / (20 * 20)) / 8.0);
  for (const auto& [n1, n2] : {std::pair{40, 20}, {20, 40}}) {
    const Grid grid{n1 + 4, n2 + 6, 1.0, 1.0};
    LoadStep loads{};
    loads.problem.friction_bound =
        (cell_x1(grid).abs() < 0.5 * n1 && cell_x2(grid).abs() < 0.5 * n2).cast<double>();
    loads.limit.factor = INFINITY;
    const Resolution found = resolution({}, {}, grid, loads, loads.problem.friction_bound);
    EXPECT_NEAR(found.step, 0.26 * cell * cell + 0.22 * cell + 0.65 * std::pow(cell, 1.5), 1e-12) << n1;
  }
}

TEST(Resolution, IsUnknownWhereNoCellSticksThoughOneShould) {
  const Grid grid{20, 20, 1.0, 1.0};
  for (const double inner : {0.0, 5.0}) {  // the body turns about a point of the contact, or about none
    const LoadStep loads = disc_under_moment(grid, 9.0, 1.0 - 1e-9, inner);
    EXPECT_TRUE(std::isinf(resolution({}, {}, grid, loads, ArrayXd::Zero(400)).open.twist)) << inner;
  }
}

TEST(Resolution, NearGrossSlipTurnsFromGoodToPoor) {
  double last = 0.0;
  for (const double missing : {0.1, 1e-2, 1e-4, 1e-6}) {
    const ModelSolution solution = solve_in_model_units(paper_scene(32, 1.0 - missing));
    ASSERT_EQ(solution.status, Status::converged);
    EXPECT_GT(solution.resolution.uncertainty, last);
    last = solution.resolution.uncertainty;
  }
  EXPECT_GT(last, kPoorlyResolved);
  EXPECT_LT(solve_in_model_units(paper_scene(32, 0.5)).resolution.uncertainty, 0.02);
}

TEST(Resolution, OfAnImposedTwistIsTheMeshAlone) {
  Scene scene = paper_scene(32, 0.0);
  scene.steps[0].torsion = Twist{1.0};  // far beyond where all has slipped
  EXPECT_LT(solve_in_model_units(scene).resolution.uncertainty, 0.01);
}

}  // namespace
}  // namespace slipstick::solver
