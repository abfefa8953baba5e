// The verdict at its thresholds: a right field with one thing wrong by a known amount, just below and just
// above the amount that docs/guides/verify-your-solver.md allows.

#include <cmath>
#include <functional>
#include <numbers>

#include "convergence/check/tests/checked_field.hpp"

namespace slipstick::convergence {
namespace {

constexpr double kBelow = 0.9;
constexpr double kAbove = 1.1;

/// A scene, its solution on its own grid and that as a field.
struct RightField {
  solver::Scene scene;
  solver::Solution solution = solver::solve(scene);
  FieldRows rows = rows_of(solution);

  double of_cells(double cells) const { return cells / static_cast<double>(solution.contact_cells); }
};

/// The right field of the paper's scene on a coarse grid, with one error at a time.
class CheckThreshold : public testing::Test {
 protected:
  /// A field with an error a little below the allowed one holds, with one a little above it does not. made:
  /// the field with an error; `within` of which its value is known.
  void expect_threshold(const char* quantity, double allowed, double within,
                        const std::function<FieldRows(double error)>& made) const {
    for (const double times : {kBelow, kAbove}) {
      const Json item = judgement(check_rows(made(times * allowed), field.scene), quantity);
      EXPECT_NEAR(item["value"].get<double>(), times * allowed, within);
      EXPECT_EQ(item["holds"], times < 1.0) << item;
    }
  }

  const RightField field{scene_of("paper", 32)};
};

// A field that solves its own grid's problem is allowed 2/n, with n contact cells.
TEST_F(CheckThreshold, OfLoadsAndTwistIsTheQuadrature) {
  const double twist = field.solution.twist_angle;
  for (const double sign : {1.0, -1.0}) {
    const double below = 1.0 + sign * kBelow * field.of_cells(2.0);
    const double above = 1.0 + sign * kAbove * field.of_cells(2.0);
    const auto at_moment = [&](double factor) {
      return solved(scene_of("paper", 32, {fmt::format("load.moment_ratio={}", 0.9 * factor)}));
    };
    find_good(with_stresses_times(field.rows, below), field.scene);
    find_bad(with_stresses_times(field.rows, above), field.scene, BreaksFirst("normal_load_error"));
    find_good(at_moment(below), field.scene);
    find_bad(at_moment(above), field.scene, BreaksFirst("moment_error"));
    find_good(field.rows, field.scene, below * twist);
    find_bad(field.rows, field.scene, Breaks("twist"), above * twist);
  }
}

// Forces are parts of mu W, which is 100 N.
TEST_F(CheckThreshold, OfForcesIsTheQuadrature) {
  const auto scene = [](double more) {
    return scene_of("paper", 32, {"load.moment_ratio=0.5", fmt::format("load.force=[{}, 20]", 30.0 + more)});
  };
  const RightField field{scene(0.0)};
  find_good(solved(scene(kBelow * field.of_cells(200.0))), field.scene);
  find_bad(solved(scene(kAbove * field.of_cells(200.0))), field.scene, Breaks("force"));
}

// One cell. The contact radius is proportional to the modulus to the power -1/3.
TEST_F(CheckThreshold, OfTheContactRadiusIsOneCell) {
  const double radius = find_oracle(field.scene).oracle->contact_radius;
  const double cell = field.solution.grid.h1 / radius;
  for (const double times : {kBelow, kAbove, -kBelow, -kAbove}) {
    solver::Scene other = field.scene;
    other.grid.extent = {32.0 * field.solution.grid.h1, 32.0 * field.solution.grid.h2};
    other.upper.young_modulus = other.lower.young_modulus *= std::pow(1.0 + times * cell, -3.0);
    const Json item = judgement(check_rows(solved(other), field.scene), "contact_radius_error");
    EXPECT_NEAR(item["allowed"].get<double>() / cell, 1.0, 1e-9);
    EXPECT_EQ(item["holds"], std::abs(times) < 1.0) << item;
  }
}

/// The rows, with those changed for which |q|/(mu p) is in a range.
FieldRows with_part(const RightField& field, double least, double most,
                    const std::function<void(FieldRow&)>& change) {
  return changed(field.rows, [&](FieldRow& row) {
    const double part = std::hypot(row[3], row[4]) / (field.scene.contact.friction.coefficient * row[2]);
    if (part >= least && part <= most) change(row);
  });
}

void scale_tractions(FieldRow& row, double factor) { row[3] *= factor, row[4] *= factor; }

constexpr double kSlipping = 1.0 - 1e-9;

// A thousandth, in any one cell.
TEST_F(CheckThreshold, OfTheFrictionBoundIsAThousandth) {
  const auto largest = std::ranges::max_element(
      field.rows, {}, [](const FieldRow& row) { return std::hypot(row[3], row[4]); });
  const auto place = static_cast<std::size_t>(largest - field.rows.begin());
  expect_threshold("friction_bound", 1e-3, 1e-6, [&](double error) {
    FieldRows rows = field.rows;
    const double bound = field.scene.contact.friction.coefficient * rows[place][2];
    scale_tractions(rows[place], (1.0 + error) * bound / std::hypot(rows[place][3], rows[place][4]));
    return rows;
  });
}

// The median of the ring: a thousandth, and twice what right fields of this mesh show.
TEST_F(CheckThreshold, OfFrictionIsAThousandthAndTheMesh) {
  const double allowed_here = allowed(check_rows(field.rows, field.scene), "friction");
  EXPECT_GE(allowed_here, 1e-3);
  const solver::Scene finer = scene_of("paper", 64);
  EXPECT_NEAR(allowed(check_rows(solved(finer), finer), "friction"), 1.1e-3, 0.1e-3);  // as in the guide
  expect_threshold("friction", allowed_here, 1e-6, [&](double error) {
    return with_part(field, kSlipping, 2.0, [&](FieldRow& row) { scale_tractions(row, 1.0 - error); });
  });
}

/// Whether the cell's column and row are together even: the squares of a chessboard.
bool is_white(const FieldRow& row, const solver::Grid& grid) {
  const auto whole = [](double x) { return static_cast<long>(std::lround(2.0 * x)) / 2; };
  return (whole(row[0] / grid.h1 + 1000.0) + whole(row[1] / grid.h2 + 1000.0)) % 2 == 0;
}

void turn(FieldRow& row, double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  const auto [q1, q2] = std::pair(row[3], row[4]);
  row[3] = std::cos(angle) * q1 - std::sin(angle) * q2;
  row[4] = std::sin(angle) * q1 + std::cos(angle) * q2;
}

// A chessboard of turned tractions hardly moves the surface: slip stays where it was.
TEST_F(CheckThreshold, OfSlipDirectionsIsATenthOfADegreeAndTheMesh) {
  const Checked right = check_rows(field.rows, field.scene);
  const double mesh = right["yardstick"]["slip_direction"];
  EXPECT_NEAR(allowed(right, "slip_direction"), 0.1 + 2.0 * mesh, 1e-6);
  expect_threshold("slip_direction", 0.1 + 2.0 * mesh, INFINITY, [&](double degrees) {
    return with_part(field, kSlipping, 2.0, [&](FieldRow& row) {
      turn(row, is_white(row, field.solution.grid) ? degrees : -degrees);
    });
  });
}

// Two digits leave each component open by a part of 0.05: in the mean over |q|, sqrt(pi/2) times that as an
// angle, and twice. The rounding also counts as noise, of 0.003 at most.
TEST_F(CheckThreshold, OfSlipDirectionsIsTheAngleOfTheDigits) {
  const Checked result = find_good(with_digits(field.rows, {3, 4}, 2), field.scene);
  const double of_digits = 0.05 * std::sqrt(0.5 * std::numbers::pi) * 180.0 / std::numbers::pi;
  const double mesh = result["yardstick"]["slip_direction"];
  const double ratio = (allowed(result, "slip_direction") - 0.1 - 2.0 * mesh) / (2.0 * of_digits);
  EXPECT_GE(ratio, 0.95);
  EXPECT_LE(ratio, 1.15);
}

// A chessboard in stick cells meets no bound: the tractions are as far from the right ones as the test makes
// them.
TEST_F(CheckThreshold, OfTractionsIsTwiceWhatRightFieldsShow) {
  const Checked right = check_rows(field.rows, field.scene);
  const double mesh = right["yardstick"]["mesh_error"];
  EXPECT_NEAR(allowed(right, "tractions"), 2.0 * mesh, 1e-9);
  double sum = 0.0;
  for (const FieldRow& row : field.rows) sum += std::hypot(row[3], row[4]);
  int sticking = 0;
  with_part(field, 0.0, 0.8, [&](FieldRow&) { ++sticking; });
  EXPECT_EQ(right["yardstick"]["distance"], judgement(right, "tractions")["value"]);
  expect_threshold("tractions", 2.0 * mesh, 0.018 * mesh, [&](double part) {
    return with_part(field, 0.0, 0.8, [&](FieldRow& row) {
      const double size = part * sum / sticking;
      row[3] += is_white(row, field.solution.grid) ? size : -size;
    });
  });
}

// Any iteration is allowed 1e-5, and the mesh twice what right fields show, at most 1e-3 with constant cells.
TEST_F(CheckThreshold, OfTheGapIsTheIterationsAndTheMeshs) {
  struct Gap {
    double allowed;
    double of_mesh;
  };
  const auto gap = [](const std::string& pressure, int cells) {
    const solver::Scene scene = scene_of("paper", cells, {fmt::format("contact.pressure='{}'", pressure)});
    const Checked result = check_rows(solved(scene), scene);
    EXPECT_EQ(result["yardstick"]["constant_cells"], pressure == "solved");
    EXPECT_NEAR(result["discrete"]["allowed"].get<double>(), 1e-5, 1e-8);
    return Gap{allowed(result, "gap"), result["yardstick"]["gap"]};
  };
  const Gap fine = gap("solved", 48);
  EXPECT_LT(2.0 * fine.of_mesh, 0.5e-3);
  EXPECT_NEAR(fine.allowed, 1e-5 + 2.0 * fine.of_mesh, 1e-8);
  const Gap coarse = gap("solved", 16);
  EXPECT_GT(2.0 * coarse.of_mesh, 2e-3);
  EXPECT_NEAR(coarse.allowed, 1e-5 + 1e-3, 1e-8);
  const Gap not_constant = gap("hertz", 16);
  EXPECT_NEAR(not_constant.allowed, 1e-5 + 2.0 * not_constant.of_mesh, 1e-8);
}

/// The exact field's means over the cells, by the midpoints of 9 x 9 parts.
FieldRows averaged(FieldRows rows, const Oracle& oracle) {
  constexpr int kParts = 9;
  const double h = std::abs(rows[1][1] - rows[0][1]);
  for (FieldRow& row : rows) {
    FieldRow mean{row[0], row[1], 0.0, 0.0, 0.0};
    for (int k = 0; k < kParts * kParts; ++k) {
      const double x1 = row[0] + h * ((k / kParts + 0.5) / kParts - 0.5);
      const double x2 = row[1] + h * ((k % kParts + 0.5) / kParts - 0.5);
      const double r = std::hypot(x1, x2);
      const double shear = r < oracle.contact_radius ? oracle.shear(r) : 0.0;
      mean[2] += oracle.pressure(r) / (kParts * kParts);
      mean[3] -= shear * x2 / r / (kParts * kParts);
      mean[4] += shear * x1 / r / (kParts * kParts);
    }
    row = mean;
  }
  return rows;
}

// The mesh error is the larger one of two right fields', samples at the cells' centres and means over
// the cells. check measures it by a solve on cells a third as large; here the exact fields show it.
TEST_F(CheckThreshold, OfTheMeshIsWhatExactFieldsShow) {
  const solver::Scene& scene = field.scene;
  const FieldRows at_centres = sampled(scene);
  const Checked one = check_rows(at_centres, scene);
  const Checked other = check_rows(averaged(at_centres, *find_oracle(scene).oracle), scene);
  const auto worse = [&](const char* quantity) {
    return std::max(judgement(one, quantity)["value"].get<double>(),
                    judgement(other, quantity)["value"].get<double>());
  };
  const Json& mesh = one["yardstick"];
  EXPECT_NEAR(mesh["mesh_error"].get<double>() / worse("tractions"), 1.0, 0.2);
  EXPECT_NEAR(mesh["gap"].get<double>() / worse("gap"), 1.0, 0.2);
  EXPECT_GE(mesh["slip_direction"].get<double>() / worse("slip_direction"), 1.0);
  EXPECT_LE(mesh["slip_direction"].get<double>() / worse("slip_direction"), 2.5);
}

// Samples of an exact field miss a part of the normal load, and a force in parts of mu W.
TEST_F(CheckThreshold, OfLoadsIsWhatExactFieldsMiss) {
  const solver::Scene scene = scene_of("mindlin", 32);
  const FieldRows rows = sampled(scene);
  const Examination e = examine(scene, write_rows(rows), {});
  double force = 0.0;
  double normal = 0.0;
  for (const FieldRow& row : rows) normal += row[2], force += row[3];
  const double area = std::pow(rows[1][1] - rows[0][1], 2);
  const solver::Step& load = scene.steps.front();
  const double missed_normal = std::abs(area * normal / *load.normal - 1.0);
  const double missed_force =
      std::abs(area * force - e.exact.oracle->force[0]) / (scene.contact.friction.coefficient * *load.normal);
  EXPECT_NEAR(e.reference.mesh.loads.normal / missed_normal, 1.0, 0.5);
  EXPECT_NEAR(e.reference.mesh.loads.force / missed_force, 1.0, 0.5);
}

// The upper quartile of a normal distribution says how much noise |q| has, up to 0.3 %.
TEST_F(CheckThreshold, OfNoiseIsThreeThousandths) {
  for (const double noise : {1e-3, 2e-3, 1e-2}) {
    std::mt19937 random(3);
    std::normal_distribution<double> factor(1.0, noise);
    const FieldRows rows = changed(field.rows, [&](FieldRow& row) { scale_tractions(row, factor(random)); });
    const double found = check_rows(rows, field.scene)["yardstick"]["noise"];
    if (noise > 3e-3) {
      EXPECT_NEAR(found, 3e-3, 1e-9);
    } else {
      EXPECT_NEAR(found / noise, 1.0, 0.25);
    }
  }
}

}  // namespace
}  // namespace slipstick::convergence
