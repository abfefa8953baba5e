// Every quantity of the double path against proven references.

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "analytic/tests/replay.hpp"

namespace slipstick::analytic {
namespace {

using testing::replay;
using testing::Row;

void expect_accurate(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    const auto [error, allowed] = replay(row);
    EXPECT_LE(error, allowed) << "eps: " << row.line();
  }
}

TEST(Accuracy, HoldsOverTheCertifiedTable) {
  expect_accurate(testing::read_references("certified_references.csv"));
}

TEST(Accuracy, HoldsAtTheHardestInputs) { expect_accurate(testing::all_references()); }

/// A reference whose own bound were near what is tested would prove nothing.
TEST(Accuracy, IsFarWiderThanTheReferences) {
  for (const Row& row : testing::all_references())
    EXPECT_LE(row.number("bound"), 1e-3L * testing::kEps * std::abs(row.number("reference"))) << row.line();
}

TEST(Accuracy, IsTestedForEveryQuantityOfEveryProfile) {
  std::set<std::string> seen;
  for (const Row& row : testing::read_references("certified_references.csv"))
    seen.insert(row.text("profile") + ' ' + row.text("given") + ' ' + row.text("quantity"));
  for (const std::string profile : {"hertz", "cone", "flat_punch"}) {
    for (const auto& [given, from] : testing::kFrom)
      for (const auto& [quantity, member] : testing::kMember)
        EXPECT_TRUE(given == quantity || seen.contains(profile + ' ' + given + ' ' + quantity))
            << profile << ' ' << given << ' ' << quantity;
    EXPECT_TRUE(seen.contains(profile + " stick_ratio traction")) << profile;
  }
}

}  // namespace
}  // namespace slipstick::analytic
