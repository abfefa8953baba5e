#pragma once

#include <optional>
#include <string>

#include "analytic/certified/ball.hpp"
#include "analytic/certified/certified.hpp"

#include <flint/fmpq.h>

/// Between decimal strings and balls.
namespace slipstick::analytic {

/// A rational number, exactly.
class Rational {
 public:
  Rational(slong numerator = 0, ulong denominator = 1) {
    fmpq_init(q_);
    fmpq_set_si(q_, numerator, denominator);
  }
  Rational(const Rational& other) : Rational() { fmpq_set(q_, other.q_); }
  Rational& operator=(const Rational& other) {
    fmpq_set(q_, other.q_);
    return *this;
  }
  ~Rational() { fmpq_clear(q_); }
  fmpq* get() { return q_; }
  const fmpq* get() const { return q_; }

  friend Rational operator-(const Rational& a, const Rational& b) {
    return made_by<Rational>(fmpq_sub, a.q_, b.q_);
  }
  friend auto operator<=>(const Rational& a, const Rational& b) { return fmpq_cmp(a.q_, b.q_) <=> 0; }
  friend bool operator==(const Rational& a, const Rational& b) { return fmpq_equal(a.q_, b.q_) != 0; }
  Ball ball() const { return made_by<Ball>(arb_set_fmpq, q_, Precision::bits()); }

 private:
  fmpq_t q_;
};

/// The number that the text writes in C's decimal or hexadecimal notation, exactly. Throws std::domain_error,
/// which calls it `name`, for other text, and for numbers but 0 outside 1e-1000..1e1000.
Rational read_exactly(const std::string& name, const std::string& text);

/// The number in the ball to this many significant digits, with a radius that includes the ball's radius and
/// the rounding to decimal. None if this radius would exceed 0.51 of the last digit.
std::optional<certified::Number> print_proven(const Ball& ball, int digits);

}  // namespace slipstick::analytic
