#include "convergence/runs/result_cache.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace slipstick::convergence {
namespace {

using Json = nlohmann::ordered_json;

class JournalTest : public testing::Test {
 protected:
  JournalTest() { std::filesystem::remove_all(folder_); }
  ~JournalTest() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "slipstick-journal-test";
  int computed_ = 0;
  Json compute() {
    ++computed_;
    return {{"value", 0.1}};
  }
  Json ask(const std::string& question, const std::filesystem::path& also = {}) {
    return Journal(folder_).point(
        "point", question, [this] { return compute(); }, also);
  }
};

TEST_F(JournalTest, ComputesOnce) {
  EXPECT_EQ(ask("a")["value"], 0.1);
  EXPECT_EQ(ask("a")["value"], 0.1);
  EXPECT_EQ(computed_, 1);
}

TEST_F(JournalTest, AnotherQuestionIsComputed) {
  ask("a");
  ask("b");
  EXPECT_EQ(computed_, 2);
}

TEST_F(JournalTest, ADamagedPointIsComputedAgain) {
  ask("a");
  std::ofstream(folder_ / "point.json") << "{ \"question\": ";
  ask("a");
  EXPECT_EQ(computed_, 2);
}

TEST_F(JournalTest, APointWithoutItsOtherFileIsComputedAgain) {
  const auto also = folder_ / "fields.h5";
  ask("a", also);
  ask("a", also);
  EXPECT_EQ(computed_, 2);
  std::ofstream(also) << "there";
  ask("a", also);
  EXPECT_EQ(computed_, 2);
}

/// A kill while the other file is written anew must not leave its half beside a result that says finished.
TEST_F(JournalTest, WhatIsComputedAgainIsNotFinishedMeanwhile) {
  const auto also = folder_ / "fields.h5";
  ask("a", also);
  bool finished = true;
  Journal(folder_).point(
      "point", "a",
      [&] {
        finished = Journal(folder_).find("point", "a").has_value();
        return compute();
      },
      also);
  EXPECT_FALSE(finished);
}

}  // namespace
}  // namespace slipstick::convergence
