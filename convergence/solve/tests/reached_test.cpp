// The error estimated from two meshes. The coarse answer is solved, and the fine answer is the coarse one
// times a factor, so the difference is known.

#include "convergence/solve/reached.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/solve/measured_accuracy.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/grid/grid_transfer.hpp"

namespace slipstick::convergence {
namespace {

constexpr double kApart = 0.25;  ///< larger than the least error of any mesh as fine as these

/// A scene, and an artificial answer on its mesh: each number and traction is the one on half as many cells,
/// times a factor.
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

  ReachedError error(AccuracyOf of) const { return reached_error(scene, fine, ErrorsRecord{}, of); }
};

const std::string kHalfTheLimit = "load.moment_ratio=0.5";

// The fine value is 1 + d times the coarse one: the estimate is 3 d/(1 + d)/(2^p - 1), relative (Roache
// 1998). The theoretical order p is 2 for a smooth contact's twist, 1 for its stick radius and for a punch
// with its singular edge. A rough surface has none; 1 is taken.
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
    EXPECT_NE(found.why.find("24 x 24"), std::string::npos) << scene;
  }
}

TEST(ReachedError, OfAnImposedTwistIsThatOfTheMoment) {
  TwoMeshes made("paper", "load.twist=2e-3", 1.0);
  made.fine.moment *= 1.0 + kApart;
  EXPECT_NEAR(made.error(AccuracyOf::twist).error, kApart / (1.0 + kApart), 1e-6);  // 3 times it over 2^2 - 1
}

// Tractions that are 1 + d times the coarse ones differ by d of these in the root mean square. The order is
// 1, so the estimate is this difference times 1.25.
TEST(ReachedError, OfTractionsIsTheDifferenceInTheRootMeanSquare) {
  const TwoMeshes made("paper", kHalfTheLimit, 1.0 + kApart);
  EXPECT_NEAR(made.error(AccuracyOf::traction).error, 1.25 * kApart / (1.0 + kApart), 1e-6);
}

// Two meshes may agree by chance.
TEST(ReachedError, IsNeverLessThanThatOfSmoothContactsOnSuchAMesh) {
  const TwoMeshes made("paper", kHalfTheLimit, 1.0);
  const double across = 2.0 * made.fine.contact_radius / std::sqrt(made.fine.grid.cell_area());
  for (const AccuracyOf of : {AccuracyOf::twist, AccuracyOf::traction, AccuracyOf::stick_radius}) {
    EXPECT_EQ(made.error(of).error, error_with(accuracy_data(), of, across));
  }
}

}  // namespace
}  // namespace slipstick::convergence
