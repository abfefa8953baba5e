// The error that two meshes leave, where the answer on the coarser one is solved and that on the finer one
// made: so that the two are known to be apart by a part.

#include "convergence/solve/reached.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/solve/measured_accuracy.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/grid/grid_transfer.hpp"

namespace slipstick::convergence {
namespace {

constexpr double kApart = 0.25;  ///< more than what is put down to any mesh as fine as these

/// A scene of which no exact answer is asked, and a made answer on its mesh: each number and traction is that
/// on half as many cells, times a factor.
struct TwoMeshes {
  solver::Scene scene;
  solver::Solution fine;

  TwoMeshes(const std::string& name, const std::string& load, double factor)
      : scene(example(name, {"grid.cells=[48,48]", load})), fine(solver::solve(scene)) {
    solver::Scene half = scene;
    half.grid.cells = {24, 24};
    half.grid.extent = {48.0 * fine.grid.h1, 48.0 * fine.grid.h2};
    const solver::Solution coarse = solver::solve(half);
    fine.twist_angle = factor * coarse.twist_angle;
    fine.moment = factor * coarse.moment;
    fine.stick_radius = factor * coarse.stick_radius;
    for (const solver::Index component : {0, 1}) {
      for (solver::Index i = 0; i < 48; ++i) {
        for (solver::Index j = 0; j < 48; ++j) {
          fine.traction[(component * 48 + i) * 48 + j] =
              factor * coarse.traction[(component * 24 + i / 2) * 24 + j / 2];
        }
      }
    }
  }

  ReachedError error(AccuracyOf of) const { return reached_error(scene, fine, Json::object(), of); }
};

const std::string kHalfTheLimit = "load.moment_ratio=0.5";

// A relative distance d of two values, of which the finer one is larger by 1 + d: d/(1 + d) of it, over 2^p -
// 1, times 3 (Roache 1998). The order is that of theory: 2 of a smooth contact's twist, 1 of its stick radius
// and under a punch, whose edge is singular. Where there is none, as of a rough surface, it is 1.
TEST(ReachedError, OfANumberIsThreeTimesTheExtrapolatedDistance) {
  const double apart = kApart / (1.0 + kApart);
  for (const auto& [scene, of, order] :
       std::vector<std::tuple<std::string, AccuracyOf, double>>{{"paper", AccuracyOf::twist, 2.0},
                                                                {"paper", AccuracyOf::stick_radius, 1.0},
                                                                {"flat_punch", AccuracyOf::twist, 1.0},
                                                                {"rough_sphere", AccuracyOf::twist, 1.0}}) {
    const ReachedError found =
        TwoMeshes(scene, scene == "flat_punch" ? "load.moment_ratio=0.9" : kHalfTheLimit, 1.0 + kApart)
            .error(of);
    EXPECT_EQ(found.how, "estimated") << scene;
    EXPECT_NEAR(found.error, 3.0 * apart / (std::exp2(order) - 1.0), 1e-6) << scene;
    EXPECT_THAT(found.why, testing::HasSubstr("24 x 24 cells")) << scene;
  }
}

TEST(ReachedError, OfAnImposedTwistIsThatOfTheMoment) {
  TwoMeshes made("paper", "load.twist=2e-3", 1.0);
  made.fine.moment *= 1.0 + kApart;
  EXPECT_NEAR(made.error(AccuracyOf::twist).error, kApart / (1.0 + kApart), 1e-6);  // 3 times it over 2^2 - 1
}

// Tractions that are larger by 1 + d everywhere differ in the root mean square by d of the coarser ones.
// Their order is 1, so that the finer mesh errs by as much, times 1.25.
TEST(ReachedError, OfTractionsIsTheDifferenceInTheRootMeanSquare) {
  const TwoMeshes made("paper", kHalfTheLimit, 1.0 + kApart);
  EXPECT_NEAR(made.error(AccuracyOf::traction).error, 1.25 * kApart / (1.0 + kApart), 1e-6);
}

// Two meshes may agree by luck.
TEST(ReachedError, IsNeverLessThanThatOfSmoothContactsOnSuchAMesh) {
  const TwoMeshes made("paper", kHalfTheLimit, 1.0);
  const double across = 2.0 * made.fine.contact_radius / std::sqrt(made.fine.grid.cell_area());
  for (const AccuracyOf of : {AccuracyOf::twist, AccuracyOf::traction, AccuracyOf::stick_radius}) {
    EXPECT_EQ(made.error(of).error, error_with(accuracy_data(), of, across));
  }
}

}  // namespace
}  // namespace slipstick::convergence
