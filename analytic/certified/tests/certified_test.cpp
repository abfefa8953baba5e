#include <utility>

#include "analytic/certified/tests/known.hpp"
#include "analytic/references/references.hpp"

namespace slipstick::analytic::certified {
namespace {

using namespace known;

TEST(Certified, HasTheTwistAndMomentOfItsPressure) {
  const Precision precision(200);
  for (const Profile& profile :
       {kHertz, kCone, kFlatPunch, kConstant, power("4"), power("1.5"), power("0.5"), power("8")})
    for (const std::string c : {"1e-3", "0.3", "0.49", "0.51", "0.9"}) {
      const Integrals known = from_pressure(profile, exact(c));
      const State found = at_stick_ratio(profile, c);
      EXPECT_TRUE(agree(found.twist, known.twist / (2 * load(profile)))) << profile.exponent << ", c = " << c;
      EXPECT_TRUE(agree(found.moment, known.moment / load(profile))) << profile.exponent << ", c = " << c;
    }
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
  EXPECT_TRUE(overlap(limit(kConstant), Ball(2) / 3));
  EXPECT_TRUE(overlap(limit(power("1.5")), pi() * 25 / 140));  // pi (n + 1)/(4 (n + 2))
}

TEST(Certified, HasTheTangentStiffnessOfItsStickArea) {
  const Precision precision(kBits);
  for (const Profile& profile : {kHertz, kCone, kFlatPunch, power("3")})
    EXPECT_TRUE(agree(at_stick_ratio(profile, "0.3").tangent_stiffness, 16 * exact("0.027") / 3));
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

/// From one quantity to another and back: the result encloses the starting value.
TEST(Certified, GoesRoundBetweenAllQuantities) {
  const Precision precision(kBits);
  for (const Profile& profile : {kHertz, kCone, kFlatPunch, kConstant, power("1.5")})
    for (const std::string c : {"1e-12", "0.3", "0.8", "0.99999999"}) {
      const State start = at_stick_ratio(profile, c, {}, 60);
      for (const auto& [name, quantity] : kQuantities) {
        const State back = state(profile, quantity, (start.*kMember.at(name)).value, {}, 15);
        EXPECT_TRUE(abs(enclosure(back.stick_ratio) / exact(c) - 1) < exact("1e-14"))
            << name << ", c = " << c;
        EXPECT_TRUE(abs(enclosure(back.stick_complement) / (1 - exact(c)) - 1) < exact("1e-14"))
            << name << ", c = " << c;
      }
    }
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
    EXPECT_TRUE(agree(q(kConstant), 1)) << c;
    EXPECT_TRUE(agree(q(power("4")), v * (v * v / 3 + r * r))) << c;
  }
  for (const Profile& profile : {kHertz, kCone, power("0.5")})
    EXPECT_EQ(at_stick_ratio(profile, "0.6", {"1"}).traction[0].value, "0");
}

TEST(CertifiedTraction, IsContinuousAtTheFront) {
  const Precision precision(kBits);
  for (const Profile& profile : {kHertz, kCone, kFlatPunch, kConstant, power("1.5")}) {
    const State found = at_stick_ratio(profile, "0.5", {"0.4999999999999999999999999999999999999999", "0.5"});
    // It falls off inside like the root of the distance, 1e-40.
    const Ball drop = enclosure(found.traction[1]) - enclosure(found.traction[0]);
    EXPECT_TRUE(drop > 0 && drop < exact("1e-19"));
  }
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
