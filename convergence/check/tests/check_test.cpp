// Fields of other programs, judged.

#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>

#include "convergence/check/tests/checked_field.hpp"
#include "convergence/oracle/errors.hpp"
#include "solver/input/tests/complaint.hpp"

namespace slipstick::convergence {
namespace {

using namespace testing;

TEST(Check, FindsContactsOwnFieldGood) {
  const double twist = 2.361048651456917e-3;
  for (const Checked& result : {check_peer("contact", twist), check_peer("contact")}) {
    EXPECT_EQ(result["verdict"], "good") << why(result);
    EXPECT_THAT(result["conventions"], IsEmpty());
    EXPECT_NEAR(result["twist_angle"].get<double>() / twist, 1.0, 1e-6);
    // Its makers would find the moment 2.3e-5 low, 7.7e-3 in L2, and the counted stick radius within a cell,
    // 1/32.
    EXPECT_NEAR(result["moment_error"], -2.3e-5, 1e-6);
    EXPECT_NEAR(result["traction_error"]["l2"], 7.7e-3, 1e-4);
    EXPECT_LE(std::abs(result["stick_radius_counted_error"].get<double>()), 1.0 / 32.0);
    EXPECT_LE(result["certificate"]["gap"], 1e-6);
  }
}

// Moment and stick radius are right. The twist, the slip directions and one wrong kernel give the field away:
// with that kernel the stick area moves as a rigid body, by the reported twist.
TEST(Check, FindsAMirroredCrossKernel) {
  const double twist = 2.21775472e-3;
  const Checked reported = check_peer("cgcontact", twist);
  EXPECT_EQ(reported["verdict"], "bad");
  EXPECT_LE(std::abs(reported["moment_error"].get<double>()), 1e-6);
  EXPECT_NEAR(reported["twist_error"], -0.0607, 1e-4);
  EXPECT_THAT(reported, AllOf(Not(Breaks("moment_error")), IsOff("twist", -0.061), Breaks("slip_direction"),
                              names(mistake::cross_kernel_even), names(mistake::kept_directions),
                              Not(names(mistake::other_twist))));
  const Checked inferred = check_peer("cgcontact");
  EXPECT_EQ(inferred["verdict"], "bad");
  EXPECT_THAT(inferred, names(mistake::cross_kernel_even));
  const Json& diagnosis = inferred["diagnosis"];
  EXPECT_TRUE(diagnosis["stick_area_explained"]);
  const Json& kernel = diagnosis["tried"][0];
  EXPECT_EQ(kernel["name"], diagnosis["kernel"]);
  EXPECT_NEAR(kernel["twist_angle"].get<double>() / twist, 1.0, 1e-6);
  EXPECT_LE(kernel["stick_gap"], 1e-5 * diagnosis["as_it_should_be"]["stick_gap"].get<double>());
}

// A layer's thickness and compliance are lengths: a field has cells of its own, whatever the scene's are.
TEST(Check, JudgesLayersOnTheFieldsOwnCells) {
  const std::vector<std::vector<std::string>> layers{
      {"lower.layer={thickness=1e-4,young_modulus=420e9,poisson_ratio=0.25}", "contact.coupling=none"},
      {"upper.layer={thickness=3e-4,young_modulus=20e9,poisson_ratio=0.4}", "contact.coupling=none"},
      {"layer={kind=\"winkler\",normal_compliance=3e-16,tangential_compliance=5e-15}",
       "grid.extent=[1.3e-3,1.3e-3]"}};
  for (std::vector<std::string> settings : layers) {
    settings.emplace_back("load.moment_ratio=0.5");
    const FieldRows own = solved(scene_of("paper", 32, settings));
    const Checked same_cells = find_good(own, scene_of("paper", 32, settings));
    const Checked other_cells = find_good(own, scene_of("paper", 48, settings));
    EXPECT_TRUE(other_cells["discrete"]["holds"].get<bool>());
    EXPECT_NEAR(other_cells["twist_angle"].get<double>() / same_cells["twist_angle"].get<double>(), 1.0,
                1e-9);
    for (const Json& item : same_cells["judged"]) {
      const std::string quantity = item["quantity"];
      if (quantity.ends_with("_cell")) continue;  // which one is worst is a matter of rounding
      EXPECT_NEAR(allowed(other_cells, quantity), item["allowed"], 1e-3 * item["allowed"].get<double>())
          << quantity;
      EXPECT_NEAR(judgement(other_cells, quantity)["value"], item["value"], 1e-6) << quantity;
    }
  }
}

TEST(Check, FindsTheTwistOfACoatedSphere) {
  const Checked result = find_good(solved(scene_of("coated_sphere", 64)), scene_of("coated_sphere", 128));
  EXPECT_LE(std::abs(result["twist_error"].get<double>()), 1e-2);
}

// The pressure of an ellipse has an exact answer, its tractions have none: the certificate judges those.
TEST(Check, JudgesTheNormalContactOfAnEllipseExactly) {
  for (const char* name : {"ellipse", "turned_ellipse"}) {
    const solver::Scene scene = scene_of(name);
    const Checked good = check_rows(solved(scene), scene);
    EXPECT_LE(std::abs(good["contact_radius_error"].get<double>()), 1e-2) << name;
    EXPECT_LE(good["pressure_error"]["l1"].get<double>(), 3e-2) << name;
    for (const char* key : {"twist_error", "stick_radius_error"}) {
      EXPECT_TRUE(good[key].is_null()) << key;
      EXPECT_THAT(good[std::string(key) + "_reason"].get<std::string>(), HasSubstr("normal contact only"));
    }
    EXPECT_TRUE(good["traction_error"]["l1"].is_null()) << name;
    EXPECT_THAT(good.text, HasSubstr("normal contact only")) << name;
    solver::Scene softer = scene;
    softer.upper.young_modulus = softer.lower.young_modulus *= 0.5;  // the contact is by 2^(1/3) larger
    const Checked bad = find_bad(solved(softer), scene, IsOff("contact_radius_error", 0.26));
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
    const Checked result = check_rows(rows, scene);
    EXPECT_EQ(result["verdict"], both ? "good" : "bad") << why(result);
    ASSERT_EQ(result[both ? "conventions" : "mistakes"].size(), 1);
    EXPECT_THAT(result[both ? "conventions" : "mistakes"][0].get<std::string>(),
                HasSubstr(both ? "reversed" : "q2"));
  }
}

// The numbers of `solve` on its own field, from the field only. Loads that do not say the moment, too: a
// twist, a force, displacements, friction in pressing only; and loads from full stick (a flat punch up to
// 0.849 of its limit), where what slip there is has any direction, to nearly gross slip, and imposed motions
// beyond it.
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
  for (const char* name : {"paper", "ellipse", "off_centre", "turned_ellipse", "flat_punch", "cone",
                           "rounded_punch", "annulus", "patches", "dissimilar", "mindlin"})
    loads.push_back({name, {}});
  for (const char* name : {"flat_punch", "paper"}) {
    for (const char* ratio : {"0.01", "0.5", "0.99", "0.999"}) {
      loads.push_back({name, {std::string("load.moment_ratio=") + ratio}});
    }
  }
  for (const auto& [name, load] : loads) {
    SCOPED_TRACE(fmt::format("{} {}", name, fmt::join(load, " ")));
    const solver::Scene scene = scene_of(name, 32, load);
    const solver::Solution solution = solver::solve(scene);
    const Checked result = find_good(rows_of(solution), scene);
    const double moved = std::hypot(solution.displacement[0], solution.displacement[1]);
    for (const std::size_t component : {0U, 1U}) {
      EXPECT_NEAR(result["displacement"][component], solution.displacement[component], 1e-4 * moved + 1e-12);
    }
    EXPECT_NEAR(result["moment"], solution.moment, 1e-9 * solution.moment_limit);
    EXPECT_EQ(result["contact_cells"], solution.contact_cells);
    EXPECT_LE(std::abs(result["stick_cells"].get<double>() - static_cast<double>(solution.stick_cells)),
              2.0 + 1e-2 * static_cast<double>(solution.stick_cells));
    EXPECT_LE(result["certificate"]["gap"], 1e-6);
    EXPECT_LE(result["yardstick"]["distance"], 1e-3);
    EXPECT_TRUE(result["discrete"]["holds"].get<bool>()) << why(result);
    EXPECT_FALSE(result["yardstick"]["loads_scaled_down"].get<bool>());
    EXPECT_THAT(result["conventions"], IsEmpty());
  }
}

// The exact solution stands where the body stands, not where the field's grid does: it may be off the origin.
TEST(Check, HasTheErrorsOfSolve) {
  for (const auto& [name, cells] :
       {std::pair{"paper", 24}, {"paper", 33}, {"paper", 64}, {"off_centre", 48}}) {
    const solver::Scene scene = scene_of(name, cells);
    const solver::Solution solution = solver::solve(scene);
    const Errors errors = compare(solution, *find_oracle(scene).oracle);
    const bool centred = std::string(name) == "paper";
    const Checked result = find_good(rows_of(solution), scene, solution.twist_angle);
    EXPECT_NEAR(result["traction_error"]["l1"], errors.traction.at_centres.l1, centred ? 1e-9 : 1e-6);
    EXPECT_NEAR(result["pressure_error"]["l1"], errors.pressure.l1, centred ? 1e-9 : 1e-6);
    if (!centred) continue;
    EXPECT_NEAR(result["twist_error"], errors.twist, 1e-12);
    EXPECT_NEAR(result["moment_error"], errors.moment, 1e-12);
    EXPECT_NEAR(result["contact_radius_error"], errors.contact_radius, 1e-12);
    EXPECT_NEAR(result["stick_radius_error"], errors.stick_radius, 1e-6);
    EXPECT_NEAR(result["traction_error"]["averaged"]["l2"], errors.traction.averaged.l2, 1e-9);
    EXPECT_NEAR(result["pressure_error"]["max"], errors.pressure.max, 1e-9);
    EXPECT_NEAR(result["certificate"]["gap"], solution.certificate.gap, 1e-10);
  }
}

// It does not matter how many empty cells a file has, and on which side.
TEST(Check, MeasuresTheMeshWhateverEmptyCellsTheFileHas) {
  const solver::Scene scene = scene_of("paper", 24, {"load.twist=2e-3", "load.displacement=[0,0]"});
  const FieldRows rows = solved(scene);
  const double cell = rows[1][1] - rows[0][1];
  const Checked right = check_rows(rows, scene);
  for (const auto& [n1, n2] : {std::pair{7.0, 0.0}, {-7.0, 0.0}, {0.0, 7.0}, {0.0, -7.0}}) {
    FieldRows more = rows;
    for (FieldRow row : rows) more.push_back({row[0] + n1 * cell, row[1] + n2 * cell, 0.0, 0.0, 0.0});
    std::ranges::sort(more, std::greater<>());
    const auto same = [](const FieldRow& a, const FieldRow& b) {
      return std::hypot(a[0] - b[0], a[1] - b[1]) < 1e-9;
    };
    more.erase(std::unique(more.begin(), more.end(), same), more.end());
    const Checked result = find_good(more, scene);
    for (const char* key : {"mesh_error", "gap", "slip_direction"}) {
      EXPECT_NEAR(result["yardstick"][key].get<double>() / right["yardstick"][key].get<double>(), 1.0, 1e-3)
          << key << ' ' << n1 << ' ' << n2;
    }
  }
}

// The answers on this mesh and on the finer one solve one problem: they converge to each other.
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

// Two digits cause a gap, of all columns or of some. It is within the part of the allowed gap that is due to
// digits; 4 times the mesh's gap is more than the rest.
TEST(Check, AccountsForTheDigitsOfTheFile) {
  const solver::Scene fine = scene_of("paper", 64);
  const Checked result = find_good(with_digits(solved(fine), {2, 3, 4}, 2), fine);
  const Json gap = judgement(result, "gap");
  const double of_digits = gap["allowed"].get<double>() - 4.0 * result["yardstick"]["gap"].get<double>();
  EXPECT_LE(std::abs(gap["value"].get<double>()), of_digits);
  const solver::Scene scene = scene_of("paper", 32);
  const FieldRows rows = solved(scene);
  for (const std::vector<std::size_t>& columns : std::vector<std::vector<std::size_t>>{{2}, {3, 4}}) {
    const Json own_grid = find_good(with_digits(rows, columns, 2), scene)["discrete"];
    EXPECT_LE(std::abs(own_grid["gap"].get<double>()), own_grid["allowed"].get<double>());
  }
  find_good(with_digits(rows, {2}, 1), scene);  // a tenth of the pressure, up to a half
}

// The samples are at cell centres. Grids are fine enough for a pressure that changes within a cell or two, or
// too coarse for the slip ring, or pressure and gap are nearly as for constant cells: near no slip and
// near the limit, on fine grids.
TEST(Check, FindsExactFieldsGood) {
  for (const auto& [name, cells] :
       {std::pair{"paper", 32}, {"paper", 64}, {"cone", 32}, {"mindlin", 32}, {"rounded_punch", 64}}) {
    const solver::Scene scene = scene_of(name, cells);
    EXPECT_LE(find_good(sampled(scene), scene)["traction_error"]["l2"], 1e-12) << name;
  }
  const std::vector<std::tuple<const char*, int, double>> loaded{
      {"paper", 112, 0.99}, {"paper", 128, 0.05}, {"paper", 136, 0.05}, {"paper", 136, 0.2},
      {"paper", 32, 0.1},   {"paper", 64, 0.99},  {"cone", 32, 0.6},    {"cone", 64, 0.9}};
  for (const auto& [name, cells, ratio] : loaded) {
    const solver::Scene scene = scene_of(name, cells, {fmt::format("load.moment_ratio={}", ratio)});
    find_good(sampled(scene), scene, find_oracle(scene).oracle->twist_angle);
  }
}

// Samples of the exact answer do not solve the grid's problem of constant cells: they are right within the
// mesh all the same.
TEST(Check, AsksTwoQuestions) {
  const solver::Scene scene = scene_of("paper", 48);
  for (const bool exact : {false, true}) {
    const auto file = write_rows(exact ? sampled(scene) : solved(scene));
    const Checked result = checked(scene, file);
    EXPECT_EQ(result["verdict"], "good") << why(result);
    EXPECT_EQ(result["discrete"]["holds"], !exact);
    EXPECT_EQ(checked(scene, file, {.discrete = true})["verdict"], exact ? "bad" : "good");
  }
}

// Noise of 0.03 to 0.2 % in pressure and tractions.
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
      const Checked result = find_good(noisy, scene);
      EXPECT_FALSE(result["discrete"]["holds"].get<bool>());
    }
  }
}

TEST(Check, JudgesTheMomentThatAnImposedTwistCauses) {
  find_bad(solved(scene_of("paper", 48, {"load.twist=1.02e-3"})), scene_of("paper", 48, {"load.twist=1e-3"}),
           BreaksFirst("moment_error"));
}

// A tolerance may be wider or narrower than the errors that the mesh allows.
TEST(Check, TakesTheTolerance) {
  const solver::Scene scene = scene_of("paper", 64);
  const FieldRows rows = with_stresses_times(solved(scene), 0.995);
  EXPECT_EQ(checked(scene, write_rows(rows), {})["verdict"], "bad");
  EXPECT_EQ(checked(scene, write_rows(rows), {.tolerance = 0.02})["verdict"], "good");
  const auto exact = write_rows(sampled(scene));
  EXPECT_EQ(checked(scene, exact, {})["verdict"], "good");
  EXPECT_EQ(checked(scene, exact, {.tolerance = 1e-5})["verdict"], "bad");
}

// A force has turned the twist against the moment.
TEST(Check, TakesATwistAgainstTheMoment) {
  const solver::Scene scene =
      solver::read_scene(kScenes + "/unequal_patches.toml",
                         {"grid.cells=[64,40]", "load.force=[30,10]", "load.moment_ratio=-0.05"});
  const solver::Solution solution = solver::solve(scene);
  ASSERT_GT(solution.twist_angle, 0.0);
  const Checked result = find_good(rows_of(solution), scene, solution.twist_angle);
  EXPECT_THAT(result["conventions"], IsEmpty());
  const solver::Scene force = scene_of("paper", 32, {"load.moment_ratio=0", "load.force=[30,10]"});
  for (const double rounding : {1e-19, -1e-19, 0.0}) {
    EXPECT_THAT(find_good(solved(force), force, rounding)["conventions"], IsEmpty());
  }
}

// The shape of the contact is the pressure's.
TEST(Check, FindsTheFieldOfAnotherContactBad) {
  const auto ellipsoid = [](const std::string& scene, double r1, double r2, double angle) {
    return scene_of(scene, 48,
                    {"grid.cells=[48,48]", "grid.extent=[1.6e-3,1.6e-3]", "upper.shape=ellipsoid",
                     fmt::format("upper.radius_1={}", r1), fmt::format("upper.radius_2={}", r2),
                     fmt::format("upper.angle={}", angle)});
  };
  const solver::Scene sphere = scene_of("paper", 48);
  const solver::Scene ellipse = ellipsoid("ellipse", 0.018, 0.0105, 0.0);
  const solver::Scene two = scene_of("patches", 48, {"grid.extent=[2.2e-3,1.1e-3]", "grid.cells=[48,24]"});
  const std::vector<std::pair<FieldRows, solver::Scene>> others{
      {solved(ellipsoid("ellipse", 0.04, 0.0105, 0.0)), sphere},
      {solved(ellipsoid("ellipse", 0.018, 0.0105, std::numbers::pi / 6.0)), ellipse},
      {solved(ellipsoid("ellipse", 0.01375, 0.01375, 0.0)), ellipse},
      {solved(sphere), two}};
  for (const auto& [rows, scene] : others) {
    const auto file = write_rows(rows);
    for (const std::optional<double> tolerance : {std::optional<double>(), {1e-3}}) {
      const Checked result = checked(scene, file, {.strict = true, .tolerance = tolerance});
      EXPECT_EQ(result["verdict"], "bad");
      EXPECT_THAT(result, Breaks("pressure"));
    }
  }
  const Checked given = checked(sphere, write_rows(others.front().first), {.pressure_given = true});
  EXPECT_EQ(given["verdict"], "good") << why(given);
  EXPECT_TRUE(given["pressure_given"]);
}

TEST(Check, SaysThatAnInfinitePressureCannotBeSampled) {
  const solver::Scene scene = scene_of("flat_punch");
  find_bad(sampled(scene), scene, AllOf(Breaks("normal_load_error"), names(mistake::sampled_singularity)));
}

// On a circle frozen directions fade with the mesh, on an ellipse they do not.
TEST(Check, FindsThePapersMethodGoodOnACircleAndBadOnAnEllipse) {
  for (const auto& [name, verdict] : {std::pair{"paper", "good"}, std::pair{"ellipse", "bad"}}) {
    const solver::Scene scene = scene_of(name, 48, {"solver.method=paper"});
    const Checked result = check_rows(solved(scene), scene);
    EXPECT_EQ(result["verdict"], verdict) << why(result);
    if (result["verdict"] == "good") continue;
    EXPECT_THAT(result, AllOf(Breaks("slip_direction"), names(mistake::kept_directions)));
    EXPECT_TRUE(result["diagnosis"]["kernel"].is_null());
  }
}

// With the bodies exchanged the pressure moves the surfaces the other way.
TEST(Check, FindsMistakesInThePressuresTangentialDisplacement) {
  const solver::Scene scene = scene_of("dissimilar");
  find_bad(solved(scene_of("dissimilar", 32, {"contact.coupling=none"})), scene,
           names(mistake::coupling_missing));
  solver::Scene exchanged = scene;
  std::swap(exchanged.upper, exchanged.lower);
  find_bad(solved(exchanged), scene, names(mistake::coupling_sign));
}

// Bodies whose shear compliances 1/G and nu/G differ by half as much, with the same sums, move the surfaces
// half as far by pressure, and as far by all else. Under the double displacement hardly any cell sticks.
TEST(Check, DeterminesThePartOfThePressuresTangentialDisplacement) {
  const solver::Scene whole = scene_of("dissimilar");
  solver::Scene half = whole;
  const auto shear = [](const solver::Material& m) {
    return 2.0 * (1.0 + m.poisson_ratio) / m.young_modulus;
  };
  const std::array compliance{shear(whole.lower), shear(whole.upper)};
  const std::array poisson{compliance[0] * whole.lower.poisson_ratio,
                           compliance[1] * whole.upper.poisson_ratio};
  const auto nearer = [](const std::array<double, 2>& of, std::size_t k) {
    return 0.75 * of[k] + 0.25 * of[1 - k];
  };
  for (const std::size_t k : {0U, 1U}) {
    solver::Material& body = k == 0 ? half.lower : half.upper;
    body.poisson_ratio = nearer(poisson, k) / nearer(compliance, k);
    body.young_modulus = 2.0 * (1.0 + body.poisson_ratio) / nearer(compliance, k);
  }
  find_bad(solved(half), whole, names(mistake::coupling_factor, 0.5));
  find_bad(solved(whole), half, names(mistake::coupling_factor, 2.0));
}

}  // namespace
}  // namespace slipstick::convergence
