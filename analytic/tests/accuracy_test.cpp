// Every quantity of the double path against proven references.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "analytic/references/references.hpp"

namespace slipstick::analytic {
namespace {

using testing::replay;
using testing::Row;

TEST(Accuracy, HoldsOverTheCertifiedTableAndTheHardestInputs) {
  for (const Row& row : testing::all_references()) {
    const auto [error, allowed] = replay(row);
    EXPECT_LE(error, allowed) << "eps: " << row.line;
  }
}

/// Moment and tangent stiffness are in no file: they are M_lim M/M_lim, and 16/3 c^3.
TEST(Accuracy, HoldsForMomentAndStiffness) {
  const std::map<std::string, long double> limit_over_pi{
      {"hertz", 3.0L / 16}, {"cone", 1.0L / 6}, {"flat_punch", 1.0L / 4}};
  for (const Row& row : testing::all_references()) {
    const std::string& name = row.text("profile");
    const std::string& quantity = row.text("quantity");
    if (!limit_over_pi.contains(name) || (quantity != "moment_ratio" && quantity != "stick_ratio")) continue;
    const TorsionState state = testing::kFrom.at(row.text("given"))(row.argument("value"), *find_profile(name).profile);
    const long double reference = row.number("reference");
    const bool moment = quantity == "moment_ratio";
    const long double limit = limit_over_pi.at(name) * std::numbers::pi_v<long double>;
    const long double stiffness = 16.0L / 3 * reference * reference * reference;
    const double error = moment ? testing::relative_error(state.moment, limit * reference)
                                : testing::relative_error(state.tangent_stiffness, stiffness);
    const double cost = row.argument("cost") * (moment ? 1 : 3);
    EXPECT_LE(error / testing::kEps, std::max(testing::kAllowed, testing::kOfTheCost * cost)) << row.line;
  }
}

/// A reference whose own bound were near what is tested would prove nothing.
TEST(Accuracy, IsFarWiderThanTheReferences) {
  for (const Row& row : testing::all_references())
    EXPECT_LE(row.number("bound"), 1e-3L * testing::kEps * std::abs(row.number("reference"))) << row.line;
}

TEST(Accuracy, IsTestedForEveryQuantityOfEveryProfile) {
  std::set<std::string> seen;
  for (const Row& row : testing::read_references("certified_references.csv"))
    seen.insert(fmt::format("{} {} {}", row.text("profile"), row.text("given"), row.text("quantity")));
  for (const std::string profile : {"hertz", "cone", "flat_punch"}) {
    for (const auto& [given, from] : testing::kFrom)
      for (const auto& [quantity, member] : testing::kMember)
        EXPECT_TRUE(given == quantity || seen.contains(fmt::format("{} {} {}", profile, given, quantity)))
            << profile << ' ' << given << ' ' << quantity;
    EXPECT_TRUE(seen.contains(profile + " stick_ratio traction")) << profile;
  }
}

}  // namespace
}  // namespace slipstick::analytic
