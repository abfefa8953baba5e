#include "convergence/runs/result_cache.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

namespace slipstick::convergence {
namespace {

using Json = nlohmann::ordered_json;

class ResultCacheTest : public testing::Test {
 protected:
  ResultCacheTest() { std::filesystem::remove_all(folder_); }
  ~ResultCacheTest() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("slipstick-result-cache-" + std::to_string(::getpid()));
  int computed_ = 0;
  Json compute() {
    ++computed_;
    return {{"value", 0.1}};
  }
  Json ask(const std::string& cache_key) {
    return ResultCache(folder_).find_or_compute("point", cache_key, [this] { return compute(); });
  }
};

TEST_F(ResultCacheTest, ComputesOnce) {
  EXPECT_EQ(ask("a")["value"], 0.1);
  EXPECT_EQ(ask("a")["value"], 0.1);
  EXPECT_EQ(computed_, 1);
}

TEST_F(ResultCacheTest, AnotherKeyIsComputed) {
  ask("a");
  ask("b");
  EXPECT_EQ(computed_, 2);
}

TEST_F(ResultCacheTest, ADamagedPointIsComputedAgain) {
  ask("a");
  std::ofstream(folder_ / "point.json") << "{ \"cache_key\": ";
  ask("a");
  EXPECT_EQ(computed_, 2);
}

/// So that a kill while it is computed anew leaves nothing that says finished.
TEST_F(ResultCacheTest, WhatIsForgottenIsNotFinished) {
  ask("a");
  ResultCache(folder_).forget("point");
  EXPECT_FALSE(ResultCache(folder_).find("point", "a").has_value());
}

TEST_F(ResultCacheTest, AnotherProgramComputesAgain) {
  ask("a");
  EXPECT_TRUE(ResultCache(folder_).find("point", "a").has_value());
  EXPECT_FALSE(ResultCache(folder_, SLIPSTICK_PROGRAM).find("point", "a").has_value());
}

}  // namespace
}  // namespace slipstick::convergence
