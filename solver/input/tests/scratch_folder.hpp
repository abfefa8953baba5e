#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

/// Files of tests.
namespace slipstick {

inline std::string file_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A table as CSV, a line for each i: value(i, j).
template <typename Index, typename Value>
std::string table_of(Index rows, Index columns, const Value& value) {
  std::ostringstream text;
  text.precision(17);
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < columns; ++j) text << (j > 0 ? "," : "") << value(i, j);
    text << '\n';
  }
  return text.str();
}

/// A folder of its own for each test, which is removed after it.
class ScratchFolder : public testing::Test {
 protected:
  ScratchFolder() { std::filesystem::create_directories(folder_); }
  ~ScratchFolder() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  const std::filesystem::path folder_ = [] {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    return std::filesystem::path(testing::TempDir()) /
           ("slipstick-" + std::string(test->test_suite_name()) + test->name() + std::to_string(getpid()));
  }();
};

}  // namespace slipstick
