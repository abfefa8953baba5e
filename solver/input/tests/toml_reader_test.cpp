// Arrays of tables, whose keys have an index: step[1].twist.

#include "solver/input/toml_reader.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>

#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

using namespace testing;

const Range kFinite{"finite", [](double x) { return std::isfinite(x); }};

constexpr const char* kSteps = R"(names = [1, 2]
[[step]]
force = 1
[[step]]
force = 2
twist = 3
[[step]]
[[step.part]]
length = 4
)";

class Tables : public SceneFile {
 protected:
  SceneReader reader(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return {write("steps.toml", text), overrides};
  }
};

TEST_F(Tables, AreCountedAndReadByIndex) {
  SceneReader steps = reader(kSteps);
  EXPECT_EQ(steps.count("step"), 3);
  EXPECT_EQ(steps.count("stage"), 0);
  EXPECT_EQ(steps.count("step[2].part"), 1);
  EXPECT_EQ(steps.number("step[0].force", kFinite), 1.0);
  EXPECT_EQ(steps.number("step[1].force", kFinite), 2.0);
  EXPECT_EQ(steps.find_number("step[0].twist", kFinite), std::nullopt);
  EXPECT_EQ(steps.number("step[2].part[0].length", kFinite), 4.0);
  EXPECT_EQ(steps.pair("names", kFinite)[1], 2.0);  // an array, but of numbers
  EXPECT_THAT(complaint([&] { steps.reject_unknown(); }),
              says("steps.toml:6", "step[1].twist = 3: unknown key"));
  steps.find_number("step[1].twist", kFinite);
  steps.reject_unknown();
}

TEST_F(Tables, HoldListsOfAnyLength) {
  SceneReader lists = reader("sizes = [1, 2.5, 4]\nnames = [\"a\", \"b\"]\n");
  EXPECT_THAT(lists.numbers("sizes", kFinite), testing::ElementsAre(1.0, 2.5, 4.0));
  EXPECT_THAT(lists.list("names"), testing::SizeIs(2));
  EXPECT_THAT(lists.list("others"), testing::IsEmpty());
}

TEST_F(Tables, AreReadAsOverridesOfAnotherFile) {
  SceneReader steps = reader(
      "[[step]]\n[[step]]\nword = 1\n  set = { \"load.force\" = [1e-8, 2.0], load.name = \"a b\", on = true "
      "}\n");
  EXPECT_THAT(steps.assignments("step[1].set"),
              testing::UnorderedElementsAre("load.force=[1e-08, 2]", "load.name='a b'", "on=true"));
  EXPECT_THAT(steps.assignments("step[0].set"), testing::IsEmpty());
  EXPECT_EQ(steps.line("step[1]"), 2);
  EXPECT_EQ(steps.line("step[1].set"), 4);
  EXPECT_EQ(steps.line("step[2]"), 0);
  EXPECT_FALSE(steps.is_text("step[1].word"));
  steps.reject_unknown();  // what an assignment holds is known
  EXPECT_THAT(complaint([&] { steps.assignments("step[1].word"); }),
              says("step[1].word = 1", "allowed: a table"));
  const SceneReader other(write("other.toml", ""), {"load.force=[1e-08, 2]", "load.name='a b'", "on=true"});
}

TEST_F(Tables, AreOverriddenByIndex) {
  SceneReader steps = reader(kSteps, {"step[0].force=7", "step[0].twist=8", "step[2].part[0].length=9"});
  EXPECT_EQ(steps.count("step"), 3);
  EXPECT_EQ(steps.number("step[0].force", kFinite), 7.0);
  EXPECT_EQ(steps.number("step[0].twist", kFinite), 8.0);
  EXPECT_EQ(steps.number("step[1].force", kFinite), 2.0);
  EXPECT_EQ(steps.number("step[2].part[0].length", kFinite), 9.0);
  EXPECT_THAT(complaint([&] { steps.fail("step[0].force", "7", "less"); }), HasSubstr("--set"));
  const SceneReader whole = reader(kSteps, {"load={force=7}"});
  EXPECT_THAT(complaint([&] { whole.fail("load.force", "7", "less"); }), HasSubstr("--set"));
}

/// A number with no digit on one side of its point is refused by name; a text may have such a point.
TEST_F(Tables, SayHowNumbersAreWritten) {
  for (const char* number : {".5", "-.5", "5.", "5.e-1"}) {
    SceneReader steps = reader(kSteps, {fmt::format("step[0].force={}", number)});
    EXPECT_THAT(complaint([&] { steps.find_number("step[0].force", kFinite); }), HasSubstr("both sides"));
    SceneReader names = reader(kSteps, {fmt::format("names=[1, {}]", number)});
    EXPECT_THAT(complaint([&] { names.find_pair("names", kFinite); }), HasSubstr("both sides"));
  }
  SceneReader steps = reader(kSteps, {"step[0].force=five.", "step[1].force=0.5", "name=.5"});
  EXPECT_THAT(complaint([&] { steps.find_number("step[0].force", kFinite); }), Not(HasSubstr("both sides")));
  EXPECT_EQ(steps.number("step[1].force", kFinite), 0.5);
  EXPECT_EQ(steps.text("name"), ".5");
}

TEST_F(Tables, AreNotMadeByOverrides) {
  for (const char* path : {"step[3].force", "step[].force", "step[-1].force", "step[x].force",
                           "names[0].force", "stage[0].force", "step[2].part[1].length"}) {
    EXPECT_THAT(complaint([&] { reader(kSteps, {std::string(path) + "=1"}); }),
                says(std::string("--set ") + path, "is not a table of the scene file"))
        << path;
  }
}

TEST_F(Tables, DropWhatAnOverrideReplaces) {
  SceneReader steps = reader(kSteps, {"step[1].force=7"});
  steps.prefer_overridden({"step[1].twist", "step[1].force"});
  EXPECT_FALSE(steps.has("step[1].twist"));
  EXPECT_EQ(steps.number("step[1].force", kFinite), 7.0);
  EXPECT_EQ(steps.number("step[0].force", kFinite), 1.0);
}

}  // namespace
}  // namespace slipstick::solver
