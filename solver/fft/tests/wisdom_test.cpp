// Plans that FFTW measured and that a file keeps: the same solution, no measuring the second time, no trace
// left.

#include "solver/fft/wisdom.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "solver/fft/half_sample_transform.hpp"
#include "solver/fft/padded_transform.hpp"
#include "solver/fft/plane_transform.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/tests/complaint.hpp"
#include "solver/solve.hpp"
#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr unsigned kFromWisdom = FFTW_MEASURE | FFTW_WISDOM_ONLY;

class WisdomFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) /
              ("slipstick-wisdom-" + std::string(test->name()) + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path file() const { return folder_ / "plans"; }
  std::string text() const {
    std::ostringstream text;
    text << std::ifstream(file()).rdbuf();
    return text.str();
  }
  Scene scene(ModelChoice model, Precision precision = Precision::double_precision) const {
    Scene scene = paper_scene(32, 0.9);
    scene.model = model;
    scene.precision = precision;
    return scene;
  }
  Scene planned(Scene scene) const {
    scene.wisdom = file();
    return scene;
  }

  fs::path folder_;
};

/// Builds and directions of rounding differ by 2e-12 in the paper's twist; a wrong transform by percents.
constexpr double kRounding = 1e-10;

TEST_F(WisdomFile, LeavesTheSolutionAsItIs) {
  for (const ModelChoice model : {ModelChoice::automatic, ModelChoice::full}) {
    for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
      const Solution estimated = solve(scene(model, precision));
      const Solution measured = solve(planned(scene(model, precision)));
      EXPECT_EQ(measured.status, Status::converged) << measured.message;
      EXPECT_NEAR(measured.twist_angle / estimated.twist_angle, 1.0, kRounding);
    }
  }
}

TEST_F(WisdomFile, LeavesNoTraceInSolvesWithoutIt) {
  const Solution before = solve(scene(ModelChoice::automatic));
  solve(planned(scene(ModelChoice::automatic)));
  const Solution after = solve(scene(ModelChoice::automatic));
  EXPECT_TRUE((before.traction == after.traction).all());
  EXPECT_TRUE((before.pressure == after.pressure).all());
}

TEST_F(WisdomFile, HoldsAllThatASecondSolvePlans) {
  solve(planned(scene(ModelChoice::automatic, Precision::mixed)));
  const std::string first = text();
  EXPECT_THAT(first, AllOf(HasSubstr("fftw_wisdom"), HasSubstr("fftwf_wisdom")));
  solve(planned(scene(ModelChoice::automatic, Precision::mixed)));
  EXPECT_EQ(text(), first);
  solve(planned(scene(ModelChoice::full)));
  EXPECT_GT(text().size(), first.size()) << "what is new is added";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "nothing else is left there";
}

template <typename Real>
void plan_operators(const Grid& grid, const Wisdom& wisdom, bool measure) {
  const Elasticity elastic{.pair = elastic_pair({1.0, 0.3}, {1.0, 0.3}), .measure_plans = measure};
  GridOperators<Real>(elastic, grid, tangential_kernel());
  EXPECT_TRUE(wisdom.save());
}

/// Plans on the whole grid and on its quadrant: of an operator and of its preconditioner.
template <typename Real>
void plan_from_wisdom(Index cells) {
  const Grid whole{cells, cells, 1.0, 1.0};
  PaddedTransform<Real>(whole, 2, 1, kFromWisdom);
  PlaneTransform<Real>({fast_length(cells), fast_length(cells), 2, cells}, 1, kFromWisdom);
  HalfSampleTransform<Real>(cells, kFromWisdom);
  const Index mirrored = fast_length(2 * cells) / 2;
  PlaneTransform<Real>({mirrored, mirrored, 2, cells / 2}, 1, kFromWisdom);
}

template <typename Real>
void expect_plans_in_file(const fs::path& file) {
  constexpr Index cells = 22;
  for (const bool measure : {false, true}) {
    fs::remove(file);
    {
      const Wisdom wisdom(file);
      for (const bool quadrant : {false, true}) {
        plan_operators<Real>({cells, cells, 1.0, 1.0, quadrant}, wisdom, measure);
      }
    }
    EXPECT_THROW(plan_from_wisdom<Real>(cells), std::runtime_error) << "not yet read";
    const Wisdom wisdom(file);
    if (measure) {
      EXPECT_NO_THROW(plan_from_wisdom<Real>(cells));
    } else {
      EXPECT_THROW(PaddedTransform<Real>({cells, cells, 1.0, 1.0}, 2, 1, kFromWisdom), std::runtime_error);
      EXPECT_THROW(PlaneTransform<Real>({fast_length(cells), fast_length(cells), 2, cells}, 1, kFromWisdom),
                   std::runtime_error);
      EXPECT_THROW(HalfSampleTransform<Real>(cells, kFromWisdom), std::runtime_error);
    }
  }
}

TEST_F(WisdomFile, KnowsThePlansOfEveryOperatorAndPreconditioner) {
  expect_plans_in_file<double>(file());
  expect_plans_in_file<float>(file());
}

// FFTW ends its process over flags that do not fit into their bits.
TEST_F(WisdomFile, IsRefusedWhereFftwDiesOfIt) {
  solve(planned(scene(ModelChoice::automatic)));
  std::string bad = text();
  const auto upper_flags = bad.find(" #x", bad.find(" #x") + 1);
  bad.replace(upper_flags, bad.find(' ', upper_flags + 1) - upper_flags, " #xffffffff");
  std::ofstream(file()) << bad;
  EXPECT_THAT(complaint([&] { solve(planned(scene(ModelChoice::automatic))); }),
              AllOf(HasSubstr(file().string()), HasSubstr("holds no plans")));
}

TEST_F(WisdomFile, IsRefusedAndKeptWhereItIsNone) {
  solve(planned(scene(ModelChoice::automatic)));
  const std::string good = text();
  const std::string half = good.substr(0, good.find("fftwf_wisdom"));
  for (const std::string& bad : {std::string("no plans"), std::string(), half}) {
    std::ofstream(file()) << bad;
    EXPECT_THAT(complaint([&] { solve(planned(scene(ModelChoice::automatic))); }),
                AllOf(HasSubstr(file().string()), HasSubstr("solver.wisdom")))
        << bad.substr(0, 20);
    EXPECT_EQ(text(), bad);
  }
  Scene lost = scene(ModelChoice::automatic);
  lost.wisdom = folder_ / "nowhere" / "plans";
  EXPECT_THROW(solve(lost), InputError);
  lost.wisdom = folder_;
  EXPECT_THROW(solve(lost), InputError);
}

TEST_F(WisdomFile, CostsNoSolveWhereItCannotBeWritten) {
  const auto take_its_place = [&](const Solution&) { fs::create_directory(file()); };
  const Solution solution =
      solve(planned(scene(ModelChoice::automatic)), {.progress = {}, .on_step = take_its_place});
  EXPECT_EQ(solution.status, Status::converged);
  EXPECT_THAT(solution.message, AllOf(HasSubstr(file().string()), HasSubstr("could not be written")));
}

TEST_F(WisdomFile, IsNamedRelativeToTheScene) {
  const fs::path scene_file = folder_ / "scene.toml";
  std::ofstream(scene_file) << kShortScene;
  EXPECT_EQ(read_scene(scene_file).wisdom, "");
  EXPECT_EQ(read_scene(scene_file, {"solver.wisdom=plans"}).wisdom, file());
  EXPECT_EQ(read_scene(scene_file, {"solver.wisdom=/elsewhere/plans"}).wisdom, "/elsewhere/plans");
}

}  // namespace
}  // namespace slipstick::solver
