#include "analytic/layered/layered_contact.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "analytic/gsl.hpp"
#include "analytic/layered/fredholm.hpp"
#include "analytic/layered/layered_profile.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic::layered {
namespace {

using std::numbers::pi;

/// Contact radius over the thickness, beyond which matrices and tables become large.
constexpr double kThinnest = 150;
/// A second answer has this factor of the points.
constexpr double kCoarse = 0.9;

void require_positive(const char* name, double value) {
  if (!(value > 0 && std::isfinite(value)))
    throw std::domain_error(fmt::format("{} = {}; allowed: above 0, finite", name, value));
}

void require_resolved(double contact_radius, const Pair& pair) {
  if (!(contact_radius <= kThinnest * pair.thickness()))
    throw std::domain_error(
        fmt::format("contact radius over the layer's thickness = {:.6g} or more; allowed: at most {}",
                    contact_radius / pair.thickness(), kThinnest));
}

std::shared_ptr<const CosineTransform> normal_transform(const Pair& pair, double reach, double resolution) {
  return std::make_shared<const CosineTransform>([&](double k) { return pair.normal_excess(k); },
                                                 pair.thickness(), reach, resolution);
}

CosineTransform torsional_transform(const Pair& pair, double contact_radius, double resolution) {
  return CosineTransform([&](double k) { return pair.torsional_excess(k); }, pair.thickness(),
                         2 * contact_radius, resolution)
      .over(contact_radius);
}

double one(double) { return 1; }
double square(double t) { return t * t; }

/// psi on a given contact radius under a constant and under t^2 on the right; under a sphere the first times
/// `approach`, so that psi ends at zero, less the second is psi R pi/E*.
struct PressedRadius {
  PressedRadius(const std::shared_ptr<const CosineTransform>& transform, double contact_radius, bool sphere)
      : solutions(solve_fredholm(transform, Parity::even, contact_radius, {one, square})) {
    if (!sphere) return;
    approach = solutions[1](contact_radius) / solutions[0](contact_radius);
    curved = 1;
  }

  double psi(double t) const { return approach * solutions[0](t) - curved * solutions[1](t); }
  double integral() const {
    return approach * solutions[0].integral(one) - curved * solutions[1].integral(one);
  }

  std::vector<Solution> solutions;
  double approach = 1;  ///< times the radius of curvature, m^2
  double curved = 0;
};

LayeredContact contact_of(double load, double contact_radius, double approach, const PressedRadius& pressed,
                          const Pair& pair, bool sphere, double resolution) {
  const double a = contact_radius;
  // The mean pressure is 1: psi over a has the integral 1/2.
  const double scale = a / (2 * pressed.integral());
  const std::vector<double> ends = squared_ends(1, pair.thickness() / a);
  const auto terms = static_cast<std::size_t>(kTerms * resolution);
  const ChebyshevPanels psi([&](double y) { return scale * pressed.psi(a * std::sqrt(y)); }, ends, terms);
  const ChebyshevPanels slope = psi.derivative();
  const ChebyshevPanels weight([&](double y) { return -2 * slope(y); }, ends, terms);
  const PressureIntegrals pressure(weight, sphere ? 0 : scale * pressed.psi(a), pair.thickness() / a,
                                   resolution);
  return {
      .indentation = {.contact_radius = a, .approach = approach, .reference_pressure = load / (pi * a * a)},
      .profile = layered_profile(sphere ? "coated_sphere" : "coated_flat_punch", "mean pressure", pressure,
                                 torsional_transform(pair, a, resolution)),
      .uncertainty = 0};
}

/// The contact radius lies between those of half-spaces of the pair's least and largest compliance, with a
/// margin for those between a layer and its base that compliance overshoots.
double radius_under(double load, double radius, const Pair& pair,
                    const std::shared_ptr<const CosineTransform>& transform, double low, double high) {
  const double wanted = std::log(load * radius / (2 * pair.effective_modulus()));
  return std::exp(gsl::root(
      [&](double log_radius) {
        return std::log(PressedRadius(transform, std::exp(log_radius), true).integral()) - wanted;
      },
      std::log(low), std::log(high)));
}

LayeredContact sphere_contact(double load, double radius, const Pair& pair, double resolution) {
  constexpr double kMargin = 1.5;
  constexpr double kStep = 1.6;  // from a radius towards the one sought
  const double modulus = pair.effective_modulus();
  const double half_spaces = std::cbrt(3 * load * radius / (4 * modulus));
  // 2 (E*/R) integral psi is the load.
  const double wanted = load * radius / (2 * modulus);
  double low = std::min(half_spaces, kThinnest * pair.thickness());
  double high = low;
  const auto transform_to = [&](double a) { return normal_transform(pair, 2 * a, resolution); };
  const auto reached = [&](double a) { return PressedRadius(transform_to(a), a, true).integral(); };
  if (reached(low) > wanted) {
    for (low /= kStep; reached(low) > wanted; low /= kStep) high = low;
  } else {
    for (high = std::min(kStep * high, kMargin * kThinnest * pair.thickness()); reached(high) < wanted;
         high *= kStep) {
      low = high;
      require_resolved(low, pair);
    }
  }
  const double a = radius_under(load, radius, pair, transform_to(high), low, high);
  require_resolved(a, pair);
  const PressedRadius pressed(transform_to(a), a, true);
  return contact_of(load, a, pressed.approach / radius, pressed, pair, true, resolution);
}

LayeredContact flat_contact(double load, double radius, const Pair& pair, double resolution) {
  require_resolved(radius, pair);
  const PressedRadius pressed(normal_transform(pair, 2 * radius, resolution), radius, false);
  const double approach = load / (2 * pair.effective_modulus() * pressed.integral());
  return contact_of(load, radius, approach, pressed, pair, false, resolution);
}

/// The surfaces must touch everywhere within the contact radius, and slip must spread from the edge inwards:
/// it does where the twist grows as the stick radius shrinks, since then more tractions of bonded punches are
/// added, which are positive.
void require_one_ring(const Profile& profile) {
  constexpr int kRadii = 64;
  constexpr int kSticks = 6;
  for (int i = 0; i < kRadii; ++i) {
    const double r = static_cast<double>(i) / kRadii;
    const double pressure = profile.pressure(r);
    if (!(pressure > 0))
      throw std::domain_error(fmt::format(
          "pressure over its mean = {:.6g} at r/a = {}; allowed: above 0, or the surfaces part there",
          pressure, r));
  }
  for (int i = 0; i < kSticks; ++i) {
    const double c = 1 - static_cast<double>(i) / kSticks;
    const double slope = profile.twist_slope({.ratio = c, .complement = 1 - c});
    if (!(slope > 0))
      throw std::domain_error(fmt::format(
          "growth of the twist = {:.6g} at a_s/a = {}; allowed: above 0, or slip begins inside the contact",
          slope, c));
  }
}

LayeredContact with_uncertainty(LayeredContact fine, const LayeredContact& coarse) {
  constexpr double kRounding = 1e-13;  // of sums of some hundred terms
  constexpr double kHalf = 0.5;        // of the limit moment, where twists are compared
  require_one_ring(*coarse.profile);
  const auto differ = [](double value, double other) { return std::abs(other / value - 1); };
  fine.uncertainty =
      kRounding + std::max({differ(fine.indentation.contact_radius, coarse.indentation.contact_radius),
                            differ(fine.indentation.approach, coarse.indentation.approach),
                            differ(fine.profile->pressure(0), coarse.profile->pressure(0)),
                            differ(fine.profile->moment_limit(), coarse.profile->moment_limit()),
                            differ(from_moment_ratio(kHalf, *fine.profile).twist,
                                   from_moment_ratio(kHalf, *coarse.profile).twist)});
  return fine;
}

}  // namespace

LayeredContact press_sphere(double load, double radius, const Pair& pair) {
  require_positive("load", load);
  require_positive("radius", radius);
  return with_uncertainty(sphere_contact(load, radius, pair, 1), sphere_contact(load, radius, pair, kCoarse));
}

LayeredContact press_flat_punch(double load, double radius, const Pair& pair) {
  require_positive("load", load);
  require_positive("radius", radius);
  return with_uncertainty(flat_contact(load, radius, pair, 1), flat_contact(load, radius, pair, kCoarse));
}

std::unique_ptr<const Profile> under_hertz_pressure(double contact_radius, const Pair& pair) {
  require_positive("contact radius", contact_radius);
  require_resolved(contact_radius, pair);
  const PressureIntegrals hertz(ChebyshevPanels(one, {0, 1}, 1), 0, pair.thickness() / contact_radius, 1);
  return layered_profile("coated_hertz", "peak pressure", hertz,
                         torsional_transform(pair, contact_radius, 1));
}

}  // namespace slipstick::analytic::layered
