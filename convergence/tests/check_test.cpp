// Fields of other programs, judged.

#include "convergence/check/check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "convergence/errors.hpp"
#include "convergence/exact_result.hpp"
#include "convergence/tests/written_field.hpp"
#include "solver/input_error.hpp"

namespace slipstick::convergence {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kScenes = SLIPSTICK_SCENES;
const std::string kFields = SLIPSTICK_FIELDS;

solver::Scene scene_of(const std::string& name, int cells = 32, std::vector<std::string> overrides = {}) {
  const bool oblong = name == "ellipse";
  overrides.push_back(fmt::format("grid.cells=[{},{}]", cells, oblong ? cells / 2 : cells));
  return solver::read_scene(kScenes + "/" + name + ".toml", overrides);
}

Json check_rows(const FieldRows& rows, const solver::Scene& scene, std::optional<double> twist = {}) {
  return check_field(scene, write_rows(rows), {.twist = twist});
}

Json check_peer(const std::string& name, std::optional<double> twist = {}) {
  return check_field(scene_of("paper"), kFields + "/" + name + "-64-0.9.csv", {.twist = twist});
}

std::string why(const Json& result) { return result["why"]; }

TEST(Check, FindsContactsOwnFieldGood) {
  const double twist = 2.361048651456917e-3;
  for (const Json& result : {check_peer("contact", twist), check_peer("contact")}) {
    EXPECT_EQ(result["verdict"], "good") << why(result);
    EXPECT_THAT(result["conventions"], IsEmpty());
    EXPECT_NEAR(result["twist_angle"].get<double>() / twist, 1.0, 1e-6);
    // As its own makers would find it: the moment 2.3e-5 low, the counted stick radius within a cell of 32
    // to the radius, 7.7e-3 in L2.
    EXPECT_NEAR(result["moment_error"], -2.3e-5, 1e-6);
    EXPECT_NEAR(result["traction_error"]["l2"], 7.7e-3, 1e-4);
    EXPECT_LE(std::abs(result["stick_radius_counted_error"].get<double>()), 1.0 / 32.0);
    EXPECT_LE(result["certificate"]["gap"], 1e-6);
  }
}

// Its moment and stick radius look right. What tells is its twist, its slip, and one kernel with which its
// stick area moves as one body, by the very twist that it reported.
TEST(Check, FindsAMirroredCrossKernel) {
  const double twist = 2.21775472e-3;
  const Json told = check_peer("cgcontact", twist);
  EXPECT_EQ(told["verdict"], "bad");
  EXPECT_LE(std::abs(told["moment_error"].get<double>()), 1e-6);
  EXPECT_NEAR(told["twist_error"], -0.0607, 1e-4);
  EXPECT_THAT(why(told), AllOf(HasSubstr("the moment is right"), HasSubstr("the twist is 6.1 % too low"),
                               HasSubstr("slip is not opposed to traction"), HasSubstr("K12"),
                               HasSubstr("mirrored as an even function"), HasSubstr("does not oppose")));
  const Json inferred = check_peer("cgcontact");
  EXPECT_EQ(inferred["verdict"], "bad");
  EXPECT_THAT(why(inferred), HasSubstr("mirrored as an even function"));
  const Json& diagnosis = inferred["diagnosis"];
  EXPECT_THAT(diagnosis["kernel"].get<std::string>(), HasSubstr("mirrored as an even function"));
  EXPECT_TRUE(diagnosis["stick_area_explained"]);
  const Json& kernel = diagnosis["tried"][0];
  EXPECT_EQ(kernel["name"], diagnosis["kernel"]);
  EXPECT_NEAR(kernel["twist_angle"].get<double>() / twist, 1.0, 1e-6);
  EXPECT_LE(kernel["stick_gap"], 1e-5 * diagnosis["as_it_should_be"]["stick_gap"].get<double>());
}

// The numbers of `solve` on its own field, from the field alone.
TEST(Check, FindsOwnSolutionsGood) {
  for (const char* name : {"paper", "ellipse", "off_centre", "turned_ellipse", "flat_punch", "cone",
                           "rounded_punch", "annulus", "patches", "dissimilar", "mindlin"}) {
    const solver::Scene scene = scene_of(name);
    const solver::Solution solution = solver::solve(scene);
    const Json result = check_rows(rows_of(solution), scene);
    EXPECT_EQ(result["verdict"], "good") << name << ": " << why(result);
    EXPECT_THAT(result["conventions"], IsEmpty()) << name;
    EXPECT_LE(result["certificate"]["gap"], 1e-6) << name;
    EXPECT_LE(result["yardstick"]["distance"], 1e-3) << name;
    EXPECT_NEAR(result["moment"], solution.moment, 1e-9 * solution.moment_limit) << name;
    EXPECT_EQ(result["contact_cells"], solution.contact_cells) << name;
    EXPECT_LE(std::abs(result["stick_cells"].get<double>() - static_cast<double>(solution.stick_cells)),
              2.0 + 1e-2 * static_cast<double>(solution.stick_cells))
        << name;
  }
}

// The pressure of an ellipse has an exact answer, its tractions have none: the certificate judges those.
TEST(Check, JudgesTheNormalContactOfAnEllipseExactly) {
  for (const char* name : {"ellipse", "turned_ellipse"}) {
    const solver::Scene scene = scene_of(name);
    const Json good = check_rows(rows_of(solver::solve(scene)), scene);
    EXPECT_LE(std::abs(good["contact_radius_error"].get<double>()), 1e-2) << name;
    EXPECT_LE(good["pressure_error"]["l1"].get<double>(), 3e-2) << name;
    for (const char* key : {"twist_error", "stick_radius_error"}) {
      EXPECT_TRUE(good[key].is_null()) << key;
      EXPECT_THAT(good[std::string(key) + "_reason"].get<std::string>(), HasSubstr("normal contact only"));
    }
    EXPECT_TRUE(good["traction_error"]["l1"].is_null()) << name;
    EXPECT_THAT(check_text(good), HasSubstr("normal contact only")) << name;
    solver::Scene softer = scene;
    softer.upper.young_modulus = softer.lower.young_modulus *= 0.5;  // the contact is by 2^(1/3) larger
    const Json bad = check_rows(rows_of(solver::solve(softer)), scene);
    EXPECT_EQ(bad["verdict"], "bad") << name;
    EXPECT_NEAR(bad["contact_radius_error"], std::cbrt(2.0) - 1.0, 1e-2) << name;
    EXPECT_THAT(why(bad), HasSubstr("the contact radius is 26 % too high")) << name;
  }
}

// Loads that leave the moment open where the exact answer does not say it either.
TEST(Check, FindsOwnSolutionsOfAnEllipseGoodUnderAnyLoad) {
  for (const std::vector<std::string>& load : {std::vector<std::string>{"load.twist=1e-3"},
                                               {"load.twist=-1e-3", "load.force=[0,20]"},
                                               {"load.moment_ratio=0.5", "load.displacement=[1e-7,0]"}}) {
    const solver::Scene scene = scene_of("ellipse", 32, load);
    const Json result = check_rows(rows_of(solver::solve(scene)), scene);
    EXPECT_EQ(result["verdict"], "good") << load[0] << ": " << why(result);
    EXPECT_THAT(result["conventions"], IsEmpty()) << load[0];
  }
}

TEST(Check, FindsReversedComponentsOnAnEllipseUnderAnImposedTwist) {
  const solver::Scene scene = scene_of("ellipse", 32, {"load.twist=1e-3"});
  const FieldRows right = rows_of(solver::solve(scene));
  for (const bool both : {false, true}) {
    FieldRows rows = right;
    for (auto& [x1, x2, pressure, q1, q2] : rows) {
      q2 = -q2;  // which carries most of the moment
      if (both) q1 = -q1;
    }
    const Json result = check_rows(rows, scene);
    EXPECT_EQ(result["verdict"], "good") << why(result);
    ASSERT_EQ(result["conventions"].size(), 1);
    EXPECT_THAT(result["conventions"][0].get<std::string>(),
                HasSubstr(both ? "tractions look reversed" : "q2 looks reversed"));
  }
}

// From full stick (a flat punch up to 0.849 of its limit), where what slip there is has any direction, to
// nearly gross slip.
TEST(Check, FindsOwnSolutionsGoodAtAnyLoad) {
  for (const char* name : {"flat_punch", "paper"}) {
    for (const char* ratio : {"0.01", "0.5", "0.99", "0.999"}) {
      const solver::Scene scene = scene_of(name, 32, {std::string("load.moment_ratio=") + ratio});
      const Json result = check_rows(rows_of(solver::solve(scene)), scene);
      EXPECT_EQ(result["verdict"], "good") << name << ratio << ": " << why(result);
    }
  }
}

// Loads that do not say the moment: a twist, a force, displacements, friction in pressing alone.
TEST(Check, FindsOwnSolutionsGoodUnderAnyLoad) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> loads{
      {"paper", {"load.twist=0.001"}},
      {"paper", {"load.moment_ratio=0.5", "load.force=[30,20]"}},
      {"off_centre", {"load.twist=-0.001", "load.force=[0,20]"}},
      {"imposed_displacement", {}},
      {"goodman", {}}};
  for (const auto& [name, overrides] : loads) {
    const solver::Scene scene = scene_of(name, 32, overrides);
    const Json result = check_rows(rows_of(solver::solve(scene)), scene);
    EXPECT_EQ(result["verdict"], "good") << name << ": " << why(result);
    EXPECT_THAT(result["conventions"], IsEmpty()) << name;
  }
}

TEST(Check, HasTheErrorsOfSolve) {
  for (const int cells : {24, 33, 64}) {
    const solver::Scene scene = scene_of("paper", cells);
    const solver::Solution solution = solver::solve(scene);
    const Errors errors = compare(solution, *find_oracle(scene).oracle);
    const Json result = check_rows(rows_of(solution), scene, solution.twist_angle);
    EXPECT_EQ(result["verdict"], "good") << why(result);
    EXPECT_NEAR(result["twist_error"], errors.twist, 1e-12);
    EXPECT_NEAR(result["moment_error"], errors.moment, 1e-12);
    EXPECT_NEAR(result["contact_radius_error"], errors.contact_radius, 1e-12);
    EXPECT_NEAR(result["stick_radius_error"], errors.stick_radius, 1e-6);
    EXPECT_NEAR(result["traction_error"]["l1"], errors.traction.at_centres.l1, 1e-9);
    EXPECT_NEAR(result["traction_error"]["averaged"]["l2"], errors.traction.averaged.l2, 1e-9);
    EXPECT_NEAR(result["pressure_error"]["max"], errors.pressure.max, 1e-9);
    EXPECT_NEAR(result["certificate"]["gap"], solution.certificate.gap, 1e-10);
  }
}

// The exact solution stands where the body stands, not where the field's grid does.
TEST(Check, ComparesABodyOffTheOriginInItsPlace) {
  const solver::Scene scene = scene_of("off_centre", 48);
  const solver::Solution solution = solver::solve(scene);
  const Errors errors = compare(solution, *find_oracle(scene).oracle);
  const Json result = check_rows(rows_of(solution), scene);
  EXPECT_NEAR(result["traction_error"]["l1"], errors.traction.at_centres.l1, 1e-6);
  EXPECT_NEAR(result["pressure_error"]["l1"], errors.pressure.l1, 1e-6);
}

// The answers on this mesh and on the finer one are those of one problem: they near each other with the mesh.
TEST(Check, AccountsForTheMeshByWhatItLeavesOpen) {
  for (const char* name : {"paper", "ellipse", "dissimilar"}) {
    const auto mesh_error = [&](int cells) {
      const solver::Scene scene = scene_of(name, cells);
      return check_rows(rows_of(solver::solve(scene)), scene)["yardstick"]["mesh_error"].get<double>();
    };
    const double coarse = mesh_error(24);
    EXPECT_LE(coarse, 0.05) << name;
    EXPECT_LE(mesh_error(72), coarse / 3.0) << name;  // like h or faster
  }
}

// All of the gap that two digits leave is rounding's, and within what is put down to it.
TEST(Check, AccountsForTheDigitsOfTheFile) {
  const solver::Scene scene = scene_of("paper", 64);
  FieldRows rows = rows_of(solver::solve(scene));
  for (FieldRow& row : rows) {
    for (const std::size_t column : {2, 3, 4}) row[column] = std::stod(fmt::format("{:.1e}", row[column]));
  }
  const Json result = check_rows(rows, scene);
  EXPECT_EQ(result["verdict"], "good") << why(result);
  const Json& gap = result["judged"].back();
  ASSERT_EQ(gap["quantity"], "gap");
  const double of_digits = gap["allowed"].get<double>() - 4.0 * result["yardstick"]["gap"].get<double>();
  EXPECT_LE(std::abs(gap["value"].get<double>()), of_digits);
}

// At cell centres. Where the pressure changes within a cell or two that takes a finer grid.
TEST(Check, FindsExactFieldsGood) {
  for (const auto& [name, cells] :
       {std::pair{"paper", 32}, {"paper", 64}, {"cone", 32}, {"mindlin", 32}, {"rounded_punch", 64}}) {
    const solver::Scene scene = scene_of(name, cells);
    const std::filesystem::path file = temporary_file("exact.h5");
    write_exact_fields(file, scene, require_oracle(scene));
    const Json result = check_field(scene, file);
    EXPECT_EQ(result["verdict"], "good") << name << cells << ": " << why(result);
    EXPECT_LE(result["traction_error"]["l2"], 1e-12) << name;
  }
}

TEST(Check, SaysThatAnInfinitePressureCannotBeSampled) {
  const solver::Scene scene = scene_of("flat_punch");
  const std::filesystem::path file = temporary_file("punch.csv");
  write_exact_fields(file, scene, require_oracle(scene));
  const Json result = check_field(scene, file);
  EXPECT_EQ(result["verdict"], "bad");
  EXPECT_THAT(why(result), AllOf(HasSubstr("normal load"), HasSubstr("sampled at cell centres")));
}

// On a circle frozen directions fade with the mesh, on an ellipse they do not.
TEST(Check, FindsThePapersMethodGoodOnACircleAndBadOnAnEllipse) {
  for (const auto& [name, verdict] : {std::pair{"paper", "good"}, std::pair{"ellipse", "bad"}}) {
    const solver::Scene scene = scene_of(name, 48, {"solver.method=paper"});
    const Json result = check_rows(rows_of(solver::solve(scene)), scene);
    EXPECT_EQ(result["verdict"], verdict) << why(result);
    if (result["verdict"] == "good") continue;
    EXPECT_THAT(why(result), AllOf(HasSubstr("slip is not opposed to traction"),
                                   HasSubstr("slipping cells that keep a direction")));
    EXPECT_TRUE(result["diagnosis"]["kernel"].is_null());
  }
}

TEST(Check, FindsPressuresTangentialDisplacementMissing) {
  const solver::Scene scene = scene_of("dissimilar");
  const Json result =
      check_rows(rows_of(solver::solve(scene_of("dissimilar", 32, {"contact.coupling=none"}))), scene);
  EXPECT_EQ(result["verdict"], "bad");
  EXPECT_THAT(why(result), HasSubstr("K13 and K23 missing"));
}

class CheckConventions : public testing::Test {
 protected:
  solver::Scene scene_ = scene_of("ellipse", 32);
  FieldRows rows_ = rows_of(solver::solve(scene_));
  Json base_ = check_rows(rows_, scene_);

  /// The same verdict and numbers as the field in this project's own conventions.
  void expect_same(const FieldRows& rows, const std::vector<std::string>& notes) const {
    const Json result = check_rows(rows, scene_);
    EXPECT_EQ(result["verdict"], "good") << why(result);
    for (const char* key : {"twist_angle", "moment", "normal_load", "stick_radius", "contact_radius"}) {
      EXPECT_NEAR(result[key].get<double>() / base_[key].get<double>(), 1.0, 1e-8) << key;
    }
    ASSERT_EQ(result["conventions"].size(), notes.size()) << result["conventions"];
    for (std::size_t i = 0; i < notes.size(); ++i) {
      EXPECT_THAT(result["conventions"][i].get<std::string>(), HasSubstr(notes[i]));
    }
  }
};

TEST_F(CheckConventions, OrderOfRows) { expect_same(shuffled(rows_), {}); }

TEST_F(CheckConventions, SignsAndComponents) {
  using std::swap;
  expect_same(changed(rows_, [](FieldRow& r) { r[3] = -r[3], r[4] = -r[4]; }), {"tractions look reversed"});
  expect_same(changed(rows_, [](FieldRow& r) { r[3] = -r[3]; }), {"q1 looks reversed"});
  expect_same(changed(rows_, [](FieldRow& r) { r[4] = -r[4]; }), {"q2 looks reversed"});
  expect_same(changed(rows_, [](FieldRow& r) { swap(r[3], r[4]); }), {"q1 and q2 look exchanged"});
}

TEST_F(CheckConventions, Axes) {
  using std::swap;
  expect_same(changed(rows_, [](FieldRow& r) { swap(r[0], r[1]), swap(r[3], r[4]); }),
              {"axes look exchanged"});
  // Turned by 90 degrees: read with axes exchanged, which is a mirror, the moment turns the other way.
  expect_same(changed(rows_,
                      [](FieldRow& r) {
                        r = {-r[1], r[0], r[2], -r[4], r[3]};
                      }),
              {"axes look exchanged", "tractions look reversed"});
}

TEST_F(CheckConventions, Units) {
  const auto in = [&](double metre, double pascal) {
    return changed(rows_, [=](FieldRow& r) {
      r = {r[0] * metre, r[1] * metre, r[2] * pascal, r[3] * pascal, r[4] * pascal};
    });
  };
  expect_same(in(1e3, 1.0), {"positions look like mm"});
  expect_same(in(1.0, 1e-6), {"pressure and tractions look like MPa"});
  expect_same(in(1e3, 1e-6), {"positions look like mm", "pressure and tractions look like MPa"});
  expect_same(in(1e6, 1e-9), {"positions look like micrometres", "pressure and tractions look like GPa"});
  EXPECT_THROW(check_rows(in(1e3, 3e-7), scene_), solver::InputError);
}

TEST_F(CheckConventions, OriginAndPartsOfACell) {
  const double cell = base_["cell_size"][0];
  const auto moved = [&](double by) {
    return changed(rows_, [=](FieldRow& r) { r[0] += by, r[1] -= 0.5 * by; });
  };
  expect_same(moved(0.3 * cell), {});
  expect_same(moved(40.0 * cell), {"moved there"});
}

TEST_F(CheckConventions, FewDigits) {
  for (const int digits : {10, 6}) {
    const Json result = check_field(scene_, write_rows(rows_, digits));
    EXPECT_EQ(result["verdict"], "good") << digits << why(result);
    EXPECT_NEAR(result["stick_cells"], base_["stick_cells"].get<double>(), 2.0);
    EXPECT_LE(result["certificate"]["friction_bound"], 2e-5);
  }
}

class CheckBadField : public testing::Test {
 protected:
  solver::Scene scene_ = scene_of("paper", 48);
  solver::Solution solution_ = solver::solve(scene_);
  FieldRows rows_ = rows_of(solution_);

  void expect_bad(const FieldRows& rows, const testing::Matcher<std::string>& reason,
                  std::optional<double> twist = {}) const {
    const Json result = check_rows(rows, scene_, twist);
    EXPECT_EQ(result["verdict"], "bad");
    EXPECT_THAT(why(result), reason);
  }
};

FieldRows with_tractions_times(const FieldRows& rows, double factor) {
  return changed(rows, [=](FieldRow& r) { r[3] *= factor, r[4] *= factor; });
}

TEST_F(CheckBadField, AnotherFrictionCoefficient) {
  expect_bad(
      with_tractions_times(rows_, 0.95),
      AllOf(HasSubstr("moment is 5 % too low"), HasSubstr("friction coefficient of 0.095 in place of 0.1")));
  for (const double factor : {1.05, 1.2}) {  // the second beyond what friction can carry
    const Json result = check_rows(with_tractions_times(rows_, factor), scene_);
    EXPECT_EQ(result["verdict"], "bad");
    EXPECT_THAT(why(result), AllOf(HasSubstr("|q| exceeds mu p"),
                                   HasSubstr(fmt::format("friction coefficient of {:.4g}", 0.1 * factor))));
    // Displacements and the twist that fits them grow with the tractions.
    EXPECT_NEAR(result["twist_angle"].get<double>() / solution_.twist_angle, factor, 1e-3);
  }
}

TEST_F(CheckBadField, OneCellBeyondFriction) {
  FieldRows rows = rows_;
  for (const std::size_t c : {3, 4}) rows[100][c] *= 1.01;
  expect_bad(rows, HasSubstr("|q| exceeds mu p by 1 %"));
}

// The normal contact's tolerance decides whether such a cell touches at all.
TEST_F(CheckBadField, NotACellThatCarriesNextToNothing) {
  FieldRows rows = rows_;
  const double tiny = 1e-9 * rows[rows.size() / 2 + 15][2];
  rows.push_back({rows[0][0], -rows[0][1] + (rows[1][1] - rows[0][1]), tiny, 0.0, 0.5 * tiny});
  const Json result = check_rows(rows, scene_);
  EXPECT_EQ(result["verdict"], "good") << why(result);
}

TEST_F(CheckBadField, TractionsTurnedByFiveDegrees) {
  const double cosine = std::cos(5.0 * std::numbers::pi / 180.0);
  const double sine = std::sin(5.0 * std::numbers::pi / 180.0);
  expect_bad(changed(rows_,
                     [=](FieldRow& r) {
                       r = {r[0], r[1], r[2], cosine * r[3] - sine * r[4], sine * r[3] + cosine * r[4]};
                     }),
             AllOf(HasSubstr("slip is not opposed to traction"), Not(HasSubstr("K12"))));
}

TEST_F(CheckBadField, LoadAndPressure) {
  expect_bad(changed(rows_, [](FieldRow& r) { r[2] *= 0.95, r[3] *= 0.95, r[4] *= 0.95; }),
             HasSubstr("the normal load is 5 % too low"));
  solver::Scene scene = scene_;
  scene.steps.front().torsion.moment_ratio = 0.85;
  const Json result = check_rows(rows_, scene);
  EXPECT_EQ(result["verdict"], "bad");
  EXPECT_THAT(why(result), HasSubstr("the moment is 5.9 % too high"));
}

TEST_F(CheckBadField, Twists) {
  const double twist = solution_.twist_angle;
  expect_bad(rows_, AllOf(HasSubstr("twist is 50 % too low"), HasSubstr("one body only")), 0.5 * twist);
  expect_bad(rows_, HasSubstr("twice the compliance"), 2.0 * twist);
  expect_bad(rows_, HasSubstr("degrees"), twist * 180.0 / std::numbers::pi);
  expect_bad(rows_, AllOf(HasSubstr("twist is 3 % too high"), HasSubstr("not that of these tractions")),
             1.03 * twist);
  EXPECT_EQ(check_rows(rows_, scene_, -twist)["verdict"], "good");  // a matter of convention, and said so
}

TEST_F(CheckBadField, StoppedTooEarly) {
  solver::Scene scene =
      scene_of("ellipse", 48, {"solver.method=projected_gradient", "solver.max_iterations=3"});
  const Json result = check_rows(rows_of(solver::solve(scene)), scene);
  EXPECT_EQ(result["verdict"], "bad");
  EXPECT_THAT(why(result), HasSubstr("an iteration stops too early"));
}

TEST_F(CheckBadField, OneCellMissing) {
  FieldRows rows = rows_;
  rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2 + 15));
  const Json result = check_rows(rows, scene_);
  ASSERT_EQ(result["conventions"].size(), 1U);
  EXPECT_THAT(result["conventions"][0].get<std::string>(), HasSubstr("carry nothing"));
  EXPECT_EQ(result["contact_cells"], rows.size());
}

TEST_F(CheckBadField, NotJudged) {
  FieldRows negative = rows_;
  negative[6][2] = -1.0;
  try {
    check_rows(negative, scene_);
    ADD_FAILURE() << "a negative pressure";
  } catch (const solver::InputError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("row 7"), HasSubstr("pressure = -1"), HasSubstr("zero or positive")));
  }
  EXPECT_THROW(check_rows(with_tractions_times(rows_, 0.0), scene_), solver::InputError);
  EXPECT_THROW(check_rows(rows_, scene_of("torsion_and_force")), solver::InputError);
  solver::Scene frictionless = scene_;
  frictionless.friction = 0.0;
  EXPECT_THROW(check_rows(rows_, frictionless), solver::InputError);
}

}  // namespace
}  // namespace slipstick::convergence
