#include "solver/contact/normal_contact.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "solver/input/tests/scratch_folder.hpp"
#include "solver/tests/limits.hpp"
#include "solver/tests/paper_scene.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using std::numbers::pi;
using testing::HasSubstr;

/// Sums of some thousands of numbers round by less.
constexpr double kPressureRounding = 1e-12;

// --- shapes; the others are compared with their exact pressures in convergence/oracle ---

TEST(FlatPunch, SinksInAsBoussinesqSays) {
  double previous = kInfinity;
  for (const Index cells : {32, 128}) {
    Scene scene = paper_scene(cells, 0.5);
    scene.surfaces.front().shape = Shape::flat_punch;
    scene.surfaces.front().radius = 1e-3;
    const Contact contact = press(scene);
    ASSERT_EQ(contact.solution.status, Status::converged);
    const double approach = paper::kLoad / (2.0 * 1e-3 * effective_modulus(scene));
    const double error = std::abs(contact.solution.approach * contact.model.length_unit / approach - 1.0);
    // A circle made of squares is off by a part of a cell, and so is its radius.
    EXPECT_LT(error, 1.0 / static_cast<double>(cells));
    EXPECT_LT(error, previous / 2.0);
    previous = error;
  }
}

TEST_F(ScratchFolder, AHeightMapOfASphereGivesTheSpheresPressure) {
  const Scene sphere = paper_scene(40, 0.5);
  const Contact expected = press(sphere);
  const Grid grid = expected.model.grid_in_m();
  const auto height = [&](Index i, Index j) {
    return 7e-5 + (std::pow(grid.x1(i), 2) + std::pow(grid.x2(j), 2)) / (2.0 * paper::kRadius);
  };
  Scene scene = sphere;
  scene.surfaces.front() = {
      .shape = Shape::height_map,
      .map = {.file = write("heights.csv", table_of(grid.n1, grid.n2, height)), .spacing = {grid.h1, grid.h2}}};
  const Contact contact = press(scene);
  // The heights have lost 7e-5/1e-5 eps, and the two solves stop at their own iterates within a gap of 1e-10.
  EXPECT_LT((contact.solution.pressure - expected.solution.pressure).abs().maxCoeff(),
            1e-9 * expected.solution.pressure.maxCoeff());
  EXPECT_EQ(contact.model.grid.n1, 40);
  scene.grid.cells = {39, 40};
  EXPECT_THROW(make_model(scene), std::invalid_argument);
}

// --- the discrete problem ---

class Complementarity : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Tolerances, Complementarity, testing::Values(1e-6, 1e-10, 1e-13));

TEST_P(Complementarity, HoldsToTheToleranceAskedFor) {
  const Model model = make_model(ellipsoid_scene(40, 0.03, 0.01, 0.5));
  const auto op = make_operator(OperatorKind::dcfft, model.grid, normal_kernel(), *model.law);
  const double total = *model.normal_load / model.grid.cell_area();
  const NormalSolution solution =
      solve_normal_contact({.law = model.law}, model.grid, {model.gap, total}, {.tolerance = GetParam()});
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  const ArrayXd& p = solution.pressure;
  EXPECT_TRUE((p >= 0.0).all());
  EXPECT_NEAR(p.sum() / total, 1.0, kPressureRounding);

  const ArrayXd u = op->applied(p);
  const ArrayXd opening = u + model.gap - solution.approach;
  const double energy = 0.5 * (p * u).sum();
  const double gap = (p * (opening - opening.minCoeff())).sum() / energy;
  EXPECT_LE(gap, GetParam() * (1.0 + 1e-6) + 1e-15);
  EXPECT_NEAR(solution.complementarity, gap, 1e-15);
  // No overlap deeper than the gap that was reported allows for: p.(opening - lowest) >= total (mean - lowest).
  EXPECT_GE(opening.minCoeff() * total, -solution.complementarity * energy * 2.0 - 1e-12);
  EXPECT_GT((p > 0.0).count(), 500);
  EXPECT_LT((p > 0.0).count(), p.size());
}

/// A punch of lines, which coarse grids resolve as a solid one. It sinks deeper than they predict, until a
/// neighbouring body bears whose cells were no candidates.
TEST(FineLines, LetCellsBearThatCoarseGridsLeaveOut) {
  const Grid grid{96, 96, 1.0, 1.0};
  const Elasticity elasticity{std::make_shared<HalfSpaces>(elastic_pair({1.0, 0.3}, {1.0, 0.3}))};

  constexpr double kTolerance = 1e-10;
  for (const double beside : {9.8, 10.0, 10.2}) {
    ArrayXXd gap = ArrayXXd::Constant(96, 96, 1e3);  // a column for each row of the grid
    gap.block(8, 24, 48, 48) = kInfinity;
    for (Index line = 24; line < 72; line += 4) gap.block(8, line, 48, 1) = 0.0;
    gap.block(76, 40, 16, 16) = beside;
    const NormalSolution solution = solve_normal_contact(
        elasticity, grid, {.gap = gap.reshaped(), .total_pressure = 1e3}, {.tolerance = kTolerance});
    ASSERT_EQ(solution.status, Status::converged) << solution.message;
    const ArrayXd& p = solution.pressure;
    const ArrayXd u = elasticity.make(grid, normal_kernel())->applied(p);
    const ArrayXd opening = (p > 0.0 || gap.reshaped().isFinite()).select(u + gap.reshaped(), kInfinity);
    const double open = (p > 0.0).select(p * (opening - opening.minCoeff()), 0.0).sum();
    EXPECT_LE(open / (0.5 * (p * u).sum()), kTolerance * (1.0 + 1e-3));
    EXPECT_NEAR(open / (0.5 * (p * u).sum()), solution.complementarity, 1e-3 * kTolerance);
    EXPECT_GT(Eigen::Map<const ArrayXXd>(p.data(), 96, 96).bottomRows(24).sum(), 0.1);
  }
}

TEST(NormalContact, RefusesWhatIsNoProblemAndSaysThatItsWorkWasTooLittle) {
  const Grid grid{8, 8, 1.0, 1.0};
  const Elasticity elasticity{half_spaces({1.0, 0.3}, {1.0, 0.3}), OperatorKind::dense};
  const ArrayXd bowl = 0.05 * (cell_x1(grid).square() + cell_x2(grid).square());
  ArrayXd hole = bowl;
  hole[13] = kNaN;
  for (const auto& [gap, load] : std::vector<std::pair<ArrayXd, double>>{{bowl, -1.0},
                                                                         {bowl, 0.0},
                                                                         {bowl, kNaN},
                                                                         {bowl, kInfinity},
                                                                         {hole, 1.0},
                                                                         {ArrayXd::Constant(64, kInfinity), 1.0},
                                                                         {ArrayXd::Zero(63), 1.0}}) {
    EXPECT_THROW(solve_normal_contact(elasticity, grid, {gap, load}), std::invalid_argument) << load;
  }
  const NormalSolution stopped =
      solve_normal_contact(elasticity, grid, {bowl, 10.0}, {.tolerance = 1e-12, .max_applications = 2});
  EXPECT_EQ(stopped.status, Status::not_converged);
  EXPECT_THAT(stopped.message, testing::AllOf(HasSubstr("within 2 operator applications"), HasSubstr("1e-12")));
  EXPECT_GT(stopped.complementarity, 1e-12);
}

/// In one cell the load says it all: p = W/h^2, approach = K33 p.
TEST(OneCell, CarriesTheLoad) {
  const Grid grid{1, 1, 1.0, 1.0};
  const Elasticity elasticity{half_spaces({1.0, 0.3}, {kInfinity, 0.0})};
  const NormalSolution solution = solve_normal_contact(elasticity, grid, {ArrayXd::Zero(1), 3.0});
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_DOUBLE_EQ(solution.pressure[0], 3.0);
  EXPECT_NEAR(solution.approach, 3.0 * 0.7 / (2.0 * pi) * 4.0 * std::log(1.0 + std::numbers::sqrt2), 1e-14);
}

/// A load so small that only the lowest cell of a bumpy surface touches, among cells that could.
TEST(OneCell, OfManyTouches) {
  const Grid grid{9, 9, 1.0, 1.0};
  ArrayXd gap = cell_x1(grid).square() + cell_x2(grid).square();
  const NormalSolution solution = solve_normal_contact({half_spaces({1.0, 0.3}, {1.0, 0.3})}, grid, {gap, 0.01});
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_EQ((solution.pressure > 0.0).count(), 1);
  EXPECT_NEAR(solution.pressure[40], 0.01, 1e-14);
}

}  // namespace
}  // namespace slipstick::solver
