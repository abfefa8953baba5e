#include <gmock/gmock.h>

#include <stdexcept>
#include <utility>

#include "analytic/certified/tests/known.hpp"

namespace slipstick::analytic::certified {
namespace {

using namespace known;
using namespace ::testing;

TEST(CertifiedNumber, NarrowsInside) {
  const Precision precision(500);
  for (const Profile& profile : {kHertz, kCone, kFlatPunch, power("0.5")})
    for (const auto& [quantity, value] : {std::pair(Quantity::moment_ratio, "0.9"),
                                          {Quantity::moment_deficit, "1e-9"},
                                          {Quantity::twist, "0.3"},
                                          {Quantity::stick_complement, "0.001"}}) {
      const State wide = state(profile, quantity, value, {"0.3", "0.9"}, 20);
      const State narrow = state(profile, quantity, value, {"0.3", "0.9"}, 60);
      const auto holds = [](const Number& a, const Number& b) {
        return arb_contains(enclosure(a).get(), enclosure(b).get()) != 0;
      };
      for (const auto& [name, member] : kMember) EXPECT_TRUE(holds(wide.*member, narrow.*member)) << name;
      for (const std::size_t i : {0, 1}) EXPECT_TRUE(holds(wide.traction[i], narrow.traction[i])) << i;
    }
}

/// The requested number of digits, its radius within 0.51 of the last.
TEST(CertifiedNumber, IsProvenToItsLastDigit) {
  const Precision precision(600);
  for (const int digits : {15, 30, 77, 100})
    for (const std::string m : {"1e-8", "0.3", "0.97", "0.999999999"}) {
      const State found = state(kCone, Quantity::moment_ratio, m, {"0.1"}, digits);
      std::vector<Number> numbers(found.traction);
      for (const auto& [name, member] : kMember) numbers.push_back(found.*member);
      for (const Number& number : numbers) {
        std::string mantissa = number.value.substr(0, number.value.find('e'));
        const auto exponent =
            mantissa.size() == number.value.size() ? "" : number.value.substr(mantissa.size());
        const auto places = mantissa.size() - 1 - mantissa.find('.');
        mantissa.erase(mantissa.find('.'), 1);
        mantissa.erase(0, mantissa.find_first_not_of('0'));
        EXPECT_EQ(mantissa.size(), static_cast<std::size_t>(digits)) << number.value;
        const Ball unit = exact("1" + exponent) / exact("1e" + std::to_string(places));
        EXPECT_FALSE(exact(number.radius) > unit * exact("0.51000000001")) << number.value;
      }
    }
}

TEST(CertifiedNumber, IsPrintedAsOneReadsIt) {
  const Precision precision(kBits);
  const auto text = [](const std::string& x, int digits = 15) {
    return print_proven(exact(x), digits).value_or(Number{"none", ""}).value;
  };
  EXPECT_EQ(text("0"), "0");
  EXPECT_EQ(text("1"), "1");
  EXPECT_EQ(text("0.5"), "0.500000000000000");
  EXPECT_EQ(text("-0.5"), "-0.500000000000000");
  EXPECT_EQ(text("123.25"), "123.250000000000");
  EXPECT_EQ(text("123456789012345"), "123456789012345");
  EXPECT_EQ(text("1234567890123456"), "1.23456789012346e15");
  EXPECT_EQ(text("0.99999999999999999"), "1.00000000000000");
  EXPECT_EQ(text("9.9999999999999949"), "9.99999999999999");
  EXPECT_EQ(text("0.00001"), "0.0000100000000000000");
  EXPECT_EQ(text("0.000001"), "1.00000000000000e-6");
  EXPECT_EQ(text("2e-300"), "2.00000000000000e-300");
  EXPECT_EQ(print_proven(exact("0.5"), 20)->radius, "0");
  EXPECT_EQ(print_proven(exact("2") / 3, 15)->radius, "3.4e-16");
  EXPECT_EQ(print_proven(exact("0.1"), 20)->radius, "1e-22");
}

TEST(CertifiedNumber, IsNotPrintedWhereItsBallIsTooWide) {
  const Precision precision(kBits);
  const auto printed = [](const std::string& x, const std::string& radius) {
    return print_proven(exact(x) + exact(radius).symmetric(), 15).has_value();
  };
  EXPECT_TRUE(printed("0.123456789012345", "5.0e-16"));
  EXPECT_FALSE(printed("0.123456789012345", "5.2e-16"));
  EXPECT_TRUE(printed("0.1234567890123454", "1e-16"));
  EXPECT_FALSE(printed("0.1234567890123454", "1.2e-16"));
  EXPECT_FALSE(printed("0", "1e-400"));
}

TEST(CertifiedNumber, IsReadExactly) {
  const auto read = [](const std::string& text) { return read_exactly("x", text); };
  EXPECT_EQ(read("0.1"), Rational(1, 10));
  EXPECT_EQ(read("-1.25e1"), Rational(-25, 2));
  EXPECT_EQ(read("+.5"), Rational(1, 2));
  EXPECT_EQ(read("5."), Rational(5));
  EXPECT_EQ(read("0x1.8p-3"), Rational(3, 16));
  EXPECT_EQ(read("-0XAp0"), Rational(-10));
  EXPECT_EQ(read("0x10"), Rational(16));
  EXPECT_EQ(read("0e99"), Rational(0));
  EXPECT_NE(read("0x1.999999999999ap-4"), Rational(1, 10));  // the double nearest to 0.1
}

TEST(CertifiedRange, RefusesWhatIsNoNumber) {
  for (const std::string bad :
       {"", ".", "nan", "inf", "1e", "0x", "1 ", " 1", "1,5", "0.5.1", "--1", "1e999999"})
    EXPECT_THAT(
        [&] { state(kHertz, Quantity::twist, bad, {}, 20); },
        ThrowsMessage<std::domain_error>(AllOf(HasSubstr("G a^2 phi/(mu W)"), HasSubstr("'" + bad + "'"))))
        << bad;
  EXPECT_THROW(state(kHertz, Quantity::twist, "1e1001", {}, 20), std::domain_error);
  EXPECT_THROW(state(kHertz, Quantity::stick_ratio, "1e-1001", {}, 20), std::domain_error);
  EXPECT_THROW(state(kHertz, Quantity::stick_ratio, "0.5", {"x"}, 20), std::domain_error);
}

TEST(CertifiedRange, NamesValueAndRange) {
  const auto message = [](Quantity given, const std::string& value, const std::string& words) {
    EXPECT_THAT([&] { state(kHertz, given, value, {}, 20); }, ThrowsMessage<std::domain_error>(words))
        << value;
  };
  message(Quantity::moment_ratio, "1.2", "M/M_lim = 1.2 is gross slip; allowed: 0 <= M/M_lim < 1");
  message(Quantity::moment_ratio, "1", "M/M_lim = 1 is gross slip; allowed: 0 <= M/M_lim < 1");
  message(Quantity::moment_ratio, "-0.1", "M/M_lim = -0.1; allowed: 0 <= M/M_lim < 1");
  message(Quantity::moment_deficit, "0", "1 - M/M_lim = 0 is gross slip; allowed: 0 < 1 - M/M_lim <= 1");
  message(Quantity::moment_deficit, "1.5", "1 - M/M_lim = 1.5; allowed: 0 < 1 - M/M_lim <= 1");
  message(Quantity::stick_ratio, "0", "a_s/a = 0; allowed: 0 < a_s/a <= 1");
  message(Quantity::stick_ratio, "1.1", "a_s/a = 1.1; allowed: 0 < a_s/a <= 1");
  message(Quantity::stick_complement, "1", "1 - a_s/a = 1; allowed: 0 <= 1 - a_s/a < 1");
  message(Quantity::twist, "-1", "G a^2 phi/(mu W) = -1; allowed: 0 <= G a^2 phi/(mu W)");
}

TEST(CertifiedRange, RefusesWhatLiesOutside) {
  const auto traction = [](const Profile& profile, const std::string& r) {
    return at_stick_ratio(profile, "0.5", {r}, 20);
  };
  EXPECT_THROW(traction(kHertz, "1.1"), std::domain_error);
  EXPECT_THROW(traction(kHertz, "-0.1"), std::domain_error);
  EXPECT_THAT([&] { traction(kFlatPunch, "1.0"); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("infinite"), HasSubstr("0 <= r/a < 1"))));
  EXPECT_EQ(traction(kCone, "0").traction[0].value, "0");
  for (const std::string n : {"0", "-1", "", "x"})
    EXPECT_THROW(at_stick_ratio(power(n), "0.5"), std::domain_error) << n;
  for (const int digits : {14, 101, 0, -1})
    EXPECT_THROW(at_stick_ratio(kHertz, "0.5", {}, digits), std::domain_error) << digits;
  EXPECT_THROW(state(kHertz, Quantity::twist, "1e9", {}, 20), std::domain_error);
}

}  // namespace
}  // namespace slipstick::analytic::certified
