// Fields with one thing wrong.

#include <cmath>
#include <numbers>
#include <ostream>

#include "convergence/check/tests/checked_field.hpp"
#include "solver/input/tests/complaint.hpp"

namespace slipstick::convergence {
namespace {

using namespace testing;

// Loads of 32 to 64 cells across, where a mesh accounts for more.
struct Coarse {
  const char* scene;
  int cells;
  double ratio;
};
void PrintTo(const Coarse& coarse, std::ostream* stream) {
  *stream << coarse.scene << ", " << coarse.cells << " cells, " << coarse.ratio << " of the limit";
}

class CheckCoarseBadField : public testing::TestWithParam<Coarse> {
 protected:
  std::vector<std::string> load(double factor = 1.0) const {
    return {fmt::format("load.moment_ratio={}", GetParam().ratio * factor)};
  }
  solver::Scene scene_ = scene_of(GetParam().scene, GetParam().cells, load());
  solver::Solution solution_ = solver::solve(scene_);
  FieldRows rows_ = rows_of(solution_);
};

TEST_P(CheckCoarseBadField, MomentOnePercentOff) {
  for (const double factor : {0.99, 1.01}) {
    const Checked result = find_bad(solved(scene_of(GetParam().scene, GetParam().cells, load(factor))),
                                    scene_, BreaksFirst("moment_error"));
    EXPECT_TRUE(result["discrete"]["holds"].get<bool>());
  }
}

TEST_P(CheckCoarseBadField, StoppedAtAGapOfOnePercent) {
  solver::Solution stopped;
  // A last step may take it beyond the tolerance.
  for (const char* tolerance : {"1e-2", "2e-2", "4e-2", "8e-2", "0.16", "0.32"}) {
    stopped = solver::solve(scene_of(GetParam().scene, GetParam().cells,
                                     {load()[0], fmt::format("solver.tolerance={}", tolerance)}));
    if (stopped.certificate.gap >= 3e-3) break;
  }
  ASSERT_GE(stopped.certificate.gap, 3e-3);
  find_bad(rows_of(stopped), scene_, names_none());
}

// The moment is right, and every cell is within its bound. |q|/p shows the mistake.
TEST_P(CheckCoarseBadField, FrictionTwoPercentLowUnderTheSameMoment) {
  find_bad(solved(scene_of(GetParam().scene, GetParam().cells,
                           {fmt::format("load.moment={}", solution_.moment), "contact.friction=0.098"})),
           scene_,
           AllOf(Not(Breaks("moment_error")), IsOff("friction", -0.02),
                 names(mistake::friction_coefficient, 0.098)));
}

TEST_P(CheckCoarseBadField, TwistOnePercentHigh) {
  find_bad(rows_, scene_, AllOf(IsOff("twist", 0.01), names(mistake::other_twist, solution_.twist_angle)),
           1.01 * solution_.twist_angle);
}

INSTANTIATE_TEST_SUITE_P(Scenes, CheckCoarseBadField,
                         testing::Values(Coarse{"paper", 64, 0.3}, Coarse{"paper", 32, 0.6},
                                         Coarse{"ellipse", 64, 0.3}, Coarse{"cone", 32, 0.6}));

class CheckBadField : public testing::Test {
 protected:
  solver::Scene scene_ = scene_of("paper", 48);
  solver::Solution solution_ = solver::solve(scene_);
  FieldRows rows_ = rows_of(solution_);
};

TEST_F(CheckBadField, AnotherFrictionCoefficient) {
  find_bad(with_tractions_times(rows_, 0.95), scene_,
           AllOf(IsOff("moment_error", -0.05), names(mistake::friction_coefficient, 0.095)));
  for (const double factor : {1.05, 1.2}) {  // the second beyond what friction can carry
    const Checked result =
        find_bad(with_tractions_times(rows_, factor), scene_,
                 AllOf(Breaks("friction_bound"), names(mistake::friction_coefficient, 0.1 * factor)));
    // Displacements and the twist that fits them grow with the tractions.
    EXPECT_NEAR(result["twist_angle"].get<double>() / solution_.twist_angle, factor, 1e-3);
  }
}

// One cell carries half, its neighbours all: no mean over the contact shows it.
TEST(CheckBadCell, IsHalved) {
  for (const int cells : {24, 40, 64, 96}) {
    const solver::Scene scene = scene_of("paper", cells);
    FieldRows rows = solved(scene);
    const auto largest =
        std::ranges::max_element(rows, {}, [](const FieldRow& r) { return std::hypot(r[3], r[4]); });
    for (const std::size_t c : {3, 4}) (*largest)[c] *= 0.5;
    const Checked result = find_bad(rows, scene, BreaksFirst("traction_cell"));
    EXPECT_THAT(why(result), AllOf(HasSubstr(fmt::format("{:.3g}", (*largest)[0])),
                                   HasSubstr(fmt::format("{:.3g}", (*largest)[1]))));
  }
}

// A cause is named where the field is good without it.
TEST_F(CheckBadField, NamesNoCauseThatLeavesItBad) {
  const auto shifted = [&](double quadrant) {
    return changed(rows_, [=](FieldRow& r) {
      if (r[0] > 0.0 && r[1] > 0.0) r[3] *= quadrant, r[4] *= quadrant;
    });
  };
  for (const FieldRows& rows : {shifted(0.5), shifted(0.0), shifted(-1.0), with_tractions_times(rows_, 3e-4),
                                changed(rows_, [](FieldRow& r) { r[4] = 0.0; })}) {
    EXPECT_THAT(check_rows(rows, scene_), names_none());
  }
}

// In Pa zeros are as exact as in MPa.
TEST_F(CheckBadField, UnitsDoNotDecide) {
  const FieldRows rows = changed(rows_, [](FieldRow& r) { r[4] = 0.0; });
  const FieldRows in_mm = changed(rows, [](FieldRow& r) {
    r = {r[0] * 1e3, r[1] * 1e3, r[2] * 1e-6, r[3] * 1e-6, r[4] * 1e-6};
  });
  for (const FieldRows& each : {rows, in_mm}) {
    EXPECT_FALSE(find_bad(each, scene_, testing::_)["discrete"]["holds"].get<bool>());
  }
}

// The first line says good or bad, and percentages are written out.
TEST_F(CheckBadField, SaysFirstWhatIsWrong) {
  const FieldRows rows = changed(rows_, [](FieldRow& r) {
    if (r[0] > 0.0) r[3] *= -3.0, r[4] *= -3.0;
  });
  EXPECT_THAT(check_rows(rows, scene_).text,
              AllOf(testing::StartsWith("bad: "), Not(testing::ContainsRegex("[0-9]e[+][0-9]+ %"))));
  EXPECT_THAT(check_rows(rows_, scene_).text, testing::StartsWith("good: "));
}

// The normal contact's tolerance decides whether such a cell touches at all.
TEST_F(CheckBadField, NotACellThatCarriesNextToNothing) {
  FieldRows rows = rows_;
  const double tiny = 1e-9 * rows[rows.size() / 2 + 15][2];
  rows.push_back({rows[0][0], -rows[0][1] + (rows[1][1] - rows[0][1]), tiny, 0.0, 0.5 * tiny});
  find_good(rows, scene_);
}

/// Hertz's pressure of the paper's load on another radius, with |q| = mu p everywhere: M = 3 pi/16 mu W a.
FieldRows sliding_rows(int cells, double radius) {
  const double a = radius * std::cbrt(0.75 * 1000.0 * 0.018 * 2.0 * 0.91 / 210e9);
  const double h = 2.0 * a / (cells - 4);
  FieldRows rows;
  for (int i = 0; i < cells * cells; ++i) {
    const double x1 = (i / cells - 0.5 * (cells - 1)) * h;
    const double x2 = (i % cells - 0.5 * (cells - 1)) * h;
    const double r = std::hypot(x1, x2);
    if (!(r < a)) continue;
    const double p = 1.5 * 1000.0 / (std::numbers::pi * a * a) * std::sqrt(1.0 - r * r / (a * a));
    rows.push_back({x1, x2, p, -0.1 * p * x2 / r, 0.1 * p * x1 / r});
  }
  return rows;
}

TEST(CheckSlidingField, IsJudgedByItsRadiusAndItsMoment) {
  for (const int cells : {32, 48}) {
    for (const double radius : {0.79, 0.97, 1.0}) {
      const Checked result =
          find_bad(sliding_rows(cells, radius), scene_of("paper", cells), Breaks("moment_error"));
      EXPECT_NEAR(result["moment_error"], radius / 0.9 - 1.0, 5e-3);
      EXPECT_EQ(judgement(result, "pressure")["holds"], radius == 1.0);
    }
  }
}

// Midpoint samples of a field next to the limit slip everywhere, up to rounding.
TEST(CheckSlidingField, IsNotARightOneNextToTheLimit) {
  for (const char* ratio : {"0.9999", "0.99999", "0.999999"}) {
    const solver::Scene scene = scene_of("paper", 48, {fmt::format("load.moment_ratio={}", ratio)});
    const solver::Solution solution = solver::solve(scene);
    find_good(rows_of(solution), scene, solution.twist_angle);
  }
}

TEST_F(CheckBadField, Twists) {
  const double twist = solution_.twist_angle;
  find_bad(rows_, scene_, AllOf(IsOff("twist", -0.5), names(mistake::one_compliance)), 0.5 * twist);
  find_bad(rows_, scene_, names(mistake::compliance_factor, 2.0), 2.0 * twist);
  find_bad(rows_, scene_, names(mistake::twist_in_degrees), twist * 180.0 / std::numbers::pi);
  find_bad(rows_, scene_, names(mistake::twist_in_mrad), 1e3 * twist);
  find_bad(rows_, scene_, names(mistake::normalised_twist), find_oracle(scene_).oracle->state.twist);
  EXPECT_EQ(check_rows(rows_, scene_, -twist)["verdict"], "good");  // a matter of convention, and said so
}

// The step before the last of four, written with the pressure of the last.
TEST(CheckCause, TractionsOneStepLate) {
  const solver::Scene scene = scene_of("paper", 40);
  find_bad(solved(scene_of("paper", 40, {"load.moment_ratio=0.675"})), scene, names(mistake::late_step, 4.0));
  find_bad(solved(scene_of("paper", 40, {"load.moment_ratio=0.775"})), scene, Not(names(mistake::late_step)));
}

TEST(CheckCause, RowsAreLost) {
  for (const char* name : {"paper", "ellipse"}) {
    const solver::Scene scene = scene_of(name, 40);
    FieldRows rows = solved(scene);
    const auto middle = rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2);
    FieldRows inside = rows;
    inside.erase(inside.begin() + (middle - rows.begin()), inside.begin() + (middle - rows.begin()) + 5);
    find_bad(inside, scene, names(mistake::lost_rows, 5.0));
    rows.resize(rows.size() - rows.size() / 10);
    find_bad(rows, scene, names(mistake::lost_rows));
  }
}

TEST(CheckCause, AnotherLayer) {
  const std::vector<std::string> layer{"lower.layer={thickness=1e-4,young_modulus=420e9,poisson_ratio=0.25}",
                                       "contact.coupling=none"};
  const solver::Scene scene = scene_of("paper", 40, layer);
  find_bad(solved(scene_of("paper", 40)), scene, names(mistake::layer_ignored));
  for (const int cells : {32, 64}) {
    find_bad(solved(scene_of("paper", 32, {layer[0], layer[1], "lower.layer.thickness=2e-4"})),
             scene_of("paper", cells, layer), names(mistake::layer_thickness, 2e-4));
  }
  find_bad(solved(scene_of("paper", 40,
                           {layer[0], layer[1], "lower.young_modulus=420e9", "lower.poisson_ratio=0.25",
                            "lower.layer.young_modulus=210e9", "lower.layer.poisson_ratio=0.3"})),
           scene, names(mistake::layer_exchanged));
}

TEST(CheckCause, OtherModuli) {
  const solver::Scene scene = scene_of("paper", 40);
  find_bad(solved(scene_of("paper", 40, {"upper.young_modulus=420e9", "lower.young_modulus=420e9"})), scene,
           names(mistake::one_compliance));
  find_bad(solved(scene_of("paper", 40, {"upper.young_modulus=290e9", "lower.young_modulus=290e9"})), scene,
           names(mistake::modulus_factor, 1.38));
}

TEST(CheckCause, PositionsFromTheGridsCornerAreAConvention) {
  const solver::Scene scene = scene_of("patches", 48);
  const solver::Solution solution = solver::solve(scene);
  const double half1 = 24.0 * solution.grid.h1;
  const double half2 = 24.0 * solution.grid.h2;
  const FieldRows rows = changed(rows_of(solution), [&](FieldRow& row) { row[0] += half1, row[1] += half2; });
  EXPECT_THAT(find_good(rows, scene)["conventions"].dump(), HasSubstr("corner"));
}

TEST_F(CheckBadField, NotJudged) {
  FieldRows negative = rows_;
  negative[6][2] = -1.0;
  EXPECT_THAT(solver::complaint([&] { check_rows(negative, scene_); }),
              AllOf(HasSubstr("row 7"), HasSubstr("pressure = -1"), HasSubstr("zero or positive")));
  EXPECT_THROW(check_rows(with_tractions_times(rows_, 0.0), scene_), solver::InputError);
  EXPECT_THROW(check_rows(rows_, scene_of("torsion_and_force")), solver::InputError);
  solver::Scene frictionless = scene_;
  frictionless.contact.friction.coefficient = 0.0;
  EXPECT_THROW(check_rows(rows_, frictionless), solver::InputError);
}

}  // namespace
}  // namespace slipstick::convergence
