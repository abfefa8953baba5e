#include "analytic/certified/certified.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "analytic/certified/reference_rows.hpp"
#include "analytic/certified/tests/known.hpp"
#include "analytic/references/references.hpp"

namespace slipstick::analytic::certified {
namespace {

using namespace known;

/// The line that the table's maker writes for such a row.
std::string made_again(const testing::Row& row) {
  constexpr int kDigits = 30;
  const double value = row.argument("value");
  const std::string& quantity = row.text("quantity");
  if (quantity == "traction")
    return line(traction_row(row.text("profile"), row.text("given"), value, row.argument("at"), kDigits));
  for (const ReferenceRow& made : state_rows(row.text("profile"), row.text("given"), value, kDigits))
    if (made.quantity == quantity) return line(made);
  return "";
}

/// SLIPSTICK_TEST_ALL=1: every row, else a sample.
TEST(CertifiedTable, IsReproduced) {
  const char* all = std::getenv("SLIPSTICK_TEST_ALL");
  const std::size_t step = all && std::string(all) == "1" ? 1 : 37;
  const auto rows = testing::read_rows(SLIPSTICK_REFERENCES "/certified_references.csv");
  EXPECT_GT(rows.size(), 2000U);
  for (std::size_t i = 0; i < rows.size(); i += step) EXPECT_EQ(made_again(rows[i]), rows[i].line() + '\n');
}

/// By the closed slopes, which the table's maker does not use: of the sphere, d(M/M_lim)/dc = -64/(3 pi^2)
/// c^2 E and d(twist)/dc = -3/(4 pi) E/c.
TEST(CertifiedTable, HasTheClosedCostsOfTheSphere) {
  const Precision precision(kBits);
  for (const auto& row : testing::read_rows(SLIPSTICK_REFERENCES "/certified_references.csv")) {
    if (row.text("profile") != "hertz" || row.text("quantity") == "traction") continue;
    const Quantity given = kQuantities.at(row.text("given"));
    const State found = state(kHertz, given, row.text("value"), {}, 30);
    const Ball c = enclosure(found.stick_ratio);
    const Ball e = e_of(c).real();
    const auto slope = [&](const std::string& name) {  // |d ln y/dc|
      const Ball y = enclosure(found.*kMember.at(name));
      if (name == "twist") return 3 / (4 * pi()) * e / (c * y);
      return (name.starts_with("moment") ? 64 / (3 * pi() * pi()) * c * c * e : Ball(1)) / y;
    };
    const Ball cost = slope(row.text("quantity")) / slope(row.text("given"));
    EXPECT_NEAR(row.argument("cost") / arf_get_d(arb_midref(cost.get()), ARF_RND_NEAR), 1, 0.0051)
        << row.line();
  }
}

}  // namespace
}  // namespace slipstick::analytic::certified
