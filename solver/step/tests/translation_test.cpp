#include <fmt/core.h>
#include <gtest/gtest.h>

#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/solve.hpp"
#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

/// A force moves it, and nothing turns it.
TEST(OneCell, MovesByItsOwnCoefficient) {
  constexpr double kSide = 2.9e-3;  // a third of it is hardly smaller than the contact
  const Solution solution = solve(read_scene_text(kShortScene, "pushed.toml",
                                                  {"grid.cells=[3, 3]", fmt::format("grid.extent=[{0}, {0}]", kSide),
                                                   "load.moment_ratio=0", "load.force=[30, -10]"}));
  EXPECT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_EQ(solution.contact_cells, 1);
  const HalfSpace steel{0.5 * paper::kYoungModulus / (1.0 + paper::kPoissonRatio), paper::kPoissonRatio};
  const HalfSpaces law(elastic_pair(steel, steel));
  const Grid cell{1, 1, kSide / 3.0, kSide / 3.0};
  const double compliance = law.influence_coefficients(Component::k11, cell)[0] / cell.cell_area();
  EXPECT_NEAR(solution.displacement[0] / (30.0 * compliance), 1.0, kSame);
  EXPECT_NEAR(solution.displacement[1] / (-10.0 * compliance), 1.0, kSame);
  EXPECT_EQ(solution.twist_angle, 0.0);
}

}  // namespace
}  // namespace slipstick::solver
