// Where the two sides meet: numerical answers against exact ones.

#include <cmath>
#include <limits>

#include "convergence/oracle/errors.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

struct Compared {
  solver::Solution solution;
  Errors errors;
};

Compared solve_scene(solver::Scene body, int cells) {
  body.grid.cells = {cells, cells};
  const solver::Solution solution = solver::solve(body);
  EXPECT_EQ(solution.status, solver::Status::converged) << solution.message;
  return {solution, compare(solution, *find_oracle(body).oracle)};
}

// The promised accuracy at 128 cells with the pressure solved on the same grid.
constexpr double kTwistAt128 = 2e-4;
constexpr double kTractionAt128 = 1e-2;

/// Between a sphere and a flat punch. Twist about h^2, pressure about h^1.5 in L1 for its steep edge,
/// over a factor 4 in h; half an order is left for the staircase of contact and stick area.
TEST(Comparison, AFlatBodyFallsWithTheMesh) {
  solver::Scene body = example("rounded_punch");
  body.surfaces = {{.shape = solver::Shape::power, .exponent = 4.0, .coefficient = 1e8}};
  const Errors coarse = solve_scene(body, 32).errors;
  const Errors fine = solve_scene(body, 128).errors;
  EXPECT_LE(std::abs(fine.twist), std::abs(coarse.twist) * std::pow(4.0, -1.5));
  EXPECT_LE(fine.pressure.l1, coarse.pressure.l1 * std::pow(4.0, -1.0));
  EXPECT_LE(std::abs(fine.twist), kTwistAt128);
  EXPECT_LE(fine.traction.at_centres.l1, kTractionAt128);
  EXPECT_LE(std::abs(fine.stick_radius), 5e-3);   // half a cell of 60 to the radius
  EXPECT_LE(std::abs(fine.peak_pressure), 1e-3);  // h^2, at a peak that a cell may miss by half of it
}

/// A solution that is the exact one but for a part of one number shows that part, along either axis.
TEST(Comparison, SeesEachComponentOfADisplacement) {
  const solver::Scene mindlin = example("mindlin", {"grid.cells=[24,24]", "load.force=[30.0, 40.0]"});
  const Oracle oracle = *find_oracle(mindlin).oracle;
  solver::Solution solution = solver::solve(mindlin);
  solution.displacement = oracle.displacement;
  EXPECT_EQ(compare(solution, oracle).displacement, 0.0);
  const double length = std::hypot(oracle.displacement[0], oracle.displacement[1]);
  for (const std::size_t along : {0, 1}) {
    solution.displacement = oracle.displacement;
    solution.displacement[along] += 1e-3 * length;
    EXPECT_NEAR(compare(solution, oracle).displacement, 1e-3, 1e-12) << along;
  }
}

/// A cell that is no number is the worst of all, wherever it stands.
TEST(Comparison, ANumberThatIsNoneIsNotSkipped) {
  const solver::Scene paper = example("paper", {"grid.cells=[16,16]"});
  const Oracle oracle = *find_oracle(paper).oracle;
  const solver::Solution solution = solver::solve(paper);
  for (const Eigen::Index cell : {8 * 16 + 8, 4 * 16 + 8, 8 * 16 + 12}) {
    solver::Solution bad = solution;
    bad.pressure[cell] = std::numeric_limits<double>::quiet_NaN();
    const FieldError pressure = compare(bad, oracle).pressure;
    for (const double error : {pressure.l1, pressure.l2, pressure.max})
      EXPECT_TRUE(std::isnan(error)) << cell;
    for (const Eigen::Index component : {0, 256}) {
      bad = solution;
      bad.traction[component + cell] = std::numeric_limits<double>::quiet_NaN();
      const TractionError traction = compare(bad, oracle).traction;
      EXPECT_TRUE(std::isnan(traction.at_centres.max)) << cell;
      EXPECT_TRUE(std::isnan(traction.averaged.max)) << cell;
    }
  }
}

// The exact peak is infinite, and so is a cone's pressure in a cell at the axis.
TEST(Comparison, LeavesOutWhatIsInfinite) {
  for (const char* name : {"cone", "flat_punch"}) {
    const Compared odd = solve_scene(example(name, {"load.moment_ratio=0.5"}), 33);
    EXPECT_TRUE(std::isnan(odd.errors.peak_pressure)) << name;
    for (const FieldError& field : {odd.errors.pressure, odd.errors.traction.at_centres}) {
      for (const double error : {field.l1, field.l2, field.max}) EXPECT_TRUE(std::isfinite(error)) << name;
    }
  }
}

}  // namespace
}  // namespace slipstick::convergence
