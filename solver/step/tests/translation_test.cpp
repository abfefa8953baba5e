#include <fmt/core.h>
#include <gmock/gmock.h>

#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/solve.hpp"
#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

/// Contacts that are pushed as well as turned, up to what they can carry.
namespace slipstick::solver {
namespace {

Solution solved(const std::vector<std::string>& keys) {
  Solution solution = solve(read_scene_text(kShortScene, "pushed.toml", keys));
  EXPECT_EQ(solution.status, Status::converged) << solution.message;
  return solution;
}

/// A force moves it, and nothing turns it.
TEST(OneCell, MovesByItsOwnCoefficient) {
  constexpr double kSide = 2.9e-3;  // a third of it is hardly smaller than the contact
  const Solution solution = solved({"grid.cells=[3, 3]", fmt::format("grid.extent=[{0}, {0}]", kSide),
                                    "load.moment_ratio=0", "load.force=[30, -10]"});
  EXPECT_EQ(solution.contact_cells, 1);
  const HalfSpace steel{0.5 * paper::kYoungModulus / (1.0 + paper::kPoissonRatio), paper::kPoissonRatio};
  const HalfSpaces law(elastic_pair(steel, steel));
  const Grid cell{1, 1, kSide / 3.0, kSide / 3.0};
  const double compliance = law.influence_coefficients(Component::k11, cell)[0] / cell.cell_area();
  EXPECT_NEAR(solution.displacement[0] / (30.0 * compliance), 1.0, kSame);
  EXPECT_NEAR(solution.displacement[1] / (-10.0 * compliance), 1.0, kSame);
  EXPECT_EQ(solution.twist_angle, 0.0);
}

TEST(MomentRatio, IsOfTheLimitWithoutForce) {
  const Solution alone = solved({"load.moment_ratio=0.5"});
  const Solution with_force = solved({"load.moment_ratio=0.5", "load.force=[55, 23]"});
  EXPECT_NEAR(with_force.moment_limit / alone.moment_limit, 1.0, kSame);
  EXPECT_NEAR(with_force.moment / (0.5 * with_force.moment_limit), 1.0, 1e-12);
  EXPECT_GT(with_force.limit.factor, 1.0);
  EXPECT_LT(with_force.limit.factor, alone.limit.factor);
}

TEST(Limit, RefusesMoreThanTheContactCanCarry) {
  const auto refused = [](const std::vector<std::string>& keys) { return complaint([&] { solved(keys); }); };
  EXPECT_THAT(refused({"load.force=[125, 0]", "load.moment_ratio=0"}),
              says("load.force", "[125, 0] N", "0.8 times these", "along (1, "));
  EXPECT_THAT(refused({"load.force=[90, 0]", "load.moment_ratio=0.9"}),
              says("load.force", "turning about ("));
  EXPECT_THAT(refused({"upper.at=[2.445e-4, -3.424e-4]", "grid.cells=[40, 40]",
                       "grid.extent=[1.956e-3, 1.956e-3]", "load.moment=0.0317"}),
              says("load.moment = ", "turning about (0.0002445, -0.0003424) m"));
  // No force in one direction is too large where the other motion is imposed.
  EXPECT_NEAR(solved({"load.force=[99, 0]", "load.twist=1e-3"}).force[0], 99.0, 1e-9);
}

}  // namespace
}  // namespace slipstick::solver
