#pragma once

#if __has_include(<flint/arb.h>)  // FLINT 3, which Arb has joined
#include <flint/acb.h>
#include <flint/acb_calc.h>
#include <flint/acb_hypgeom.h>
#include <flint/arb.h>
#else
#include <acb.h>
#include <acb_calc.h>
#include <acb_hypgeom.h>
#include <arb.h>
#endif

#include <flint/fmpq.h>

#include <concepts>
#include <optional>
#include <string>
#include <utility>

#include "analytic/certified/certified.hpp"

/// Arb's balls as C++ values: a ball encloses a number, and whatever is computed from balls encloses what
/// would have been computed from the numbers.
namespace slipstick::analytic {

/// The bits to which balls are computed on this thread, as long as this object lives.
class Precision {
 public:
  explicit Precision(slong bits) : before_(std::exchange(bits_, bits)) {}
  ~Precision() { bits_ = before_; }
  Precision(const Precision&) = delete;
  Precision& operator=(const Precision&) = delete;
  static slong bits() { return bits_; }

 private:
  static inline thread_local slong bits_ = 64;
  slong before_;
};

/// Returns the first argument, which one of Arb's functions sets.
template <class Result, class Function, class... Arguments>
Result made_by(Function* f, const Arguments&... arguments) {
  Result result;
  f(result.get(), arguments...);
  return result;
}

/// A real number between mid - radius and mid + radius.
class Ball {
 public:
  Ball() { arb_init(x_); }
  template <std::integral Integer>
  Ball(Integer n) : Ball() {  // implicit, for formulas that read as in print
    arb_set_si(x_, static_cast<slong>(n));
  }
  Ball(const Ball& other) : Ball() { arb_set(x_, other.x_); }
  Ball(Ball&& other) noexcept : Ball() { arb_swap(x_, other.x_); }
  Ball& operator=(Ball other) noexcept {
    arb_swap(x_, other.x_);
    return *this;
  }
  ~Ball() { arb_clear(x_); }
  arb_ptr get() { return x_; }
  arb_srcptr get() const { return x_; }

  friend Ball operator+(const Ball& a, const Ball& b) { return apply(arb_add, a, b); }
  friend Ball operator-(const Ball& a, const Ball& b) { return apply(arb_sub, a, b); }
  friend Ball operator*(const Ball& a, const Ball& b) { return apply(arb_mul, a, b); }
  friend Ball operator/(const Ball& a, const Ball& b) { return apply(arb_div, a, b); }
  friend Ball operator-(const Ball& a) { return 0 - a; }
  friend Ball agm(const Ball& a, const Ball& b) { return apply(arb_agm, a, b); }
  friend Ball sqrt(const Ball& a) { return apply(arb_sqrt, a); }
  friend Ball exp(const Ball& a) { return apply(arb_exp, a); }
  friend Ball cos(const Ball& a) { return apply(arb_cos, a); }
  friend Ball log(const Ball& a) { return apply(arb_log, a); }
  friend Ball atan(const Ball& a) { return apply(arb_atan, a); }
  friend Ball log1p(const Ball& a) { return apply(arb_log1p, a); }
  friend Ball abs(const Ball& a) { return made_by<Ball>(arb_abs, a.x_); }

  /// Whether it holds for each pair of numbers in the balls: both may be false.
  friend bool operator<(const Ball& a, const Ball& b) { return arb_lt(a.x_, b.x_) != 0; }
  friend bool operator>(const Ball& a, const Ball& b) { return arb_gt(a.x_, b.x_) != 0; }
  bool finite() const { return arb_is_finite(x_) != 0; }
  /// Whether this ball lies strictly inside the other.
  bool inside(const Ball& other) const { return arb_contains_interior(other.x_, x_) != 0; }

  friend Ball lower_bound(const Ball& a) { return bound(arb_get_lbound_arf, a); }
  friend Ball upper_bound(const Ball& a) { return bound(arb_get_ubound_arf, a); }
  Ball middle() const { return made_by<Ball>(arb_get_mid_arb, x_); }
  /// [-r, r] with r >= |x| for all x of the ball.
  Ball symmetric() const {
    Ball result;
    arb_get_mag(arb_radref(result.x_), x_);
    return result;
  }
  /// 2^n times the ball, exactly.
  Ball shifted(slong n) const { return made_by<Ball>(arb_mul_2exp_si, x_, n); }

 private:
  template <class Function, class... Balls>
  static Ball apply(Function* f, const Balls&... balls) {
    return made_by<Ball>(f, balls.x_..., Precision::bits());
  }
  static Ball bound(void (*f)(arf_t, const arb_t, slong), const Ball& a) {
    Ball result;
    f(arb_midref(result.x_), a.x_, Precision::bits());
    return result;
  }

  arb_t x_;
};

inline Ball pi() { return made_by<Ball>(arb_const_pi, Precision::bits()); }

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

  friend Rational operator-(const Rational& a, const Rational& b) { return made_by<Rational>(fmpq_sub, a.q_, b.q_); }
  friend auto operator<=>(const Rational& a, const Rational& b) { return fmpq_cmp(a.q_, b.q_) <=> 0; }
  friend bool operator==(const Rational& a, const Rational& b) { return fmpq_equal(a.q_, b.q_) != 0; }
  Ball ball() const { return made_by<Ball>(arb_set_fmpq, q_, Precision::bits()); }

 private:
  fmpq_t q_;
};

/// A complex number in a rectangle of two balls.
class ComplexBall {
 public:
  ComplexBall() { acb_init(z_); }
  ComplexBall(const Ball& real) : ComplexBall() { acb_set_arb(z_, real.get()); }
  ComplexBall(const Ball& real, const Ball& imaginary) : ComplexBall() {
    acb_set_arb_arb(z_, real.get(), imaginary.get());
  }
  template <std::integral Integer>
  ComplexBall(Integer n) : ComplexBall(Ball(n)) {}
  explicit ComplexBall(acb_srcptr z) : ComplexBall() { acb_set(z_, z); }
  ComplexBall(const ComplexBall& other) : ComplexBall(other.z_) {}
  ComplexBall(ComplexBall&& other) noexcept : ComplexBall() { acb_swap(z_, other.z_); }
  ComplexBall& operator=(ComplexBall other) noexcept {
    acb_swap(z_, other.z_);
    return *this;
  }
  ~ComplexBall() { acb_clear(z_); }
  acb_ptr get() { return z_; }
  acb_srcptr get() const { return z_; }
  /// Nowhere: the answer of a function that is asked to be analytic where it is not.
  static ComplexBall indeterminate() { return made_by<ComplexBall>(acb_indeterminate); }

  friend ComplexBall operator+(const ComplexBall& a, const ComplexBall& b) { return apply(acb_add, a, b); }
  friend ComplexBall operator-(const ComplexBall& a, const ComplexBall& b) { return apply(acb_sub, a, b); }
  friend ComplexBall operator*(const ComplexBall& a, const ComplexBall& b) { return apply(acb_mul, a, b); }
  friend ComplexBall operator/(const ComplexBall& a, const ComplexBall& b) { return apply(acb_div, a, b); }
  friend ComplexBall operator-(const ComplexBall& a) { return 0 - a; }
  friend ComplexBall sin(const ComplexBall& a) { return apply(acb_sin, a); }
  friend ComplexBall cos(const ComplexBall& a) { return apply(acb_cos, a); }
  friend ComplexBall exp(const ComplexBall& a) { return apply(acb_exp, a); }
  friend ComplexBall sqrt(const ComplexBall& a) { return apply(acb_sqrt, a); }
  friend ComplexBall log(const ComplexBall& a) { return apply(acb_log, a); }
  friend ComplexBall atan(const ComplexBall& a) { return apply(acb_atan, a); }
  friend Ball abs(const ComplexBall& a) { return made_by<Ball>(acb_abs, a.z_, Precision::bits()); }
  /// agm(1, a), cut along the negative axis.
  friend ComplexBall agm1(const ComplexBall& a) { return apply(acb_agm1, a); }
  /// 2F1(a, b; c; z), cut along [1, infinity).
  friend ComplexBall hypergeometric(const ComplexBall& a, const ComplexBall& b, const ComplexBall& c,
                                    const ComplexBall& z) {
    return made_by<ComplexBall>(acb_hypgeom_2f1, a.z_, b.z_, c.z_, z.z_, 0, Precision::bits());
  }

  Ball real() const { return made_by<Ball>(acb_get_real, z_); }
  Ball imaginary() const { return made_by<Ball>(acb_get_imag, z_); }
  /// Whether it may lie on (-infinity, 0], where sqrt and log are cut.
  bool touches_cut() const { return arb_contains_zero(acb_imagref(z_)) != 0 && arb_is_positive(acb_realref(z_)) == 0; }

 private:
  template <class Function, class... Balls>
  static ComplexBall apply(Function* f, const Balls&... balls) {
    return made_by<ComplexBall>(f, balls.z_..., Precision::bits());
  }

  acb_t z_;
};

/// agm(1, a) of a > 0 and its derivative.
inline std::pair<Ball, Ball> agm1_and_slope(const Ball& a) {
  acb_struct taylor[2];
  for (auto& term : taylor) acb_init(&term);
  acb_agm1_cpx(taylor, ComplexBall(a).get(), 2, Precision::bits());
  std::pair<Ball, Ball> result;
  acb_get_real(result.first.get(), &taylor[0]);
  acb_get_real(result.second.get(), &taylor[1]);
  for (auto& term : taylor) acb_clear(&term);
  return result;
}

/// The integral from a to b of f, which is real there, with proof. f(z, analytic) is f on the ball z; with
/// `analytic` it must be indeterminate, or analytic on all of z. It must not throw.
template <class Function>
Ball integral(const Function& f, const Ball& a, const Ball& b) {
  const auto call = [](acb_ptr out, const acb_t z, void* self, slong order, slong bits) {
    const Precision precision(bits);
    const ComplexBall value = (*static_cast<const Function*>(self))(ComplexBall(z), order != 0);
    acb_set(out, value.get());
    return 0;
  };
  mag_t tolerance;  // 0: what counts is the relative error
  mag_init(tolerance);
  ComplexBall result;
  acb_calc_integrate(result.get(), call, const_cast<Function*>(&f), ComplexBall(a).get(), ComplexBall(b).get(),
                     Precision::bits(), tolerance, nullptr, Precision::bits());
  mag_clear(tolerance);
  return result.real();
}

// ---------------------------------------------------------------- between decimal strings and balls (ball_text.cpp)

/// The number that the text writes in C's decimal or hexadecimal notation, exactly. Throws std::domain_error,
/// which calls it `name`, for other text, and for numbers but 0 outside 1e-1000..1e1000.
Rational read_exactly(const std::string& name, const std::string& text);

/// The number in the ball to this many significant digits, with a radius that includes the ball's radius and
/// the rounding to decimal. None if this radius would exceed 0.51 of the last digit.
std::optional<certified::Number> print_proven(const Ball& ball, int digits);

}  // namespace slipstick::analytic
