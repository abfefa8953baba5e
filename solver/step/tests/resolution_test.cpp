#include "solver/step/resolution.hpp"

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

/// The resolution of tractions that reach half of the bound where the contact sticks, and all of it elsewhere.
Resolution resolution_of(const Grid& grid, const LoadStep& loads, const ArrayXd& stick) {
  const ArrayXd& bound = loads.problem.friction_bound;
  TangentialSolution tangential;
  tangential.stick = stick;
  tangential.traction = ArrayXd::Zero(2 * grid.cells());
  tangential.traction.head(grid.cells()) = bound * (1.0 - 0.5 * stick);
  return resolution({}, {}, grid, loads, tangential, counted_area(grid, bound));
}

TEST(Resolution, WidthsOfACircleAndItsRingAreThoseOfTheCircles) {
  const Grid grid{80, 80, 1.0, 1.0};
  const LoadStep loads = disc_under_moment(grid, 36.0, 0.5);
  const ArrayXd stick = (cell_x1(grid).square() + cell_x2(grid).square() < 20.0 * 20.0).cast<double>();
  const Resolution found = resolution_of(grid, loads, stick);
  EXPECT_NEAR(found.stick_width, 40.0, 4.0);  // a staircase follows a circle to a tenth
  EXPECT_NEAR(found.slip_width, 16.0, 1.6);
}

// The whole strip sticks under a constant pressure. Its error has the part of h/r everywhere and at a sharp
// edge, and 3/2 of the relative error of the counted area, with h/r = pi/(2 n) along an axis of n cells. The
// axes may be exchanged.
TEST(Resolution, OfAStripHasBothAxesInTheMean) {
  const double cell = std::numbers::pi * std::sqrt((1.0 / (40 * 40) + 1.0 / (20 * 20)) / 8.0);
  for (const auto& [n1, n2] : {std::pair{40, 20}, {20, 40}}) {
    const Grid grid{n1 + 4, n2 + 6, 1.0, 1.0};
    LoadStep loads{};
    loads.problem.friction_bound = (cell_x1(grid).abs() < 0.5 * n1 && cell_x2(grid).abs() < 0.5 * n2).cast<double>();
    loads.limit.factor = INFINITY;
    const Resolution found = resolution_of(grid, loads, loads.problem.friction_bound);
    const CountedArea area = counted_area(grid, loads.problem.friction_bound);
    EXPECT_NEAR(found.step, 0.26 * cell * cell + 0.2 * cell + 1.5 * area.uncertainty / area.counted, 1e-12) << n1;
    // Half of a constant bound hides a ring of pi^2/16 of a quarter of a cell along an outline of all sides.
    const double outline = 0.25 * std::numbers::pi * 2.0 * (n1 + n2);
    EXPECT_NEAR(found.stick_area, std::pow(std::numbers::pi / 8.0, 2) * outline, 1e-9) << n1;
  }
}

TEST(Resolution, IsUnknownWhereNoCellSticksThoughOneShould) {
  const Grid grid{20, 20, 1.0, 1.0};
  for (const double inner : {0.0, 5.0}) {  // the body turns about a point of the contact, or about none
    const LoadStep loads = disc_under_moment(grid, 9.0, 1.0 - 1e-9, inner);
    EXPECT_TRUE(std::isinf(resolution_of(grid, loads, ArrayXd::Zero(400)).open.twist)) << inner;
  }
}

}  // namespace
}  // namespace slipstick::solver
