#include "analytic/layered/layered_contact.hpp"

#include <gmock/gmock.h>
#include <gsl/gsl_sf_bessel.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "analytic/cycle.hpp"
#include "analytic/elliptic.hpp"
#include "analytic/layered/layered_profile.hpp"
#include "analytic/tests/values.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic::layered {
namespace {

using namespace ::testing;
using testing::integral_between_roots;

/// A layer of modulus 1 on a base, against a rigid body.
Pair on_base(double thickness, double base_modulus, double nu = 0.3) {
  return {Body{{1, nu}, Coat{thickness, {base_modulus, nu}}}, Body{{kInfinity, 0}}};
}

/// Torsion under Hertz's pressure on a radius of 1, whatever presses.
std::unique_ptr<const Profile> under_hertz_pressure(const Pair& pair) {
  const PiecewisePolynomial one([](double) { return 1; }, {0, 1}, Points::all);
  const auto excess = [&](double k) { return pair.torsional_excess(k); };
  return layered_profile({"hertz", "peak", one, 0}, {excess, pair.thickness(), 2, 1, Points::all});
}

/// The stiffness of full stick, over that on the layer's half-space.
double relative_stiffness(double thickness, double base_modulus) {
  return under_hertz_pressure(on_base(thickness, base_modulus))->bonded_stiffness(at(1)) * 3 / 16;
}

void expect_same_torsion(const Profile& profile, const Profile& expected) {
  const auto same = [](double value, double other) { EXPECT_NEAR(value / other, 1, 1e-12); };
  same(profile.moment_limit(), expected.moment_limit());
  same(profile.full_stick() + 1, expected.full_stick() + 1);
  for (const double ratio : {0.01, 0.5, 0.9, 0.999}) {
    const auto state = from_moment_ratio(ratio, profile);
    const auto other = from_moment_ratio(ratio, expected);
    same(state.twist, other.twist);
    same(state.stick_ratio, other.stick_ratio);
    same(state.tangent_stiffness, other.tangent_stiffness);
    for (const double r : {0.5, 0.95}) {
      same(traction(state, r, profile) / profile.pressure(0), traction(other, r, expected) / expected.pressure(0));
    }
    LoadingHistory history(profile);
    LoadingHistory half_space(expected);
    for (const double end : {ratio, -0.3 * ratio}) {
      history.load_to(end);
      half_space.load_to(end);
    }
    same(history.state().twist, half_space.state().twist);
    same(history.state().dissipated + 1e-3, half_space.state().dissipated + 1e-3);
  }
}

TEST(LayeredContact, OfALayerLikeItsBaseIsHertzAndLubkin) {
  expect_same_torsion(*under_hertz_pressure(on_base(0.2, 1)), hertz_profile());
  const Pair pair = on_base(0.4, 1);
  const Indentation hertz = indent_sphere(1.7, 3, pair.effective_modulus());
  const LayeredContact sphere = press(Indenter::sphere, 1.7, 3, pair);
  EXPECT_NEAR(sphere.indentation.contact_radius / hertz.contact_radius, 1, 1e-12);
  EXPECT_NEAR(sphere.indentation.approach / hertz.approach, 1, 1e-12);
  EXPECT_NEAR(sphere.profile->pressure(0.3), 1.5 * hertz_profile().pressure(0.3), 1e-12);
  expect_same_torsion(*sphere.profile, hertz_profile());
  const Indentation boussinesq = indent_flat_punch(1.7, 3, pair.effective_modulus());
  const LayeredContact punch = press(Indenter::flat_punch, 1.7, 3, pair);
  EXPECT_NEAR(punch.indentation.approach / boussinesq.approach, 1, 1e-12);
  EXPECT_NEAR(punch.profile->pressure(0.8), 0.5 * flat_punch_profile().pressure(0.8), 1e-12);
  expect_same_torsion(*punch.profile, flat_punch_profile());
}

/// The same equation by collocation, to 10 digits: reflections -1/2, 1/2 and -1 at half the radius. Far below, a rigid
/// base adds zeta(3)/(4 pi) (a/h)^3, the first term of the equation's series; the next is (a/h)^2 smaller.
TEST(LayeredTorsion, HasTheStiffnessOfBondedDiscs) {
  EXPECT_NEAR(relative_stiffness(0.5, 3), 1.1272224142, 1e-10);
  EXPECT_NEAR(relative_stiffness(0.5, 1.0 / 3), 0.8719073968, 1e-10);
  EXPECT_NEAR(relative_stiffness(0.5, kInfinity), 1.2581477238, 1e-10);
  const double leading = 1.2020569031595943 / (4 * pi);
  for (const double h : {5.0, 10.0, 40.0})
    EXPECT_NEAR((relative_stiffness(h, kInfinity) - 1) * h * h * h, leading, 0.2 / (h * h)) << h;
}

/// A thin layer on a rigid base gives way under each point by itself. It is sheared by q h/G: dM/dphi = pi G a^4/(2 h).
/// If it is compressible it is pressed together as a foundation of modulus M = 2 G (1 - nu)/(1 - 2 nu): p = M (a^2 -
/// r^2)/(2 R h), W = (pi/4) M a^4/(R h), M_lim = (8/15) mu W a. On another base it does not count.
TEST(LayeredContact, IsLocalOnAThinLayerOrThatOfTheBase) {
  std::vector<std::array<double, 6>> off;
  for (const double h : {0.04, 0.02}) {
    const auto [contact, profile, uncertainty] =
        press(Indenter::sphere, pi / 4 * (2 * 0.7 / 0.4) / h, 1, on_base(h, kInfinity));
    const Pair soft = on_base(h, 0.5, 0.5);
    const LayeredContact base = press(Indenter::sphere, 2.0 / 3 * soft.effective_modulus(), 1, soft);
    EXPECT_LE(std::max(uncertainty, base.uncertainty), 3e-10) << h;
    off.push_back({relative_stiffness(h, kInfinity) * 32 * h / (3 * pi) - 1, relative_stiffness(h, 0.5) / 0.5 - 1,
                   contact.contact_radius - 1, profile->pressure(0) / 2 - 1, profile->moment_limit() * 15 / 8 - 1,
                   std::pow(base.indentation.contact_radius, 3) - 1});
  }
  // An error of order h/a or h/a ln(h/a) halves with h/a, apart from the logarithm, a sixth here.
  for (std::size_t i = 0; i < off[0].size(); ++i) {
    EXPECT_LE(std::abs(off[1][i]), 0.15);
    EXPECT_NEAR(off[0][i] / off[1][i], 2, 0.4);
  }
}

/// With each bit of twist the stick area takes the moment of a punch bonded on it; and the loop has the area
/// that it loses, 8 integral M dphi - 4 M phi over the first loading.
TEST(LayeredTorsion, GoesOnAsABondedPunchAndLosesTheAreaOfItsLoop) {
  const auto profile = press(Indenter::sphere, 0.5, 1, on_base(0.3, 8)).profile;
  for (const double ratio : {0.2, 0.7, 0.95}) {
    const auto slope = [&](double step) {
      const auto low = from_moment_ratio(ratio - step, *profile);
      const auto high = from_moment_ratio(ratio + step, *profile);
      return (high.moment - low.moment) / (high.twist - low.twist);
    };
    const TorsionState state = from_moment_ratio(ratio, *profile);
    EXPECT_NEAR((4 * slope(5e-4) - slope(1e-3)) / 3 / state.tangent_stiffness, 1, 2e-8) << ratio;
    const double work = gsl::integral(
        [&](double w) {
          const StickRadius c{.ratio = 1 - w, .complement = w};
          return profile->moment_limit() * profile->moment_share(c).excess * profile->twist_slope(c) /
                 (2 * profile->load() * c.ratio);
        },
        0, state.stick_complement, 1e-10);
    EXPECT_NEAR(energy_lost_per_cycle(state, *profile), 8 * work - 4 * state.moment * state.twist, 1e-10);
  }
}

/// Surface displacement by a field at r, times the modulus (E*/2 or G): as half-spaces, by rings in closed
/// form, and by a Hankel transform (order 0 or 1) of the excess, which ends at k = 30 here.
double moved(const std::function<double(double)>& field, int order, double r, double front,
             const std::function<double(double)>& excess) {
  const auto bessel = [&](double x) { return order == 0 ? gsl_sf_bessel_J0(x) : gsl_sf_bessel_J1(x); };
  const auto ring = [&](double s) {
    const auto [small, large] = std::minmax(r, s);
    const CompleteElliptic elliptic =
        complete_elliptic(std::max(kEps, std::sqrt((large - small) * (large + small)) / large));
    return 2 / pi * field(s) * s * (order == 0 ? elliptic.k / large : (elliptic.k - elliptic.e) / small);
  };
  double sum = 0;
  const std::vector<double> ends{0, std::min(r, front), std::max(r, front), 1};
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (ends[i - 1] < ends[i]) sum += integral_between_roots(ring, ends[i - 1], ends[i]);
  const gsl::GaussRule rule(64);
  const auto transform = [&](double k) {
    const auto part = [&](double low, double high) {
      return rule(
          [&](double angle) {
            const double s = low + (high - low) * std::pow(std::sin(angle), 2);
            return field(s) * s * bessel(k * s) * (high - low) * std::sin(2 * angle);
          },
          0, pi / 2);
    };
    return part(0, front) + part(front, 1);
  };
  return sum + rule([&](double k) { return excess(k) * transform(k) * bessel(k * r); }, 0, 30);
}

/// The fields themselves, put on the bodies in another way: within the stick radius the surface turns as one,
/// beyond it lags behind, and under the sphere it takes its shape.
TEST(LayeredContact, LaysTheSurfacesOnEachOther) {
  const Pair pair = on_base(0.4, 6);
  const auto [contact, profile, uncertainty] = press(Indenter::sphere, 0.3, 1, pair);
  const double a = contact.contact_radius;
  const auto pressure = [&, &p = *profile](double s) { return p.pressure(s); };
  for (const double r : {0.1, 0.5, 0.9}) {
    const double depth = moved(pressure, 0, r, 0.5, [&](double k) { return pair.normal_excess(k / a); });
    EXPECT_NEAR(
        depth * 2 / pair.effective_modulus() * contact.reference_pressure * a / (contact.approach - a * a * r * r / 2),
        1, 1e-9);
  }
  const TorsionState state = from_moment_ratio(0.8, *profile);
  const auto turned = [&, &p = *profile](double r) {
    return moved([&](double s) { return traction(state, s, p); }, 1, r, state.stick_ratio,
                 [&](double k) { return pair.torsional_excess(k / a); }) /
           (p.load() * r);
  };
  for (const double part : {0.1, 0.6, 0.95})
    EXPECT_NEAR(turned(part * state.stick_ratio) / state.twist, 1, 1e-9) << part;
  for (const double r : {0.8, 0.95}) EXPECT_LT(turned(r), state.twist) << r;
}

TEST(LayeredContact, RefusesWhatIsNoSuchContact) {
  const Pair pair = on_base(0.5, 2);
  for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_THROW(press(Indenter::sphere, bad, 1, pair), std::domain_error);
    EXPECT_THROW(press(Indenter::sphere, 1, bad, pair), std::domain_error);
    EXPECT_THROW(press(Indenter::flat_punch, bad, 1, pair), std::domain_error);
  }
  const auto pressed_flat = [](double h, double base) {
    return [=] { press(Indenter::flat_punch, 1, 1, on_base(h, base)); };
  };
  // A plate on a soft base bends away from a flat punch.
  EXPECT_THAT(pressed_flat(1, 1e-3), ThrowsMessage<std::domain_error>(HasSubstr("surfaces part")));
  EXPECT_THAT(pressed_flat(0.1, 0.1), ThrowsMessage<std::domain_error>(HasSubstr("slip begins inside")));
  EXPECT_THAT(pressed_flat(1e-3, 2), ThrowsMessage<std::domain_error>(HasSubstr("thickness")));
  EXPECT_THROW(press(Indenter::sphere, 1e9, 1, pair), std::domain_error);
}

TEST(LayeredPair, RefusesWhatIsNoCoatedPair) {
  const Body coated{{1, 0.3}, Coat{1, {2, 0.3}}};
  EXPECT_THROW(Pair(Body{{1, 0.3}}, Body{{1, 0.3}}), std::domain_error);
  EXPECT_THROW(Pair(Body{{kInfinity, 0.3}, Coat{1, {2, 0.3}}}, coated), std::domain_error);
  for (const double bad : {0.0, -1.0, kNan}) {
    EXPECT_THROW(Pair(Body{{bad, 0.3}}, coated), std::domain_error);
    EXPECT_THROW(Pair(Body{{1, 0.3}, Coat{bad, {2, 0.3}}}, coated), std::domain_error);
    EXPECT_THROW(Pair(Body{{1, 0.3}, Coat{1, {bad, 0.3}}}, coated), std::domain_error);
    EXPECT_THROW(Pair(Body{{1, bad - 1}}, coated), std::domain_error);
  }
}

}  // namespace
}  // namespace slipstick::analytic::layered
