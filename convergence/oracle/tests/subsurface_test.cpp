#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analytic/stresses/stress_field.hpp"
#include "solver/solve.hpp"
#include "solver/stresses/subsurface_stresses.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::convergence {
namespace {

using solver::k11, solver::k12, solver::k13, solver::k22, solver::k23, solver::k33;
using namespace solver::paper;

constexpr double kMomentRatio = 0.9;

/// The exact stresses of the lower body in the axes of StressPlane, whose x3 points into the body.
class ExactStresses {
 public:
  std::array<double, solver::kStresses> at(double x1, double x2, double depth) const {
    const double r = std::hypot(x1, x2);
    const analytic::BodyPoint point{r / kContactRadius, depth / kContactRadius};
    const auto [rr, tt, zz, rz] = field_.by_pressure(point, kPoissonRatio);
    const auto [rt, tz] = field_.by_torsion(point);
    const double c = x1 / r;
    const double s = x2 / r;
    std::array<double, solver::kStresses> stress{};
    stress[k11] = rr * c * c + tt * s * s - 2.0 * kFriction * rt * c * s;
    stress[k22] = rr * s * s + tt * c * c + 2.0 * kFriction * rt * c * s;
    stress[k33] = zz;
    stress[k12] = (rr - tt) * c * s + kFriction * rt * (c * c - s * s);
    stress[k13] = -rz * c + kFriction * tz * s;
    stress[k23] = -rz * s - kFriction * tz * c;
    for (double& value : stress) value *= kPeakPressure;
    return stress;
  }

 private:
  analytic::StressField field_{analytic::from_moment_ratio(kMomentRatio), analytic::hertz_profile()};
};

/// Largest error of any component over all cells, over the peak pressure.
double error(const solver::StressPlane& plane, const solver::Grid& grid) {
  const ExactStresses exact;
  double largest = 0.0;
  for (solver::Index cell = 0; cell < grid.cells(); ++cell) {
    const auto stress = exact.at(grid.x1(cell / grid.n2), grid.x2(cell % grid.n2), plane.depth);
    for (std::size_t a = 0; a < solver::kStresses; ++a)
      largest = std::max(largest, std::abs(plane.stress[a][cell] - stress[a]) / kPeakPressure);
  }
  return largest;
}

/// The solved sphere at the depth 0.4 a, deeper than a cell on all meshes.
TEST(SubsurfaceStresses, OfTheSphereConvergeWithOrderTwo) {
  std::vector<double> errors;
  for (const solver::Index cells : {32, 64, 128}) {
    const auto solution = solver::solve(solver::paper_scene(cells, kMomentRatio));
    solver::SubsurfaceStresses stresses(solution, kPoissonRatio, solver::Body::lower);
    errors.push_back(error(stresses.at(0.4 * kContactRadius), solution.grid));
  }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.8);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.8);
}

}  // namespace
}  // namespace slipstick::convergence
