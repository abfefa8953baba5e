#include "analytic/certified/certified.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "analytic/certified/ball_text.hpp"
#include "analytic/certified/reference_rows.hpp"
#include "analytic/tests/references.hpp"

#if __has_include(<flint/acb_elliptic.h>)
#include <flint/acb_elliptic.h>
#include <flint/arb_hypgeom.h>
#else
#include <acb_elliptic.h>
#include <arb_hypgeom.h>
#endif

namespace slipstick::analytic::certified {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr slong kBits = 300;

const Profile kHertz{Kind::hertz};
const Profile kCone{Kind::cone};
const Profile kFlatPunch{Kind::flat_punch};
Profile power(const std::string& exponent) { return {Kind::power, exponent}; }

const std::map<std::string, Quantity> kQuantity{{"moment_ratio", Quantity::moment_ratio},
                                                {"moment_deficit", Quantity::moment_deficit},
                                                {"stick_ratio", Quantity::stick_ratio},
                                                {"stick_complement", Quantity::stick_complement},
                                                {"twist", Quantity::twist}};

const std::map<std::string, Number State::*> kMember{{"moment_ratio", &State::moment_ratio},
                                                     {"moment_deficit", &State::moment_deficit},
                                                     {"stick_ratio", &State::stick_ratio},
                                                     {"stick_complement", &State::stick_complement},
                                                     {"twist", &State::twist},
                                                     {"moment", &State::moment},
                                                     {"tangent_stiffness", &State::tangent_stiffness}};

Ball exact(const std::string& text) { return read_exactly("text", text).ball(); }

/// All that a number allows for.
Ball enclosure(const Number& number) { return exact(number.value) + exact(number.radius).symmetric(); }

bool overlap(const Ball& a, const Ball& b) { return a.finite() && b.finite() && !(a < b) && !(a > b); }

/// Whether two enclosures meet, of which the second is good to this part of itself.
::testing::AssertionResult agree(const Number& number, const Ball& known,
                                 const std::string& within = "1e-38") {
  const Precision precision(kBits);
  const Ball ball = enclosure(number);
  if (!overlap(ball, known))
    return ::testing::AssertionFailure() << number.value << " is not the known value";
  if (!(upper_bound(known) - lower_bound(known) < exact(within) * abs(known)))
    return ::testing::AssertionFailure() << number.value << ": the known value is too vague";
  return ::testing::AssertionSuccess();
}

State at_stick_ratio(const Profile& profile, const std::string& c, const std::vector<std::string>& radii = {},
                     int digits = 40) {
  return state(profile, Quantity::stick_ratio, c, radii, digits);
}

// What is known is computed here in other ways than in the code: pressures in place of superposed punches,
// Arb's elliptic integrals in place of means, other variables of integration.

ComplexBall elliptic(void (*f)(acb_t, const acb_t, slong), const ComplexBall& parameter, bool analytic) {
  if (analytic && (1 - parameter).touches_cut()) return ComplexBall::indeterminate();
  ComplexBall result;
  f(result.get(), parameter.get(), Precision::bits());
  return result;
}

/// Of modulus sqrt(1 - s^2).
ComplexBall k_of(const ComplexBall& s, bool analytic = false) {
  return elliptic(acb_elliptic_k, 1 - s * s, analytic);
}
ComplexBall e_of(const ComplexBall& s, bool analytic = false) {
  return elliptic(acb_elliptic_e, 1 - s * s, analytic);
}

/// -s H'(s) of the sphere and the cone.
ComplexBall fall(Kind kind, const ComplexBall& s, bool analytic) {
  return kind == Kind::hertz ? e_of(s, analytic) : k_of(s, analytic);
}

Ball load(const Profile& profile) {
  if (profile.kind == Kind::hertz) return 2 * pi() / 3;
  if (profile.kind == Kind::cone) return pi();
  if (profile.kind == Kind::flat_punch) return 2 * pi();
  return 2 * pi() / (exact(profile.exponent) + 1);
}

/// p cos(theta), where v = k cos(theta) is the height over the pressure's rim.
ComplexBall pressure_by_cosine(const Profile& profile, const ComplexBall& v, const ComplexBall& k,
                               const ComplexBall& cosine) {
  if (profile.kind == Kind::flat_punch) return 1 / k;
  if (profile.kind == Kind::hertz) return v * cosine;
  if (profile.kind == Kind::cone) return cosine * (log(1 + v) - log(1 - v)) / 2;
  return v * cosine * hypergeometric(1 - exact(profile.exponent) / 2, 1, Ball(3) / 2, v * v);
}

struct Integrals {
  Ball twist;   ///< H
  Ball moment;  ///< M/(mu p0 a^3)
};

/// Both from the pressure: with rho^2 = c^2 + k^2 sin^2 theta and x = k sin theta,
/// H = integral p k cos/rho,  M = 8 integral p k cos/rho (c^3/3 + x rho^2/2 atan(x/c) + c x^2/2).
Integrals from_pressure(const Profile& profile, const Ball& c) {
  const Ball k = sqrt(1 - c * c);
  const auto integrate = [&](bool moment) {
    const auto integrand = [&](const ComplexBall& theta, bool analytic) {
      const ComplexBall x = k * sin(theta);
      const ComplexBall v = k * cos(theta);
      const ComplexBall rho2 = c * c + x * x;
      // All cuts are here: rho is imaginary where x/c is beyond +-i, and where v is beyond +-1.
      if (analytic && (rho2.touches_cut() || (1 + v).touches_cut() || (1 - v).touches_cut()))
        return ComplexBall::indeterminate();
      ComplexBall weight = pressure_by_cosine(profile, v, k, cos(theta)) * k / sqrt(rho2);
      if (!moment) return weight;
      return weight * (c * c * c / 3 + x * rho2 / 2 * atan(x / c) + c * x * x / 2);
    };
    return integral(integrand, 0, pi() / 2);
  };
  return {.twist = integrate(false), .moment = 8 * integrate(true)};
}

/// M/(mu p0 a^3) from the twist: 8/3 integral_c^1 s^2 e ds.
Ball moment_from_twist(Kind kind, const Ball& c) {
  const auto integrand = [&](const ComplexBall& s, bool analytic) { return s * s * fall(kind, s, analytic); };
  return 8 * integral(integrand, c, 1) / 3;
}

/// q/(mu p0) inside the stick radius: 2/pi r integral_c^1 e/(s sqrt(s^2 - r^2)) ds.
Ball traction_from_twist(Kind kind, const Ball& c, const Ball& r) {
  const auto integrand = [&](const ComplexBall& s, bool analytic) {
    const ComplexBall root2 = s * s - r * r;
    if (analytic && root2.touches_cut()) return ComplexBall::indeterminate();
    return fall(kind, s, analytic) / (s * sqrt(root2));
  };
  return 2 / pi() * r * integral(integrand, c, 1);
}

// ---------------------------------------------------------------------------------------------------------------

TEST(Certified, HasTheKnownStickRatios) {
  const std::vector<std::pair<std::string, std::string>> known{{"0.1", "0.9693964204953627"},
                                                               {"0.5", "0.8135681261276496"},
                                                               {"0.9", "0.4958950522157781"},
                                                               {"0.99", "0.2369661925296642"}};
  const Precision precision(kBits);
  for (const auto& [m, c] : known) {
    const State found = state(kHertz, Quantity::moment_ratio, m, {}, 30);
    EXPECT_TRUE(abs(enclosure(found.stick_ratio) - exact(c)) < exact("3e-16")) << m;
  }
}

TEST(Certified, HasTheSpheresTwist) {
  const Precision precision(kBits);
  for (const std::string c : {"0x1p-1", "0.01", "0.9"}) {
    const Ball known = 3 / (4 * pi()) * (k_of(exact(c)) - e_of(exact(c))).real();
    EXPECT_TRUE(agree(at_stick_ratio(kHertz, c, {}, 60).twist, known, "1e-60")) << c;
  }
}

TEST(Certified, HasTheFlatPunchsTwist) {
  const Precision precision(kBits);
  for (const std::string c : {"0.5", "0.01", "0.9"})
    EXPECT_TRUE(
        agree(at_stick_ratio(kFlatPunch, c, {}, 60).twist, k_of(exact(c)).real() / (4 * pi()), "1e-60"))
        << c;
}

TEST(Certified, HasTheConesTwist) {
  const Precision precision(kBits);
  for (const std::string c : {"0.5", "0.01", "0.9"}) {
    const auto slope = [](const ComplexBall& s, bool analytic) { return k_of(s, analytic) / s; };
    EXPECT_TRUE(agree(at_stick_ratio(kCone, c).twist, integral(slope, exact(c), 1) / (2 * pi()))) << c;
  }
}

TEST(Certified, HasTheTwistAndMomentOfItsPressure) {
  const Precision precision(200);
  for (const Profile& profile :
       {kHertz, kCone, kFlatPunch, power("4"), power("1.5"), power("0.5"), power("8")})
    for (const std::string c : {"1e-3", "0.3", "0.49", "0.51", "0.9"}) {
      const Integrals known = from_pressure(profile, exact(c));
      const State found = at_stick_ratio(profile, c);
      EXPECT_TRUE(agree(found.twist, known.twist / (2 * load(profile)))) << profile.exponent << ", c = " << c;
      EXPECT_TRUE(agree(found.moment, known.moment / load(profile))) << profile.exponent << ", c = " << c;
    }
}

TEST(Certified, HasTheMomentOfItsTwist) {
  const Precision precision(200);
  for (const Profile& profile : {kHertz, kCone})
    for (const std::string c : {"0.1", "0.3", "0.49", "0.51", "0.9"})
      EXPECT_TRUE(
          agree(at_stick_ratio(profile, c).moment, moment_from_twist(profile.kind, exact(c)) / load(profile)))
          << c;
}

TEST(Certified, HasTheLimitMoments) {
  const Precision precision(kBits);
  const auto limit = [&](const Profile& profile) {
    const State found = at_stick_ratio(profile, "0.3");
    return enclosure(found.moment) / enclosure(found.moment_ratio);
  };
  EXPECT_TRUE(overlap(limit(kHertz), 3 * pi() / 16));
  EXPECT_TRUE(overlap(limit(kCone), pi() / 6));
  EXPECT_TRUE(overlap(limit(kFlatPunch), pi() / 4));
  EXPECT_TRUE(overlap(limit(power("1.5")), pi() * 25 / 140));  // pi (n + 1)/(4 (n + 2))
}

TEST(Certified, HasTheTangentStiffnessOfItsStickArea) {
  const Precision precision(kBits);
  for (const Profile& profile : {kHertz, kCone, kFlatPunch, power("3")})
    EXPECT_TRUE(agree(at_stick_ratio(profile, "0.3").tangent_stiffness, 16 * exact("0.027") / 3));
}

TEST(Certified, KnowsASphereAndAConeAsPowerLaws) {
  const Precision precision(kBits);
  const std::vector<std::string> radii{"0.1", "0.4", "0.95"};
  for (const auto& [law, same] : {std::pair(power("2"), kHertz), std::pair(power("1.0"), kCone)}) {
    const State a = state(law, Quantity::moment_ratio, "0.7", radii, 50);
    const State b = state(same, Quantity::moment_ratio, "0.7", radii, 50);
    for (const auto& [name, member] : kMember)
      EXPECT_TRUE(overlap(enclosure(a.*member), enclosure(b.*member))) << name;
    for (std::size_t i = 0; i < radii.size(); ++i)
      EXPECT_TRUE(overlap(enclosure(a.traction[i]), enclosure(b.traction[i]))) << radii[i];
  }
}

TEST(Certified, FollowsTheAsymptotesAtBothEnds) {
  const Precision precision(500);
  for (const std::string w : {"1e-10", "1e-30", "1e-90"}) {
    const State found = state(kHertz, Quantity::stick_complement, w, {}, 100);
    const Ball leading = 32 * exact(w) / (3 * pi());
    EXPECT_TRUE(abs(enclosure(found.moment_ratio) / leading - 1) < 2 * exact(w)) << w;
    EXPECT_TRUE(abs(enclosure(found.twist) / (3 * exact(w) / 8) - 1) < 2 * exact(w)) << w;
  }
  for (const std::string c : {"1e-6", "1e-12", "1e-30"}) {
    const State found = state(kHertz, Quantity::stick_ratio, c, {}, 100);
    const Ball c1 = exact(c);
    const Ball next = c1 * c1 * log(4 / c1);
    EXPECT_TRUE(abs(enclosure(found.moment_deficit) / (64 * c1 * c1 * c1 / (9 * pi() * pi())) - 1) < next)
        << c;
    EXPECT_TRUE(abs(enclosure(found.twist) / (3 / (4 * pi()) * (log(4 / c1) - 1)) - 1) < next) << c;
  }
}

/// Forth by one quantity and back by any other: the way back holds what one started from between the ends of
/// what it was given.
TEST(Certified, GoesRoundBetweenAllQuantities) {
  const Precision precision(kBits);
  for (const Profile& profile : {kHertz, kCone, kFlatPunch, power("1.5")})
    for (const std::string c : {"1e-12", "0.3", "0.8", "0.99999999"}) {
      const State start = at_stick_ratio(profile, c, {}, 60);
      for (const auto& [name, quantity] : kQuantity) {
        const State back = state(profile, quantity, (start.*kMember.at(name)).value, {}, 15);
        EXPECT_TRUE(abs(enclosure(back.stick_ratio) / exact(c) - 1) < exact("1e-14"))
            << name << ", c = " << c;
        EXPECT_TRUE(abs(enclosure(back.stick_complement) / (1 - exact(c)) - 1) < exact("1e-14"))
            << name << ", c = " << c;
      }
    }
}

TEST(Certified, EnclosesTheRootBetweenItsEnds) {
  const Precision precision(kBits);
  const Ball m = exact("0.3");
  const Ball c = enclosure(state(kHertz, Quantity::moment_ratio, "0.3", {}, 30).stick_ratio);
  const auto moment_at = [](const Ball& end) {
    return enclosure(at_stick_ratio(kHertz, print_proven(end, 80)->value, {}, 80).moment_ratio);
  };
  EXPECT_TRUE(moment_at(upper_bound(c)) < m);
  EXPECT_TRUE(moment_at(lower_bound(c)) > m);
}

TEST(Certified, SticksEverywhereAtNoLoad) {
  for (const Profile& profile : {kHertz, kCone, power("3")})
    for (const auto& [quantity, value] : {std::pair(Quantity::moment_ratio, "0"),
                                          {Quantity::moment_deficit, "1"},
                                          {Quantity::stick_ratio, "1"},
                                          {Quantity::stick_complement, "0e5"},
                                          {Quantity::twist, "0.0"}}) {
      const State found = state(profile, quantity, value, {"0", "0.5", "1"}, 20);
      for (const std::string zero : {"moment_ratio", "stick_complement", "twist", "moment"})
        EXPECT_EQ((found.*kMember.at(zero)).value, "0") << zero;
      EXPECT_EQ(found.moment_deficit.value, "1");
      EXPECT_EQ(found.stick_ratio.value, "1");
      EXPECT_EQ(found.stick_ratio.radius, "0");
      EXPECT_EQ(found.tangent_stiffness.value, "5.3333333333333333333");
      for (const Number& q : found.traction) EXPECT_EQ(q.value, "0");
    }
}

TEST(CertifiedFlatPunch, SticksEverywhereUpToItsOnset) {
  const Precision precision(kBits);
  const Ball onset = 8 / (3 * pi());
  for (const auto& found : {state(kFlatPunch, Quantity::stick_ratio, "1", {"0.6"}, 40),
                            state(kFlatPunch, Quantity::stick_complement, "0", {"0.6"}, 40),
                            state(kFlatPunch, Quantity::twist, "0.125", {"0.6"}, 40)}) {
    EXPECT_TRUE(agree(found.moment_ratio, onset));
    EXPECT_EQ(found.stick_ratio.value, "1");
    EXPECT_EQ(found.stick_complement.value, "0");
    EXPECT_TRUE(agree(found.twist, Ball(1) / 8));
    EXPECT_TRUE(agree(found.traction[0], Ball(3) / 4));
  }
  const State half = state(kFlatPunch, Quantity::moment_ratio, "0.4", {"0", "0.8"}, 40);
  EXPECT_EQ(half.stick_ratio.value, "1");
  EXPECT_TRUE(agree(half.twist, exact("0.4") * 3 * pi() / 64));  // 3/16 M/(mu W a)
  EXPECT_EQ(half.traction[0].value, "0");
  EXPECT_TRUE(agree(half.traction[1], exact("0.4") / onset * 4 / 3));
}

TEST(CertifiedFlatPunch, TellsBothSidesOfItsOnset) {
  // 8/(3 pi) to 60 digits, cut off and one up.
  const std::string below = "0.848826363156775124100713404653409930850451443949101059987559";
  const std::string above = "0.848826363156775124100713404653409930850451443949101059987560";
  const Precision precision(kBits);
  ASSERT_TRUE(exact(below) < 8 / (3 * pi()) && exact(above) > 8 / (3 * pi()));
  EXPECT_EQ(state(kFlatPunch, Quantity::moment_ratio, below, {}, 20).stick_complement.value, "0");
  const Ball slipped = enclosure(state(kFlatPunch, Quantity::moment_ratio, above, {}, 20).stick_complement);
  // M/M_lim grows from there by 4/(3 pi) a complement.
  EXPECT_TRUE(abs(slipped / ((exact(above) - 8 / (3 * pi())) * 3 * pi() / 4) - 1) < exact("1e-15"));
  EXPECT_EQ(state(kFlatPunch, Quantity::twist, "0.1249999999999999999999999999", {}, 20).stick_ratio.value,
            "1");
  EXPECT_NE(state(kFlatPunch, Quantity::twist, "0.1250000000000000000000000001", {}, 40).stick_ratio.value,
            "1");
}

TEST(CertifiedTraction, IsThatOfTheSuperposedTwists) {
  const Precision precision(200);
  for (const Profile& profile : {kHertz, kCone})
    for (const auto& [c, r] :
         {std::pair("0.5", "0.3"), {"0.5", "0.499"}, {"0.01", "0.005"}, {"0.9", "1e-6"}, {"0.9", "0.89"}})
      EXPECT_TRUE(agree(at_stick_ratio(profile, c, {r}).traction[0],
                        traction_from_twist(profile.kind, exact(c), exact(r))))
          << c << ", " << r;
}

TEST(CertifiedTraction, IsCoulombsBeyondTheFront) {
  const Precision precision(kBits);
  const Ball r = exact("0.6");
  const Ball v = exact("0.8");
  for (const std::string c : {"0.6", "0.2"}) {
    const auto q = [&](const Profile& profile) { return at_stick_ratio(profile, c, {"0.6"}).traction[0]; };
    EXPECT_TRUE(agree(q(kHertz), v)) << c;
    EXPECT_TRUE(agree(q(kCone), log(Ball(3)))) << c;  // arcosh(1/0.6)
    EXPECT_TRUE(agree(q(kFlatPunch), 1 / v)) << c;
    EXPECT_TRUE(agree(q(power("4")), v * (v * v / 3 + r * r))) << c;
  }
  for (const Profile& profile : {kHertz, kCone, power("0.5")})
    EXPECT_EQ(at_stick_ratio(profile, "0.6", {"1"}).traction[0].value, "0");
}

TEST(CertifiedTraction, IsContinuousAtTheFront) {
  const Precision precision(kBits);
  for (const Profile& profile : {kHertz, kCone, kFlatPunch, power("1.5")}) {
    const State found = at_stick_ratio(profile, "0.5", {"0.4999999999999999999999999999999999999999", "0.5"});
    // It falls off inside like the root of the distance, 1e-40.
    const Ball drop = enclosure(found.traction[1]) - enclosure(found.traction[0]);
    EXPECT_TRUE(drop > 0 && drop < exact("1e-19"));
  }
}

/// M = 2 pi integral q r^2 dr by Gauss and Legendre's rule on either side of the front, where the sine of an
/// angle makes both ends smooth.
TEST(CertifiedTraction, HasTheMomentOfTheState) {
  const Precision precision(150);
  constexpr int kNodes = 40;
  std::vector<std::string> radii;
  std::vector<Ball> weights;
  const Ball front = exact("0.6");
  const auto add = [&](const Ball& from, const Ball& to, const Ball& scale) {
    for (int i = 0; i < kNodes; ++i) {
      Ball node;
      Ball weight;
      arb_hypgeom_legendre_p_ui_root(node.get(), weight.get(), kNodes, static_cast<ulong>(i),
                                     Precision::bits());
      const Ball angle = (from + to) / 2 + node * (to - from) / 2;
      const Ball r = scale * sin(ComplexBall(angle)).real();
      radii.push_back(print_proven(r, 30)->value);
      weights.push_back(weight * (to - from) / 2 * r * r * scale * cos(angle));
    }
  };
  const Ball at_front = atan(ComplexBall(front / sqrt(1 - front * front))).real();
  add(0, pi() / 2, front);
  add(at_front, pi() / 2, 1);
  for (const Profile& profile : {kHertz, kCone, kFlatPunch, power("1.5"), power("4")}) {
    const State found = at_stick_ratio(profile, "0.6", radii, 25);
    Ball sum;
    for (std::size_t i = 0; i < radii.size(); ++i) sum = sum + weights[i] * enclosure(found.traction[i]);
    EXPECT_TRUE(abs(2 * pi() * sum / load(profile) / enclosure(found.moment) - 1) < exact("1e-18"))
        << profile.exponent;
  }
}

// ---------------------------------------------------------------------------------------------------------------

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

/// Its digits as many as asked for, its radius within 0.51 of the last.
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

// ---------------------------------------------------------------------------------------------------------------

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
    const Quantity given = kQuantity.at(row.text("given"));
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
