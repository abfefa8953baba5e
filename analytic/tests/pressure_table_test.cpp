#include "analytic/tabulated_pressure.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

using namespace ::testing;

class TableFile : public ::testing::Test {
 protected:
  TableFile()
      : name_(::testing::TempDir() + "slipstick_table_" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv") {}
  ~TableFile() override { std::remove(name_.c_str()); }

  const std::string& holding(const std::string& text) const {
    std::ofstream(name_) << text;
    return name_;
  }
  void expect_refused(const std::string& text, const std::string& where, const std::string& what) const {
    holding(text);
    EXPECT_THAT([&] { read_tabulated_profile(name_); },
                ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(name_ + where), HasSubstr(what))));
  }

 private:
  std::string name_;
};

TEST_F(TableFile, IsReadWithHeaderAndComments) {
  const std::string inner = "3,13\n4,12\n5,11\n6,10\n7,9\n8,8\n9,7\n10,6\n11,5\n12,4\n13,3\n14,2\n15,1\n";
  const auto plain = read_tabulated_profile(holding("0,16\n1,15\n2,14\n" + inner + "16,0\n"));
  EXPECT_EQ(plain.radius, 16);
  EXPECT_NEAR(plain.mean_pressure * 3, 16, 1e-14);
  const auto full = read_tabulated_profile(
      holding("# measured\n\n radius , pressure\r\n0, 16.0\r\n 1e0,15\n# here\n2,14\n\n" + inner + "16,0"));
  EXPECT_EQ(full.radius, 16);
  EXPECT_EQ(full.profile->twist_integral(at(0.3)), plain.profile->twist_integral(at(0.3)));
  EXPECT_THAT(plain.profile->name(), HasSubstr("file:"));
}

TEST_F(TableFile, IsRefusedByLine) {
  expect_refused("radius,pressure\n0,3\n1,x\n", ":3", "pressure = x; allowed: a number");
  expect_refused("r,p\n0,3\n", ":1", "radius = r; allowed: a number");
  expect_refused("0,3\n1,2,5\n", ":2", "1,2,5; allowed: radius,pressure");
  expect_refused("0,3\n1\n", ":2", "1; allowed: radius,pressure");
  expect_refused("0,3\n1,2 Pa\n", ":2", "2 Pa; allowed: a number");
  expect_refused("# p\n0,3\n1,2\n\n0.5,1\n3,0\n", ":5",
                 "radius = 0.5; allowed: finite and more than the one before, 1");
  expect_refused("0,3\n1,-2\n2,1\n3,0\n", ":2", "pressure = -2; allowed: finite and not negative");
  expect_refused("0,3\n1,nan\n2,1\n3,0\n", ":2", "pressure = nan");
  expect_refused("", "", "0 points; allowed: at least 16");
}

TEST_F(TableFile, IsAFileThatEnds) {
  for (const std::string file : {"/dev/zero", "/", "/no/such/file"}) {
    EXPECT_THAT(
        [&] { read_tabulated_profile(file); },
        ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(file), HasSubstr("allowed: a CSV file"))));
  }
  expect_refused(std::string((1 << 20) + 1, ' '), "", "it is larger");
}

TEST_F(TableFile, MayBeginWithAByteOrderMark) {
  std::string table = "\xEF\xBB\xBFradius,pressure\n";
  for (int r = 0; r <= 20; ++r) table += std::to_string(r) + "," + std::to_string(20 - r) + "\n";
  EXPECT_EQ(read_tabulated_profile(holding(table)).radius, 20);
}

}  // namespace
}  // namespace slipstick::analytic
