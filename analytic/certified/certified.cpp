#include "analytic/certified/certified.hpp"

#include <fmt/core.h>

#include <map>
#include <stdexcept>

#include "analytic/certified/ball_contact.hpp"

namespace slipstick::analytic::certified {

namespace {

constexpr int kMinDigits = 15;
constexpr int kMaxDigits = 100;

/// A question, checked, in exact numbers.
struct Question : Equation {
  std::vector<Rational> radii;
};

/// A state in balls.
struct Balls {
  Moment moment;
  Stick stick;
  Ball twist;
  std::vector<Ball> traction;
};

[[noreturn]] void out_of_range(const std::string& name, const std::string& value, const std::string& range) {
  throw std::domain_error(fmt::format("{} = {}; allowed: {}", name, value, range));
}

Rational read_exponent(const Profile& profile) {
  if (profile.kind == Kind::cone) return 1;
  if (profile.kind == Kind::flat_punch || profile.kind == Kind::constant) return 0;  // have no exponent
  const Rational n = read_exactly("exponent n", profile.exponent);
  if (n <= Rational(0)) out_of_range("exponent n", profile.exponent, "n > 0");
  return n;
}

Rational read_value(Quantity given, const std::string& text) {
  struct Range {
    std::string name;
    bool zero, one, beyond_one;  // which are allowed
    std::string words;
  };
  static const std::map<Quantity, Range> ranges{
      {Quantity::moment_ratio, {"M/M_lim", true, false, false, "0 <= M/M_lim < 1"}},
      {Quantity::moment_deficit, {"1 - M/M_lim", false, true, false, "0 < 1 - M/M_lim <= 1"}},
      {Quantity::stick_ratio, {"a_s/a", false, true, false, "0 < a_s/a <= 1"}},
      {Quantity::stick_complement, {"1 - a_s/a", true, false, false, "0 <= 1 - a_s/a < 1"}},
      {Quantity::twist, {"G a^2 phi/(mu W)", true, true, true, "0 <= G a^2 phi/(mu W)"}}};
  const Range& range = ranges.at(given);
  const Rational value = read_exactly(range.name, text);
  const bool gross_slip = (given == Quantity::moment_ratio && value >= Rational(1)) ||
                          (given == Quantity::moment_deficit && value == Rational(0));
  if (gross_slip)
    throw std::domain_error(fmt::format("{} = {} is gross slip; allowed: {}", range.name, text, range.words));
  const bool allowed = value == Rational(0)   ? range.zero
                       : value == Rational(1) ? range.one
                                              : value > Rational(0) && (value < Rational(1) || range.beyond_one);
  if (!allowed) out_of_range(range.name, text, range.words);
  return value;
}

Rational read_radius(Kind kind, const std::string& text) {
  const Rational radius = read_exactly("r/a", text);
  if (radius < Rational(0) || radius > Rational(1)) out_of_range("r/a", text, "0 <= r/a <= 1");
  if (kind == Kind::flat_punch && radius == Rational(1))
    throw std::domain_error(
        fmt::format("r/a = {}: the traction of a flat punch is infinite there; allowed: 0 <= r/a < 1", text));
  return radius;
}

Question read(const Profile& profile, Quantity given, const std::string& value, const std::vector<std::string>& radii) {
  Question question{{profile.kind, read_exponent(profile), given, read_value(given, value)}, {}};
  for (const auto& radius : radii) question.radii.push_back(read_radius(profile.kind, radius));
  return question;
}

/// The load over that at which slip begins; infinite if there is no such load and it is not zero.
Ball load_over_onset(const Question& question, const Law& law) {
  const auto infinite = made_by<Ball>(arb_pos_inf);
  const Rational& value = question.value;
  if (question.quantity == Quantity::stick_ratio || question.quantity == Quantity::stick_complement) {
    const bool full = value == Rational(question.quantity == Quantity::stick_ratio ? 1 : 0);
    return full ? Ball(law.punch() ? 1 : 0) : infinite;
  }
  const Rational load = question.quantity == Quantity::moment_deficit ? Rational(1) - value : value;
  if (load == Rational(0)) return 0;
  if (!law.punch()) return infinite;
  return question.quantity == Quantity::twist ? 8 * load.ball() : load.ball() / law.onset();
}

std::optional<Stick> stick_of(const Question& question) {
  const Rational one(1);
  if (question.quantity == Quantity::stick_ratio) return Stick(question.value);
  if (question.quantity == Quantity::stick_complement) return Stick(one - question.value);
  Equation equation = question;
  if (question.quantity != Quantity::twist) {
    const bool deficit_given = question.quantity == Quantity::moment_deficit;
    const Rational deficit = deficit_given ? question.value : one - question.value;
    // Estimate of the distance to the onset of slip or to gross slip, whichever is smaller, over the distance
    // between the two.
    const bool deficit_less = deficit < (question.kind == Kind::flat_punch ? Rational(3, 40) : Rational(1, 2));
    equation.quantity = deficit_less ? Quantity::moment_deficit : Quantity::moment_ratio;
    equation.value = deficit_less ? deficit : one - deficit;
  }
  return solve(equation);
}

/// As the question puts it, to the digit.
void set_given(const Question& question, Balls& balls) {
  const Ball value = question.value.ball();
  const Ball complement = (Rational(1) - question.value).ball();
  if (question.quantity == Quantity::moment_ratio) balls.moment = {.ratio = value, .deficit = complement};
  if (question.quantity == Quantity::moment_deficit) balls.moment = {.ratio = complement, .deficit = value};
  if (question.quantity == Quantity::twist) balls.twist = value;
}

/// None if the precision is too low.
std::optional<Balls> compute(const Question& question) {
  const Law law(question.kind, question.exponent);
  const Ball load = load_over_onset(question, law);
  const bool sticks = arb_le(load.get(), Ball(1).get()) != 0;
  if (!sticks && !(load > 1)) return {};
  const auto stick = sticks ? Stick(Rational(1)) : stick_of(question);
  if (!stick) return {};

  Balls balls{.moment = {}, .stick = *stick, .twist = {}, .traction = {}};
  if (sticks) {
    const Ball ratio = load * law.onset();
    balls.moment = {.ratio = ratio, .deficit = 1 - ratio};
    balls.twist = load / 8;
  } else {
    const Ball h = twist_integral(law, *stick);
    balls.moment = moment_at(law, *stick, h);
    balls.twist = h / (2 * law.load);
  }
  set_given(question, balls);
  for (const auto& radius : question.radii) {
    const auto q = arb_is_zero(load.get()) != 0 ? Ball(0) : traction(law, *stick, radius);
    if (!q) return {};
    balls.traction.push_back(sticks ? load * *q : *q);
  }
  return balls;
}

/// None if a number cannot be printed to its last digit.
std::optional<State> print(const Question& question, const Balls& balls, int digits) {
  bool proven = true;
  const auto number = [&](const Ball& ball) {
    const auto printed = print_proven(ball, digits);
    proven = proven && printed;
    return printed.value_or(Number{});
  };
  const Ball& c = balls.stick.ratio;
  const Law law(question.kind, question.exponent);
  State state{.moment_ratio = number(balls.moment.ratio),
              .moment_deficit = number(balls.moment.deficit),
              .stick_ratio = number(c),
              .stick_complement = number(balls.stick.complement),
              .twist = number(balls.twist),
              .moment = number(balls.moment.ratio * law.moment_limit()),
              .tangent_stiffness = number(16 * c * c * c / 3),
              .traction = {}};
  for (const auto& q : balls.traction) state.traction.push_back(number(q));
  return proven ? std::optional(state) : std::nullopt;
}

}  // namespace

State state(const Profile& profile, Quantity given, const std::string& value, const std::vector<std::string>& radii,
            int digits) {
  if (digits < kMinDigits || digits > kMaxDigits)
    out_of_range("digits", std::to_string(digits), fmt::format("{}..{}", kMinDigits, kMaxDigits));
  const Question question = read(profile, given, value, radii);

  constexpr slong kMaxBits = 8000;
  for (slong bits = 10 * digits / 3 + 64; bits <= kMaxBits; bits += bits / 2) {
    const Precision precision(bits);
    if (const auto balls = compute(question))
      if (const auto printed = print(question, *balls, digits)) return *printed;
  }
  throw std::runtime_error(fmt::format("{} digits are not proven even with {} bits", digits, kMaxBits));
}

/// libslipstick_certified offers this to loaded.cpp.
extern "C" [[gnu::visibility("default")]] decltype(state)* slipstick_certified() { return &state; }

}  // namespace slipstick::analytic::certified
