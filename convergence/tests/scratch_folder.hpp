#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "solver/scene/scene.hpp"

/// What tests of convergence/ share.
namespace slipstick::convergence {

/// A scene of convergence/scenes/.
inline solver::Scene example(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return solver::read_scene(std::string(SLIPSTICK_SCENES) + "/" + name + ".toml", overrides);
}

/// A folder of its own for each test, which is removed after it.
class ScratchFolder : public testing::Test {
 protected:
  ScratchFolder() { std::filesystem::create_directories(folder_); }
  ~ScratchFolder() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  const std::filesystem::path folder_ = [] {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::path(testing::TempDir()) /
           ("slipstick-" + std::string(test->test_suite_name()) + test->name() + std::to_string(getpid()));
  }();
};

}  // namespace slipstick::convergence
