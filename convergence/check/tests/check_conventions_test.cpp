// The same field in another program's conventions.

#include "convergence/check/foreign_field.hpp"

#include <utility>

#include "convergence/check/tests/checked_field.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using namespace testing;

class CheckConventions : public testing::Test {
 protected:
  solver::Scene scene_ = scene_of("ellipse", 32);
  FieldRows rows_ = rows_of(solver::solve(scene_));
  Checked base_ = check_rows(rows_, scene_);

  /// The same verdict and numbers as the field in this project's own conventions.
  void expect_same(const FieldRows& rows, const std::vector<std::string>& notes) const {
    const Checked result = find_good(rows, scene_);
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
  expect_same(changed(rows_, [](FieldRow& r) { r[3] = -r[3], r[4] = -r[4]; }), {"reversed"});
  expect_same(changed(rows_, [](FieldRow& r) { swap(r[3], r[4]); }), {"q1 and q2"});
}

// No frame and no body explains one reversed component.
TEST_F(CheckConventions, NoComponentIsReversedAlone) {
  for (const std::size_t component : {3, 4}) {
    const Checked result =
        find_bad(changed(rows_, [=](FieldRow& r) { r[component] = -r[component]; }), scene_, testing::_);
    EXPECT_TRUE(result["within_mesh"].get<bool>()) << why(result);  // all the rest is right
    EXPECT_THAT(result["conventions"], IsEmpty());
  }
}

TEST_F(CheckConventions, StandInTheFirstLineAndStrictTakesNone) {
  const auto file =
      write_rows(changed(rows_, [](FieldRow& r) { r[3] = -r[3], r[4] = -r[4], r[0] *= 1e3, r[1] *= 1e3; }));
  const Checked taken = checked(scene_, file);
  EXPECT_EQ(taken["verdict"], "good");
  const std::string& text = taken.text;
  EXPECT_THAT(text.substr(0, text.find('\n')),
              AllOf(HasSubstr("good"), HasSubstr("mm"), HasSubstr("reversed")));
  const Checked strict = checked(scene_, file, {.strict = true});
  EXPECT_EQ(strict["verdict"], "bad");
  EXPECT_THAT(why(strict), AllOf(HasSubstr("mm"), HasSubstr("reversed")));
  EXPECT_EQ(checked(scene_, write_rows(rows_), {.strict = true})["verdict"], "good");
}

/// The notes of a field that is good but for its conventions.
std::vector<std::string> notes_of(const FieldRows& rows, const solver::Scene& scene) {
  return find_good(rows, scene)["conventions"];
}

// Under a force a mirrored frame differs from the other body: it reverses only the moment. A body off the
// axis then stands on the other side of it, and is moved first.
TEST(Check, ReadsALeftHandedFrame) {
  for (const auto& [name, moved] : {std::pair{"paper", 0U}, {"off_centre", 1U}}) {
    const solver::Scene scene = scene_of(name, 32, {"load.moment_ratio=0.5", "load.force=[30,20]"});
    const auto notes =
        notes_of(changed(solved(scene), [](FieldRow& r) { r[1] = -r[1], r[4] = -r[4]; }), scene);
    ASSERT_EQ(notes.size(), 1U + moved) << name;
    EXPECT_THAT(notes.back(), HasSubstr("left-handed"));
  }
}

// There may be only a force, along either axis.
TEST(Check, ReadsTheOtherBodysTractionsUnderAForceAlone) {
  for (const char* force : {"load.force=[60,0]", "load.force=[0,60]"}) {
    const solver::Scene scene = scene_of("paper", 32, {"load.moment_ratio=0", force});
    const FieldRows rows = solved(scene);
    EXPECT_THAT(notes_of(rows, scene), IsEmpty()) << force;
    EXPECT_THAT(notes_of(with_tractions_times(rows, -1.0), scene), ElementsAre(HasSubstr("reversed")));
  }
}

// The middle of the contact goes with the axes.
TEST(Check, ReadsExchangedAxesOfAnEllipseOffTheOrigin) {
  using std::swap;
  const solver::Scene scene = scene_of("ellipse", 32, {"upper.at=[0,2e-4]"});
  const FieldRows rows = solved(scene);
  EXPECT_THAT(notes_of(rows, scene), IsEmpty());
  EXPECT_THAT(notes_of(changed(rows, [](FieldRow& r) { swap(r[0], r[1]), swap(r[3], r[4]); }), scene),
              ElementsAre(HasSubstr("axes")));
}

TEST_F(CheckConventions, Axes) {
  using std::swap;
  expect_same(changed(rows_, [](FieldRow& r) { swap(r[0], r[1]), swap(r[3], r[4]); }), {"axes"});
  // Turned by 90 degrees: read with axes exchanged, which is a mirror, the moment turns the other way.
  expect_same(changed(rows_,
                      [](FieldRow& r) {
                        r = {-r[1], r[0], r[2], -r[4], r[3]};
                      }),
              {"axes", "reversed"});
}

TEST_F(CheckConventions, Units) {
  const auto in = [&](double metre, double pascal) {
    return changed(rows_, [=](FieldRow& r) {
      r = {r[0] * metre, r[1] * metre, r[2] * pascal, r[3] * pascal, r[4] * pascal};
    });
  };
  expect_same(in(1e3, 1.0), {"mm"});
  expect_same(in(1.0, 1e-6), {"MPa"});
  expect_same(in(1e3, 1e-6), {"mm", "MPa"});
  expect_same(in(1e6, 1e-9), {"micrometres", "GPa"});
  EXPECT_THROW(check_rows(in(1e3, 3e-7), scene_), solver::InputError);
}

TEST_F(CheckConventions, OriginAndPartsOfACell) {
  const double cell = base_["cell_size"][0];
  const auto moved = [&](double by) {
    return changed(rows_, [=](FieldRow& r) { r[0] += by, r[1] -= 0.5 * by; });
  };
  expect_same(moved(0.3 * cell), {});
  const auto note = fmt::format("({:.4g}, {:.4g}) m", 40.0 * cell, -20.0 * cell);
  expect_same(moved(40.0 * cell), {note});
  expect_same(changed(moved(40.0 * cell), [](FieldRow& r) { r[0] *= 1e3, r[1] *= 1e3; }), {"mm", note});
}

TEST_F(CheckConventions, FewDigits) {
  for (const int digits : {10, 6}) {
    const Checked result = checked(scene_, write_rows(rows_, digits));
    EXPECT_EQ(result["verdict"], "good") << digits << why(result);
    EXPECT_NEAR(result["stick_cells"], base_["stick_cells"].get<double>(), 2.0);
    EXPECT_LE(result["certificate"]["friction_bound"], 2e-5);
  }
}

// Rounding is in the unit of the file.
TEST_F(CheckConventions, FewDigitsInAnotherUnit) {
  const auto file = [](const FieldRows& rows) { return write_rows(rows, 3); };
  const Checked in_pa = checked(scene_, file(rows_));
  const Checked in_mpa = checked(scene_, file(with_stresses_times(rows_, 1e-6)));
  EXPECT_EQ(in_pa["verdict"], "good") << why(in_pa);
  EXPECT_EQ(in_mpa["verdict"], "good") << why(in_mpa);
  for (const char* key : {"gap", "allowed"}) {
    EXPECT_NEAR(in_mpa["discrete"][key].get<double>() / in_pa["discrete"][key].get<double>(), 1.0, 1e-6)
        << key;
  }
  EXPECT_EQ(in_mpa["discrete"]["holds"], in_pa["discrete"]["holds"]);
}

}  // namespace
}  // namespace slipstick::convergence
