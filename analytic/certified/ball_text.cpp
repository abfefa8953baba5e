#include "analytic/certified/ball.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace slipstick::analytic {

namespace {

class Integer {
 public:
  Integer() { fmpz_init(n_); }
  Integer(const std::string& digits, int base) : Integer() { fmpz_set_str(n_, digits.c_str(), base); }
  Integer(const Integer&) = delete;
  Integer& operator=(const Integer&) = delete;
  ~Integer() { fmpz_clear(n_); }
  fmpz* get() { return n_; }
  std::string text() const {
    char* digits = fmpz_get_str(nullptr, 10, n_);
    std::string result = digits;
    flint_free(digits);
    return result;
  }

 private:
  fmpz_t n_;
};

/// Takes a number's text apart from left to right.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}
  bool done() const { return rest_.empty(); }
  bool take(std::string_view wanted) {
    if (!rest_.starts_with(wanted)) return false;
    rest_.remove_prefix(wanted.size());
    return true;
  }
  /// Whether there was a minus.
  bool take_sign() { return take("-") || (take("+"), false); }
  std::string take_digits(bool hexadecimal) {
    const std::string_view allowed(hexadecimal ? "0123456789abcdefABCDEF" : "0123456789");
    std::string digits(rest_.substr(0, rest_.find_first_not_of(allowed)));
    rest_.remove_prefix(digits.size());
    return digits;
  }

 private:
  std::string_view rest_;
};

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
  constexpr std::size_t kLongestExponent = 5;

  Reader in(text);
  const bool negative = in.take_sign();
  const bool hex = in.take("0x") || in.take("0X");
  const std::string whole = in.take_digits(hex);
  const std::string fraction = in.take(".") ? in.take_digits(hex) : "";
  bool fine = !whole.empty() || !fraction.empty();
  slong exponent = 0;
  if (in.take(hex ? "p" : "e") || in.take(hex ? "P" : "E")) {
    const bool below = in.take_sign();
    const std::string digits = in.take_digits(false);
    fine = fine && !digits.empty() && digits.size() <= kLongestExponent;
    if (fine) exponent = below ? -std::stol(digits) : std::stol(digits);
  }
  if (!fine || !in.done() || text.size() > kLongest)
    throw std::domain_error(fmt::format("{} = '{}' is not a number", name, text.substr(0, kLongest)));
  exponent -= static_cast<slong>(fraction.size()) * (hex ? 4 : 1);
  const auto result = made_by<Rational>(fmpq_mul_fmpz, power(hex ? 2 : 10, exponent).get(),
                                        Integer(whole + fraction, hex ? 16 : 10).get());

  static const Rational least = power(10, -1000);
  static const Rational most = power(10, 1000);
  if (result != Rational(0) && (result < least || most < result))
    throw std::domain_error(fmt::format("{} = {} is beyond 1e-1000..1e1000", name, text));
  return negative ? Rational(0) - result : result;
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
    Integer rounded;
    arf_get_fmpz(rounded.get(), arb_midref(units.get()), ARF_RND_NEAR);
    const std::string text = rounded.text();
    if (text.size() != count) {
      exponent += text.size() > count ? 1 : -1;
      continue;
    }
    const auto error = made_by<Ball>(arb_sub_fmpz, units.get(), rounded.get(), Precision::bits());
    const auto radius = hundredths(error, 51);
    if (!radius) return {};
    const std::string radius_text = std::to_string(*radius);
    const slong radius_exponent = exponent - digits - 2 + static_cast<slong>(radius_text.size());
    return certified::Number{written(text, exponent), *radius == 0 ? "0" : written(radius_text, radius_exponent)};
  }
  return {};
}

}  // namespace slipstick::analytic
