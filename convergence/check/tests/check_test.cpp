// Fields of other programs, judged.

#include "convergence/check/check.hpp"

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <ostream>
#include <random>
#include <tuple>

#include "convergence/check/tests/written_field.hpp"
#include "convergence/oracle/errors.hpp"
#include "convergence/results/exact_result.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/tests/complaint.hpp"

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

FieldRows solved(const solver::Scene& scene) { return rows_of(solver::solve(scene)); }

/// The exact field at cell centres.
FieldRows sampled(const solver::Scene& scene) {
  const std::filesystem::path file = temporary_file("exact.h5");
  write_exact_fields(file, scene, require_oracle(scene));
  return read_rows(file);
}

double allowed(const Json& result, const std::string& quantity) {
  for (const Json& item : result["judged"]) {
    if (item["quantity"] == quantity) return item["allowed"];
  }
  return NAN;
}

Json check_peer(const std::string& name, std::optional<double> twist = {}) {
  return check_field(scene_of("paper"), kFields + "/" + name + "-64-0.9.csv", {.twist = twist});
}

std::string why(const Json& result) { return result["why"]; }

Json find_good(const FieldRows& rows, const solver::Scene& scene, std::optional<double> twist = {}) {
  Json result = check_rows(rows, scene, twist);
  EXPECT_EQ(result["verdict"], "good") << scene.name << ", " << scene.cells[0] << " cells: " << why(result);
  return result;
}

Json find_bad(const FieldRows& rows, const solver::Scene& scene, const testing::Matcher<std::string>& reason,
              std::optional<double> twist = {}) {
  Json result = check_rows(rows, scene, twist);
  EXPECT_EQ(result["verdict"], "bad") << why(result);
  EXPECT_THAT(why(result), reason);
  return result;
}

FieldRows with_tractions_times(const FieldRows& rows, double factor) {
  return changed(rows, [=](FieldRow& r) { r[3] *= factor, r[4] *= factor; });
}

FieldRows with_stresses_times(const FieldRows& rows, double factor) {
  return changed(rows, [=](FieldRow& r) { r[2] *= factor, r[3] *= factor, r[4] *= factor; });
}

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

// Its moment and stick radius look right. What gives it away is its twist, its slip, and one kernel with
// which its stick area moves as one body, by the very twist that it reported.
TEST(Check, FindsAMirroredCrossKernel) {
  const double twist = 2.21775472e-3;
  const Json reported = check_peer("cgcontact", twist);
  EXPECT_EQ(reported["verdict"], "bad");
  EXPECT_LE(std::abs(reported["moment_error"].get<double>()), 1e-6);
  EXPECT_NEAR(reported["twist_error"], -0.0607, 1e-4);
  EXPECT_THAT(why(reported), AllOf(HasSubstr("the moment is right"), HasSubstr("the twist is 6.1 % too low"),
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
    const Json result = find_good(rows_of(solution), scene);
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
    const Json good = check_rows(solved(scene), scene);
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
    const Json bad = find_bad(solved(softer), scene, HasSubstr("the contact radius is 26 % too high"));
    EXPECT_NEAR(bad["contact_radius_error"], std::cbrt(2.0) - 1.0, 1e-2) << name;
  }
}

TEST(Check, FindsReversedComponentsOnAnEllipseUnderAnImposedTwist) {
  const solver::Scene scene = scene_of("ellipse", 32, {"load.twist=1e-3"});
  const FieldRows right = solved(scene);
  for (const bool both : {false, true}) {
    FieldRows rows = right;
    for (auto& [x1, x2, pressure, q1, q2] : rows) {
      q2 = -q2;  // which carries most of the moment
      if (both) q1 = -q1;
    }
    const Json result = check_rows(rows, scene);
    EXPECT_EQ(result["verdict"], both ? "good" : "bad") << why(result);
    ASSERT_EQ(result[both ? "conventions" : "mistakes"].size(), 1);
    EXPECT_THAT(result[both ? "conventions" : "mistakes"][0].get<std::string>(),
                HasSubstr(both ? "tractions look reversed" : "q2 looks reversed"));
  }
}

// Loads that do not say the moment: a twist, a force, displacements, friction in pressing alone; and those
// from full stick (a flat punch up to 0.849 of its limit), where what slip there is has any direction, to
// nearly gross slip, and imposed motions beyond it.
TEST(Check, FindsOwnSolutionsGoodUnderAnyLoad) {
  std::vector<std::pair<std::string, std::vector<std::string>>> loads{
      {"paper", {"load.twist=0.001"}},
      {"paper", {"load.twist=7e-3"}},
      {"paper", {"load.twist=2e-2"}},
      {"paper", {"load.twist=3e-3", "load.displacement=[3e-6,0]"}},
      {"paper", {"load.moment_ratio=0.5", "load.force=[30,20]"}},
      {"off_centre", {"load.twist=-0.001", "load.force=[0,20]"}},
      {"imposed_displacement", {}},
      {"goodman", {}},
      {"ellipse", {"load.twist=1e-3"}},
      {"ellipse", {"load.twist=-1e-3", "load.force=[0,20]"}},
      {"ellipse", {"load.moment_ratio=0.5", "load.displacement=[1e-7,0]"}}};
  for (const char* name : {"flat_punch", "paper"}) {
    for (const char* ratio : {"0.01", "0.5", "0.99", "0.999"}) {
      loads.push_back({name, {std::string("load.moment_ratio=") + ratio}});
    }
  }
  for (const auto& [name, load] : loads) {
    SCOPED_TRACE(fmt::format("{} {}", name, fmt::join(load, " ")));
    const solver::Scene scene = scene_of(name, 32, load);
    const Json result = find_good(solved(scene), scene);
    EXPECT_TRUE(result["discrete"]["holds"].get<bool>()) << why(result);
    EXPECT_FALSE(result["yardstick"]["loads_scaled_down"].get<bool>());
    EXPECT_THAT(result["conventions"], IsEmpty());
  }
}

TEST(Check, HasTheErrorsOfSolve) {
  for (const int cells : {24, 33, 64}) {
    const solver::Scene scene = scene_of("paper", cells);
    const solver::Solution solution = solver::solve(scene);
    const Errors errors = compare(solution, *find_oracle(scene).oracle);
    const Json result = find_good(rows_of(solution), scene, solution.twist_angle);
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
      return check_rows(solved(scene), scene)["yardstick"]["mesh_error"].get<double>();
    };
    const double coarse = mesh_error(24);
    EXPECT_LE(coarse, 0.05) << name;
    EXPECT_LE(mesh_error(72), coarse / 3.0) << name;  // like h or faster
  }
}

// All of the gap that two digits leave is rounding's, and within what is put down to it.
TEST(Check, AccountsForTheDigitsOfTheFile) {
  const solver::Scene scene = scene_of("paper", 64);
  FieldRows rows = solved(scene);
  for (FieldRow& row : rows) {
    for (const std::size_t column : {2, 3, 4}) row[column] = std::stod(fmt::format("{:.1e}", row[column]));
  }
  const Json result = find_good(rows, scene);
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
    const Json result = find_good(sampled(scene), scene);
    EXPECT_LE(result["traction_error"]["l2"], 1e-12) << name;
  }
}

TEST(Check, FindsExactFieldsGoodAtAnyLoad) {
  for (const char* name : {"paper", "cone"}) {
    for (const int cells : {32, 64}) {
      for (const char* ratio : {"0.1", "0.3", "0.6", "0.9", "0.99"}) {
        const solver::Scene scene = scene_of(name, cells, {std::string("load.moment_ratio=") + ratio});
        find_good(sampled(scene), scene, find_oracle(scene).oracle->twist_angle);
      }
    }
  }
}

// Samples of the exact answer do not solve the grid's problem of constant cells: they are right within the
// mesh all the same.
TEST(Check, AsksTwoQuestions) {
  const solver::Scene scene = scene_of("paper", 48);
  for (const bool exact : {false, true}) {
    const auto file = write_rows(exact ? sampled(scene) : solved(scene));
    const Json result = check_field(scene, file);
    EXPECT_EQ(result["verdict"], "good") << why(result);
    EXPECT_EQ(result["discrete"]["holds"], !exact);
    EXPECT_THAT(why(result), HasSubstr(exact ? "it does not solve its own grid's problem"
                                             : "it solves its own grid's problem"));
    EXPECT_EQ(check_field(scene, file, {.discrete = true})["verdict"], exact ? "bad" : "good");
  }
}

// On p and both components, of 0.03 to 0.2 %.
TEST(Check, FindsNoisyFieldsGood) {
  for (const auto& [name, cells, ratio] :
       {std::tuple{"paper", 64, 0.3}, {"paper", 32, 0.6}, {"ellipse", 64, 0.9}}) {
    const solver::Scene scene = scene_of(name, cells, {fmt::format("load.moment_ratio={}", ratio)});
    const FieldRows rows = solved(scene);
    for (const double noise : {3e-4, 1e-3, 2e-3}) {
      std::mt19937 random(1);
      std::normal_distribution<double> factor(1.0, noise);
      const FieldRows noisy = changed(
          rows, [&](FieldRow& r) { r[2] *= factor(random), r[3] *= factor(random), r[4] *= factor(random); });
      const Json result = find_good(noisy, scene);
      EXPECT_FALSE(result["discrete"]["holds"].get<bool>());
    }
  }
}

// A program controls its loads: they may differ by the quadrature of its cells alone, which falls with their
// number, whatever its tractions are.
TEST(Check, AllowsOfLoadsNoMoreThanTheirQuadrature) {
  for (const auto& [cells, most] : {std::pair{32, 4e-3}, {64, 1e-3}, {128, 2.5e-4}}) {
    const solver::Scene scene = scene_of("paper", cells);
    const Json result = check_rows(solved(scene), scene);
    EXPECT_LE(allowed(result, "moment_error"), most) << cells;
    EXPECT_LE(allowed(result, "normal_load_error"), most) << cells;
  }
}

TEST(Check, JudgesTheMomentThatAnImposedTwistCauses) {
  find_bad(solved(scene_of("paper", 48, {"load.twist=1.02e-3"})), scene_of("paper", 48, {"load.twist=1e-3"}),
           HasSubstr("the moment is"));
}

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
    const Json result = find_bad(solved(scene_of(GetParam().scene, GetParam().cells, load(factor))), scene_,
                                 HasSubstr("the moment is"));
    EXPECT_TRUE(result["discrete"]["holds"].get<bool>());
    EXPECT_THAT(why(result), HasSubstr("it solves its own grid's problem"));
  }
}

TEST_P(CheckCoarseBadField, NormalLoadOnePercentOff) {
  find_bad(with_stresses_times(rows_, 0.99), scene_, HasSubstr("the normal load is 1 % too low"));
}

TEST_P(CheckCoarseBadField, StoppedAtAGapOfOnePercent) {
  solver::Solution stopped;
  // A last step may take it further than was asked for.
  for (const char* tolerance : {"1e-2", "2e-2", "4e-2", "8e-2"}) {
    stopped = solver::solve(scene_of(
        GetParam().scene, GetParam().cells,
        {load()[0], "solver.method=projected_gradient", fmt::format("solver.tolerance={}", tolerance)}));
    if (stopped.certificate.gap >= 3e-3) break;
  }
  ASSERT_GE(stopped.certificate.gap, 3e-3);
  find_bad(rows_of(stopped), scene_, HasSubstr("an iteration stops too early"));
}

// The moment is as it should be, and so is every cell's bound. |q|/p tells.
TEST_P(CheckCoarseBadField, FrictionTwoPercentLowUnderTheSameMoment) {
  find_bad(solved(scene_of(GetParam().scene, GetParam().cells,
                           {fmt::format("load.moment={}", solution_.moment), "contact.friction=0.098"})),
           scene_,
           AllOf(HasSubstr("the moment is right"), HasSubstr("|q|/p in the slip ring is 2 % too low"),
                 HasSubstr("friction coefficient of 0.098 in place of 0.1")));
}

TEST_P(CheckCoarseBadField, OneQuadrantTwoPercentLow) {
  find_bad(changed(rows_,
                   [](FieldRow& r) {
                     const double factor = r[0] > 0.0 && r[1] > 0.0 ? 0.98 : 1.0;
                     r[3] *= factor, r[4] *= factor;
                   }),
           scene_, testing::_);
}

// The twist that is wrong is that which was given, and no sentence calls it right.
TEST_P(CheckCoarseBadField, TwistOnePercentHigh) {
  find_bad(rows_, scene_,
           AllOf(HasSubstr("the twist is 1 % too high"), HasSubstr("not that of these tractions"),
                 Not(HasSubstr("the twist is right"))),
           1.01 * solution_.twist_angle);
}

INSTANTIATE_TEST_SUITE_P(Scenes, CheckCoarseBadField,
                         testing::Values(Coarse{"paper", 64, 0.3}, Coarse{"paper", 32, 0.6},
                                         Coarse{"ellipse", 64, 0.3}, Coarse{"cone", 32, 0.6}));

// What is wrong with one number is said of that one alone: a right twist is not called another one's.
TEST(Check, DoesNotContradictItself) {
  const solver::Scene scene = scene_of("paper", 48);
  const solver::Solution solution = solver::solve(scene);
  for (const double factor : {0.5, 0.97, 0.995, 1.0}) {
    const FieldRows rows = changed(rows_of(solution), [=](FieldRow& r) {
      const double inside = std::hypot(r[0], r[1]) < 1e-4 ? factor : 1.0;
      r[3] *= inside, r[4] *= inside;
    });
    const std::string text = why(check_rows(rows, scene, solution.twist_angle));
    EXPECT_FALSE(text.find("the twist is right") != std::string::npos &&
                 text.find("a twist that is not") != std::string::npos)
        << text;
    EXPECT_FALSE(text.find("Coulomb's law holds") != std::string::npos &&
                 text.find("slip is not opposed") != std::string::npos)
        << text;
  }
}

// In place of what the mesh leaves open, both ways.
TEST(Check, TakesTheTolerance) {
  const solver::Scene scene = scene_of("paper", 64);
  const FieldRows rows = with_stresses_times(solved(scene), 0.995);
  EXPECT_EQ(check_field(scene, write_rows(rows), {})["verdict"], "bad");
  EXPECT_EQ(check_field(scene, write_rows(rows), {.tolerance = 0.02})["verdict"], "good");
  const auto exact = write_rows(sampled(scene));
  EXPECT_EQ(check_field(scene, exact, {})["verdict"], "good");
  EXPECT_EQ(check_field(scene, exact, {.tolerance = 1e-5})["verdict"], "bad");
}

TEST(Check, SaysThatAnInfinitePressureCannotBeSampled) {
  const solver::Scene scene = scene_of("flat_punch");
  find_bad(sampled(scene), scene, AllOf(HasSubstr("normal load"), HasSubstr("sampled at cell centres")));
}

// On a circle frozen directions fade with the mesh, on an ellipse they do not.
TEST(Check, FindsThePapersMethodGoodOnACircleAndBadOnAnEllipse) {
  for (const auto& [name, verdict] : {std::pair{"paper", "good"}, std::pair{"ellipse", "bad"}}) {
    const solver::Scene scene = scene_of(name, 48, {"solver.method=paper"});
    const Json result = check_rows(solved(scene), scene);
    EXPECT_EQ(result["verdict"], verdict) << why(result);
    if (result["verdict"] == "good") continue;
    EXPECT_THAT(why(result), AllOf(HasSubstr("slip is not opposed to traction"),
                                   HasSubstr("slipping cells that keep a direction")));
    EXPECT_TRUE(result["diagnosis"]["kernel"].is_null());
  }
}

TEST(Check, FindsPressuresTangentialDisplacementMissing) {
  find_bad(solved(scene_of("dissimilar", 32, {"contact.coupling=none"})), scene_of("dissimilar"),
           HasSubstr("K13 and K23 missing"));
}

class CheckConventions : public testing::Test {
 protected:
  solver::Scene scene_ = scene_of("ellipse", 32);
  FieldRows rows_ = rows_of(solver::solve(scene_));
  Json base_ = check_rows(rows_, scene_);

  /// The same verdict and numbers as the field in this project's own conventions.
  void expect_same(const FieldRows& rows, const std::vector<std::string>& notes) const {
    const Json result = find_good(rows, scene_);
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
  expect_same(changed(rows_, [](FieldRow& r) { swap(r[3], r[4]); }), {"q1 and q2 look exchanged"});
}

// No frame and no body has it.
TEST_F(CheckConventions, NoComponentIsReversedAlone) {
  for (const std::size_t component : {3, 4}) {
    const Json result = find_bad(changed(rows_, [=](FieldRow& r) { r[component] = -r[component]; }), scene_,
                                 HasSubstr(fmt::format("q{} looks reversed alone", component - 2)));
    EXPECT_TRUE(result["within_mesh"].get<bool>()) << why(result);  // all the rest is right
    EXPECT_THAT(result["conventions"], IsEmpty());
  }
}

TEST_F(CheckConventions, StandInTheFirstLineAndStrictTakesNone) {
  const auto file =
      write_rows(changed(rows_, [](FieldRow& r) { r[3] = -r[3], r[4] = -r[4], r[0] *= 1e3, r[1] *= 1e3; }));
  const Json taken = check_field(scene_, file);
  EXPECT_EQ(taken["verdict"], "good");
  const std::string text = check_text(taken);
  EXPECT_THAT(text.substr(0, text.find('\n')),
              AllOf(HasSubstr("good (positions look like mm; tractions look reversed")));
  const Json strict = check_field(scene_, file, {.strict = true});
  EXPECT_EQ(strict["verdict"], "bad");
  EXPECT_THAT(why(strict), AllOf(HasSubstr("positions look like mm"), HasSubstr("tractions look reversed")));
  EXPECT_EQ(check_field(scene_, write_rows(rows_), {.strict = true})["verdict"], "good");
}

// Under a force a mirrored frame is not the other body: only the moment turns round.
TEST(Check, ReadsALeftHandedFrame) {
  const solver::Scene scene = scene_of("paper", 32, {"load.moment_ratio=0.5", "load.force=[30,20]"});
  const FieldRows rows = changed(solved(scene), [](FieldRow& r) { r[1] = -r[1], r[4] = -r[4]; });
  const Json result = find_good(rows, scene);
  ASSERT_EQ(result["conventions"].size(), 1U);
  EXPECT_THAT(result["conventions"][0].get<std::string>(), HasSubstr("left-handed"));
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
};

TEST_F(CheckBadField, AnotherFrictionCoefficient) {
  find_bad(
      with_tractions_times(rows_, 0.95), scene_,
      AllOf(HasSubstr("moment is 5 % too low"), HasSubstr("friction coefficient of 0.095 in place of 0.1")));
  for (const double factor : {1.05, 1.2}) {  // the second beyond what friction can carry
    const Json result =
        find_bad(with_tractions_times(rows_, factor), scene_,
                 AllOf(HasSubstr("|q| exceeds mu p"),
                       HasSubstr(fmt::format("friction coefficient of {:.4g}", 0.1 * factor))));
    // Displacements and the twist that fits them grow with the tractions.
    EXPECT_NEAR(result["twist_angle"].get<double>() / solution_.twist_angle, factor, 1e-3);
  }
}

TEST_F(CheckBadField, OneCellBeyondFriction) {
  FieldRows rows = rows_;
  for (const std::size_t c : {3, 4}) rows[100][c] *= 1.01;
  find_bad(rows, scene_, HasSubstr("|q| exceeds mu p by 1 %"));
}

// The normal contact's tolerance decides whether such a cell touches at all.
TEST_F(CheckBadField, NotACellThatCarriesNextToNothing) {
  FieldRows rows = rows_;
  const double tiny = 1e-9 * rows[rows.size() / 2 + 15][2];
  rows.push_back({rows[0][0], -rows[0][1] + (rows[1][1] - rows[0][1]), tiny, 0.0, 0.5 * tiny});
  find_good(rows, scene_);
}

TEST_F(CheckBadField, TractionsTurnedByFiveDegrees) {
  const double cosine = std::cos(5.0 * std::numbers::pi / 180.0);
  const double sine = std::sin(5.0 * std::numbers::pi / 180.0);
  find_bad(changed(rows_,
                   [=](FieldRow& r) {
                     r = {r[0], r[1], r[2], cosine * r[3] - sine * r[4], sine * r[3] + cosine * r[4]};
                   }),
           scene_, AllOf(HasSubstr("slip is not opposed to traction"), Not(HasSubstr("K12"))));
}

TEST_F(CheckBadField, LoadAndPressure) {
  find_bad(with_stresses_times(rows_, 0.95), scene_, HasSubstr("the normal load is 5 % too low"));
  solver::Scene scene = scene_;
  scene.steps.front().torsion = solver::MomentRatio{0.85};
  find_bad(rows_, scene, HasSubstr("the moment is 5.9 % too high"));
}

TEST_F(CheckBadField, Twists) {
  const double twist = solution_.twist_angle;
  find_bad(rows_, scene_, AllOf(HasSubstr("twist is 50 % too low"), HasSubstr("one body only")), 0.5 * twist);
  find_bad(rows_, scene_, HasSubstr("twice the compliance"), 2.0 * twist);
  find_bad(rows_, scene_, HasSubstr("degrees"), twist * 180.0 / std::numbers::pi);
  find_bad(rows_, scene_, AllOf(HasSubstr("twist is 3 % too high"), HasSubstr("not that of these tractions")),
           1.03 * twist);
  EXPECT_EQ(check_rows(rows_, scene_, -twist)["verdict"], "good");  // a matter of convention, and said so
}

TEST_F(CheckBadField, StoppedTooEarly) {
  solver::Scene scene =
      scene_of("ellipse", 48, {"solver.method=projected_gradient", "solver.max_iterations=3"});
  find_bad(solved(scene), scene, HasSubstr("an iteration stops too early"));
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
  EXPECT_THAT(solver::complaint([&] { check_rows(negative, scene_); }),
              AllOf(HasSubstr("row 7"), HasSubstr("pressure = -1"), HasSubstr("zero or positive")));
  EXPECT_THROW(check_rows(with_tractions_times(rows_, 0.0), scene_), solver::InputError);
  EXPECT_THROW(check_rows(rows_, scene_of("torsion_and_force")), solver::InputError);
  solver::Scene frictionless = scene_;
  frictionless.friction = 0.0;
  EXPECT_THROW(check_rows(rows_, frictionless), solver::InputError);
}

}  // namespace
}  // namespace slipstick::convergence
