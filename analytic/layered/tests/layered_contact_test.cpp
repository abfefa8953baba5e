#include "analytic/layered/layered_contact.hpp"

#include <gmock/gmock.h>
#include <gsl/gsl_sf_bessel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "analytic/cycle.hpp"
#include "analytic/elliptic.hpp"
#include "analytic/gsl.hpp"
#include "analytic/tests/values.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic::layered {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A layer of modulus 1 on a base, against a rigid body.
Pair on_base(double thickness, double base_modulus, double nu = 0.3) {
  return {Body{{1, nu}, Coat{thickness, {base_modulus, nu}}}, Body{{kInfinity, 0}}};
}

double full_stiffness(const Profile& profile) { return profile.bonded_stiffness(at(1)); }

void expect_same_torsion(const Profile& profile, const Profile& expected) {
  constexpr double kTolerance = 1e-12;
  EXPECT_NEAR(profile.moment_limit() / expected.moment_limit(), 1, kTolerance);
  EXPECT_NEAR(profile.full_stick(), expected.full_stick(), kTolerance);
  for (const double ratio : {0.01, 0.5, 0.9, 0.9999}) {
    const auto state = from_moment_ratio(ratio, profile);
    const auto other = from_moment_ratio(ratio, expected);
    EXPECT_NEAR(state.twist / other.twist, 1, kTolerance) << ratio;
    EXPECT_NEAR(state.stick_ratio / other.stick_ratio, 1, kTolerance) << ratio;
    EXPECT_NEAR(state.tangent_stiffness / other.tangent_stiffness, 1, kTolerance) << ratio;
    LoadingHistory history(profile);
    LoadingHistory half_space(expected);
    for (const double end : {ratio, -0.3 * ratio}) {
      history.load_to(end);
      half_space.load_to(end);
    }
    EXPECT_NEAR(history.state().twist / half_space.state().twist, 1, kTolerance) << ratio;
    EXPECT_NEAR(history.state().dissipated, half_space.state().dissipated,
                kTolerance * (1 + half_space.state().dissipated))
        << ratio;
  }
}

TEST(LayeredContact, OfALayerLikeItsBaseIsHertzAndLubkin) {
  expect_same_torsion(*under_hertz_pressure(2, on_base(0.4, 1)), hertz_profile());
  const Pair pair = on_base(0.4, 1);
  const double load = 1.7;
  const double radius = 3;
  const Indentation hertz = indent_sphere(load, radius, pair.effective_modulus());
  const LayeredContact sphere = press_sphere(load, radius, pair);
  EXPECT_NEAR(sphere.indentation.contact_radius / hertz.contact_radius, 1, 1e-12);
  EXPECT_NEAR(sphere.indentation.approach / hertz.approach, 1, 1e-12);
  for (const double r : {0.0, 0.3, 0.99})
    EXPECT_NEAR(sphere.profile->pressure(r), 1.5 * hertz_profile().pressure(r), 1e-12);
  expect_same_torsion(*sphere.profile, hertz_profile());
  const LayeredContact punch = press_flat_punch(load, radius, pair);
  EXPECT_NEAR(punch.indentation.approach / indent_flat_punch(load, radius, pair.effective_modulus()).approach,
              1, 1e-12);
  EXPECT_NEAR(punch.profile->pressure(0.8), 0.5 * flat_punch_profile().pressure(0.8), 1e-12);
  expect_same_torsion(*punch.profile, flat_punch_profile());
}

/// Collocation of the same equation to 10 digits, by another program: bonded discs on a layer of half their
/// radius with reflection -1/2, 1/2 and -1.
TEST(LayeredTorsion, HasTheStiffnessOfBondedDiscs) {
  for (const auto& [base, stiffness] :
       {std::pair(3.0, 1.1272224142), std::pair(1.0 / 3, 0.8719073968), std::pair(kInfinity, 1.2581477238)}) {
    const auto profile = under_hertz_pressure(1, on_base(0.5, base));
    EXPECT_NEAR(full_stiffness(*profile) * 3 / 16, stiffness, 1e-10);
  }
}

/// Far below, a rigid base adds (zeta(3)/(4 pi)) (a/h)^3, the first term of the equation's series; the next
/// is (a/h)^2 smaller.
TEST(LayeredTorsion, OnAThickLayerIsStiffenedByTheCubeOfItsThickness) {
  const double leading = 1.2020569031595943 / (4 * pi);
  for (const double h : {5.0, 10.0, 40.0}) {
    const double stiffness = full_stiffness(*under_hertz_pressure(1, on_base(h, kInfinity)));
    EXPECT_NEAR((stiffness * 3 / 16 - 1) * h * h * h, leading, 0.2 / (h * h)) << h;
  }
}

/// A thin layer on a rigid base shears under each point by itself, u = q h/G: dM/dphi = pi G a^4/(2 h). One
/// on a soft base does not count. Either is off by the thickness over the radius.
TEST(LayeredTorsion, OnAThinLayerIsShearedLocallyOrIsThatOfTheBase) {
  std::vector<double> rigid;
  std::vector<double> soft;
  for (const double h : {0.08, 0.04, 0.02}) {
    rigid.push_back(full_stiffness(*under_hertz_pressure(1, on_base(h, kInfinity))) * 2 * h / pi - 1);
    soft.push_back(full_stiffness(*under_hertz_pressure(1, on_base(h, 0.5))) * 3 / 16 / 0.5 - 1);
  }
  for (const auto& off : {rigid, soft}) {
    EXPECT_LE(std::abs(off[2]), 0.15);
    for (std::size_t i = 1; i < off.size(); ++i) EXPECT_NEAR(off[i - 1] / off[i], 2, 0.4) << i;
  }
}

/// A thin compressible layer on a rigid base is a foundation of modulus M = 2 G (1 - nu)/(1 - 2 nu): p = M
/// (a^2 - r^2)/(2 R h), W = (pi/4) M a^4/(R h), M_lim = (8/15) mu W a; all off by the thickness over the
/// radius.
TEST(LayeredContact, OnAThinLayerIsAnElasticFoundation) {
  std::vector<std::array<double, 3>> off;
  for (const double h : {0.04, 0.02, 0.01}) {
    const double modulus = 2 * 0.7 / 0.4;
    const LayeredContact contact = press_sphere(pi / 4 * modulus / h, 1, on_base(h, kInfinity));
    off.push_back({std::pow(contact.indentation.contact_radius, 4) - 1, contact.profile->pressure(0) / 2 - 1,
                   contact.profile->moment_limit() * 15 / 8 - 1});
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LE(std::abs(off[2][i]), 0.05) << i;
    EXPECT_NEAR(off[1][i] / off[2][i], 2, 0.2) << i;
  }
}

/// Once the layer is thin on a softer base, the base alone carries the sphere; a thick layer hides its base.
TEST(LayeredContact, IsHertzianOnThickAndThinLayers) {
  const auto modulus_of = [](double base, double h) {
    const Pair pair = on_base(h, base);
    const double a = press_sphere(4.0 / 3 * pair.effective_modulus(), 1, pair).indentation.contact_radius;
    return 1 / (a * a * a);
  };
  for (const double h : {0.04, 0.02}) EXPECT_NEAR(modulus_of(0.25, h), 0.25, 2 * h) << h;
  for (const double h : {30.0, 1000.0}) EXPECT_NEAR(modulus_of(0.25, h), 1, 0.5 / (h * h)) << h;
}

/// With each bit of twist the stick area takes the moment of a punch bonded on it.
TEST(LayeredTorsion, GoesOnAsABondedPunchOfTheStickRadius) {
  constexpr double kStep = 1e-3;
  const auto profile = press_sphere(0.5, 1, on_base(0.3, 8)).profile;
  for (const double ratio : {0.2, 0.7, 0.95}) {
    const auto moment_at = [&](double change) { return from_moment_ratio(ratio + change, *profile); };
    const auto slope = [&](double step) {
      const auto low = moment_at(-step);
      const auto high = moment_at(step);
      return (high.moment - low.moment) / (high.twist - low.twist);
    };
    const double extrapolated = (4 * slope(kStep / 2) - slope(kStep)) / 3;
    EXPECT_NEAR(extrapolated / moment_at(0).tangent_stiffness, 1, 2e-8) << ratio;
  }
}

/// What a field moves the surface by at r, times the modulus (E*/2 or G): as half-spaces, by rings in closed
/// form, and by a Hankel transform (order 0 or 1) of the excess, which ends at k = 30 here.
double moved(const std::function<double(double)>& field, int order, double r, double front,
             const std::function<double(double)>& excess) {
  const auto bessel = [&](double x) { return order == 0 ? gsl_sf_bessel_J0(x) : gsl_sf_bessel_J1(x); };
  const auto ring = [&](double s) {
    const double small = std::min(r, s);
    const double large = std::max(r, s);
    const CompleteElliptic elliptic =
        complete_elliptic(std::max(kEps, std::sqrt((large - small) * (large + small)) / large));
    const double by_order = order == 0 ? elliptic.k / large : (elliptic.k - elliptic.e) / small;
    return 2 / pi * field(s) * s * by_order;
  };
  double sum = 0;
  const std::vector<double> ends{0, std::min(r, front), std::max(r, front), 1};
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (ends[i - 1] < ends[i]) sum += testing::integral_between_roots(ring, ends[i - 1], ends[i]);

  const gsl::GaussRule rule(64);
  std::vector<std::pair<double, double>> samples;  // s, and field s ds
  for (const auto& [low, high] : {std::pair(0.0, front), std::pair(front, 1.0)}) {
    for (const auto& [fraction, weight] : rule.nodes()) {
      const double angle = pi / 2 * fraction;
      const double s = low + (high - low) * std::pow(std::sin(angle), 2);
      if (low < high)
        samples.emplace_back(s, field(s) * s * (high - low) * std::sin(2 * angle) * pi / 2 * weight);
    }
  }
  const auto transform = [&](double k) {
    double total = 0;
    for (const auto& [s, part] : samples) total += part * bessel(k * s);
    return total;
  };
  return sum + rule([&](double k) { return excess(k) * transform(k) * bessel(k * r); }, 0, 30);
}

/// The fields themselves, put on the bodies by transforms that the solution knows nothing of: within the
/// stick radius the surface turns as one, beyond it lags behind, and under the sphere it takes its shape.
TEST(LayeredContact, LaysTheSurfacesOnEachOther) {
  const Pair pair = on_base(0.4, 6);
  const LayeredContact contact = press_sphere(0.3, 1, pair);
  const double a = contact.indentation.contact_radius;
  const Profile& profile = *contact.profile;
  for (const double r : {0.1, 0.5, 0.9}) {
    const double depth = moved([&](double s) { return profile.pressure(s); }, 0, r, 1,
                               [&](double k) { return pair.normal_excess(k / a); }) *
                         2 / pair.effective_modulus() * contact.indentation.reference_pressure * a;
    EXPECT_NEAR(depth / (contact.indentation.approach - a * a * r * r / 2), 1, 1e-9) << r;
  }
  const TorsionState state = from_moment_ratio(0.8, profile);
  const auto traction_at = [&](double s) { return traction(state, s, profile); };
  const auto turned = [&](double r) {
    return moved(traction_at, 1, r, state.stick_ratio,
                 [&](double k) { return pair.torsional_excess(k / a); }) /
           (profile.load() * r);
  };
  for (const double part : {0.1, 0.6, 0.95})
    EXPECT_NEAR(turned(part * state.stick_ratio) / state.twist, 1, 1e-9) << part;
  for (const double r : {0.8, 0.95}) EXPECT_LT(turned(r), state.twist) << r;
  const double moment = 2 * pi / profile.load() *
                        (testing::integral_between_roots([&](double s) { return s * s * traction_at(s); }, 0,
                                                         state.stick_ratio) +
                         testing::integral_between_roots([&](double s) { return s * s * traction_at(s); },
                                                         state.stick_ratio, 1));
  EXPECT_NEAR(moment / state.moment, 1, 1e-10);
}

/// Energy lost: the loop's area, 8 integral M dphi - 4 M phi over the first loading.
TEST(LayeredTorsion, LosesTheAreaOfItsLoop) {
  const auto profile = press_sphere(0.5, 1, on_base(0.3, 0.2)).profile;
  const TorsionState state = from_moment_ratio(0.8, *profile);
  const double work = gsl::integral(
      [&](double w) {
        const StickRadius c{.ratio = 1 - w, .complement = w};
        return profile->moment_limit() * profile->moment_share(c).excess * profile->twist_slope(c) /
               (2 * profile->load() * c.ratio);
      },
      0, state.stick_complement, 1e-10);
  EXPECT_NEAR(energy_lost_per_cycle(state, *profile) / (8 * work - 4 * state.moment * state.twist), 1, 1e-8);
}

TEST(LayeredContact, StatesASmallUncertaintyForAllLayers) {
  for (const double h : {0.05, 0.3, 1.0, 1e3}) {
    for (const double base : {0.3, 1e3, kInfinity}) {
      for (const double nu : {0.0, 0.5}) {
        const Pair pair = on_base(h, base, nu);
        const LayeredContact contact = press_sphere(4.0 / 3 * pair.effective_modulus(), 1, pair);
        EXPECT_LE(contact.uncertainty, 5e-10) << h << ' ' << base << ' ' << nu;
      }
    }
  }
}

TEST(LayeredContact, RefusesWhatIsNoSuchContact) {
  const Pair pair = on_base(0.5, 2);
  for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_THROW(press_sphere(bad, 1, pair), std::domain_error);
    EXPECT_THROW(press_sphere(1, bad, pair), std::domain_error);
    EXPECT_THROW(press_flat_punch(bad, 1, pair), std::domain_error);
    EXPECT_THROW(under_hertz_pressure(bad, pair), std::domain_error);
  }
  // A plate on a soft base bends away from a flat punch.
  EXPECT_THAT([] { press_flat_punch(1, 1, on_base(1, 1e-3)); },
              ThrowsMessage<std::domain_error>(HasSubstr("surfaces part")));
  EXPECT_THAT([] { press_flat_punch(1, 1, on_base(1e-3, 2)); },
              ThrowsMessage<std::domain_error>(HasSubstr("thickness")));
}

}  // namespace
}  // namespace slipstick::analytic::layered
