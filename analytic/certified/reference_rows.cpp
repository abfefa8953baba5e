#include "analytic/certified/reference_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analytic/certified/ball_text.hpp"

namespace slipstick::analytic::certified {

namespace {

constexpr int kCostDigits = 60;  // what a double's neighbour changes has 40 of them left

/// The quantity and the value that name a state.
struct Question {
  Profile profile;
  Quantity given;
  double value;
};

Question question(const std::string& profile, const std::string& given, double value) {
  if (!kQuantities.contains(given))
    throw std::domain_error(fmt::format("\"{}\" is no quantity to give", given));
  return {.profile = profile_named(profile), .given = kQuantities.at(given), .value = value};
}

/// A double as itself: no decimal of less than 50 digits is.
std::string exactly(double x) { return fmt::format("{:a}", x); }

State evaluate(const Question& at, const std::vector<double>& radii, int digits) {
  std::vector<std::string> text(radii.size());
  std::ranges::transform(radii, text.begin(), exactly);
  return state(at.profile, at.given, exactly(at.value), text, digits);
}

Ball middle(const Number& number) { return read_exactly("reference", number.value).ball(); }
Ball ball(double x) { return read_exactly("double", exactly(x)).ball(); }

/// |d ln y/d ln x|
double relative_slope(const Number& y0, const Number& y1, double x0, double x1) {
  const Precision precision(256);
  const Ball sum = middle(y0) + middle(y1);
  if (arb_is_zero(sum.get()) != 0) return 0;
  const Ball slope = (middle(y1) - middle(y0)) / sum * (ball(x0) + ball(x1)) / (ball(x1) - ball(x0));
  return std::abs(arf_get_d(arb_midref(slope.get()), ARF_RND_NEAR));
}

/// The states at the value's two neighbours among the doubles.
class Change {
 public:
  Change(Question at, const std::vector<double>& radii)
      : below_(std::nextafter(at.value, 0)), above_(std::nextafter(at.value, HUGE_VAL)) {
    at.value = below_;
    at_below_ = evaluate(at, radii, kCostDigits);
    at.value = above_;
    at_above_ = evaluate(at, radii, kCostDigits);
  }
  template <class Pick>
  double cost(const Pick& pick) const {
    return relative_slope(pick(at_below_), pick(at_above_), below_, above_);
  }

 private:
  double below_;
  double above_;
  State at_below_;
  State at_above_;
};

}  // namespace

std::string head(const std::string& made_by) {
  return fmt::format(
      "# Proven values at doubles, each meant exactly; cost is |d ln quantity/d ln value|, of a traction its "
      "sum over "
      "value and at. Made by {}.\nprofile,given,value,quantity,at,reference,bound,cost\n",
      made_by);
}

std::string line(const ReferenceRow& row) {
  return fmt::format("{},{},{},{},{},{},{},{:.3g}\n", row.profile, row.given, row.value, row.quantity,
                     row.at ? fmt::format("{}", *row.at) : "", row.reference.value, row.reference.radius,
                     row.cost);
}

std::vector<ReferenceRow> state_rows(const std::string& profile, const std::string& given, double value,
                                     int digits) {
  const Question at = question(profile, given, value);
  const State proven = evaluate(at, {}, digits);
  const Change change(at, {});
  std::vector<ReferenceRow> rows;
  for (const auto& [quantity, member] : kMembers)
    if (quantity != given)
      rows.push_back({.profile = profile,
                      .given = given,
                      .value = value,
                      .quantity = quantity,
                      .at = std::nullopt,
                      .reference = proven.*member,
                      .cost = change.cost([column = member](const State& state) { return state.*column; })});
  return rows;
}

ReferenceRow traction_row(const std::string& profile, const std::string& given, double value, double radius,
                          int digits) {
  const Question at = question(profile, given, value);
  const double below = std::nextafter(radius, 0);
  const double above = std::nextafter(radius, 1);
  const State beside = evaluate(at, {below, above}, kCostDigits);
  const double along = relative_slope(beside.traction[0], beside.traction[1], below, above);
  return {.profile = profile,
          .given = given,
          .value = value,
          .quantity = "traction",
          .at = radius,
          .reference = evaluate(at, {radius}, digits).traction[0],
          .cost = Change(at, {radius}).cost([](const State& state) { return state.traction[0]; }) + along};
}

}  // namespace slipstick::analytic::certified
