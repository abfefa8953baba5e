#include "analytic/certified/ball.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <regex>
#include <stdexcept>

namespace slipstick::analytic {

namespace {

/// Digits in a base, as a whole number.
Rational whole(const std::string& digits, int base) {
  Rational result;
  fmpq_set_str(result.get(), digits.c_str(), base);
  return result;
}

std::string in_digits(const Rational& number) {
  char* const digits = fmpq_get_str(nullptr, 10, number.get());
  std::string result = digits;
  flint_free(digits);
  return result;
}

/// base^exponent
Rational power(slong base, slong exponent) { return made_by<Rational>(fmpq_pow_si, Rational(base).get(), exponent); }

Ball ten_to(slong exponent) {
  Ball result = 10;
  arb_pow_ui(result.get(), result.get(), static_cast<ulong>(std::abs(exponent)), Precision::bits());
  return exponent < 0 ? 1 / result : result;
}

/// The e with 10^e <= |x| < 10^(e + 1), or an adjacent one.
slong decimal_exponent(const Ball& ball) {
  const Ball log10 = log(abs(ball.middle())) / log(Ball(10));
  return static_cast<slong>(arf_get_si(arb_midref(log10.get()), ARF_RND_FLOOR));
}

/// digits * 10^(exponent + 1 - number of digits), as one would write it. No number of a contact is negative.
std::string written(std::string digits, slong exponent) {
  const auto count = static_cast<slong>(digits.size());
  std::string tail;
  if (exponent < -5 || exponent >= count) {
    tail = fmt::format("e{}", exponent);
    exponent = 0;
  }
  if (exponent < 0) {
    digits.insert(0, static_cast<std::size_t>(-exponent), '0');
    exponent = 0;
  }
  const auto point = static_cast<std::size_t>(exponent) + 1;
  if (point < digits.size()) digits.insert(point, 1, '.');
  return digits + tail;
}

/// Hundredths of a unit, rounded up, that |ball| may be; nothing where it is more than `most`.
std::optional<slong> hundredths(const Ball& ball, slong most) {
  const Ball scaled = 100 * abs(ball);
  if (!(scaled < most + 1)) return {};
  const slong result = arf_get_si(arb_midref(upper_bound(scaled).get()), ARF_RND_CEIL);
  return result <= most ? std::optional(result) : std::nullopt;
}

}  // namespace

Rational read_exactly(const std::string& name, const std::string& text) {
  constexpr std::size_t kLongest = 2000;
  static const std::regex decimal(R"(([+-]?)([0-9]*)\.?([0-9]*)(?:[eE]([+-]?[0-9]{1,5}))?)");
  static const std::regex hexadecimal(R"(([+-]?)0[xX]([0-9a-fA-F]*)\.?([0-9a-fA-F]*)(?:[pP]([+-]?[0-9]{1,5}))?)");

  std::smatch parts;
  const bool fits = text.size() <= kLongest;
  const bool hex = fits && std::regex_match(text, parts, hexadecimal);
  if (!(hex || (fits && std::regex_match(text, parts, decimal))) || parts.length(2) + parts.length(3) == 0)
    throw std::domain_error(fmt::format("{} = '{}' is not a number", name, text.substr(0, kLongest)));
  const slong exponent = (parts[4].matched ? std::stol(parts[4]) : 0) - parts.length(3) * (hex ? 4 : 1);
  const auto result = made_by<Rational>(fmpq_mul, power(hex ? 2 : 10, exponent).get(),
                                        whole(parts.str(2) + parts.str(3), hex ? 16 : 10).get());

  static const Rational least = power(10, -1000);
  static const Rational most = power(10, 1000);
  if (result != Rational(0) && (result < least || most < result))
    throw std::domain_error(fmt::format("{} = {} is beyond 1e-1000..1e1000", name, text));
  return parts.str(1) == "-" ? Rational(0) - result : result;
}

std::optional<certified::Number> print_proven(const Ball& ball, int digits) {
  if (!ball.finite()) return {};
  for (const int exact : {0, 1})
    if (arb_equal_si(ball.get(), exact) != 0) return certified::Number{std::to_string(exact), "0"};
  if (arb_contains_zero(ball.get()) != 0) return {};

  const Precision precision(Precision::bits() + 64);
  const auto count = static_cast<std::size_t>(digits);
  slong exponent = decimal_exponent(ball);
  for (int attempt = 0; attempt < 3; ++attempt) {
    const Ball units = ball * ten_to(digits - 1 - exponent);  // of the last digit
    Rational rounded;
    arf_get_fmpz(fmpq_numref(rounded.get()), arb_midref(units.get()), ARF_RND_NEAR);
    const std::string text = in_digits(rounded);
    if (text.size() != count) {
      exponent += text.size() > count ? 1 : -1;
      continue;
    }
    const auto error = made_by<Ball>(arb_sub_fmpz, units.get(), fmpq_numref(rounded.get()), Precision::bits());
    const auto radius = hundredths(error, 51);
    if (!radius) return {};
    const std::string radius_text = std::to_string(*radius);
    const slong radius_exponent = exponent - digits - 2 + static_cast<slong>(radius_text.size());
    return certified::Number{written(text, exponent), *radius == 0 ? "0" : written(radius_text, radius_exponent)};
  }
  return {};
}

}  // namespace slipstick::analytic
