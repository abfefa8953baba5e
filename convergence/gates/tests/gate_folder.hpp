#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "convergence/programs/run_program.hpp"

namespace slipstick::convergence {

/// A folder of its own for each test.
class GateFolder : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("slipstick-" + std::string(test->test_suite_name()) + test->name() + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }

  std::filesystem::path folder_;
};

inline constexpr const char* kResultGate = R"([[gate]]
id = "counted"
result = "work.json"
quantity = "counts.some-case.applications"
above = 17
below = 21
basis = "counted 19"
)";

/// What Python's parser finds in JUnit XML: a line for every element.
inline std::string parse_xml(const std::filesystem::path& file) {
  const std::filesystem::path script = file.string() + ".py";
  std::ofstream(script) << "import sys, xml.etree.ElementTree as tree\n"
                           "for e in tree.parse(sys.argv[1]).iter():\n"
                           "    print(e.tag, dict(e.attrib), repr(e.text))\n";
  const ProgramEnd end = run_program({SLIPSTICK_PYTHON, script, file}, {.captured = Captured::output});
  return end.code == 0 ? end.output : "not XML";
}

}  // namespace slipstick::convergence
