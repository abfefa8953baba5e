// Each test program has its own temporary folder, which is removed when it ends.

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <string>

namespace {

class TemporaryFolder : public testing::Environment {
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / "slipstick-tests-XXXXXX";
    ASSERT_NE(mkdtemp(folder_.data()), nullptr);
    for (const char* name : {"TMPDIR", "TEST_TMPDIR"}) setenv(name, folder_.c_str(), 1);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string folder_;
};

[[maybe_unused]] const auto* const kAdded = testing::AddGlobalTestEnvironment(new TemporaryFolder);

}  // namespace
