#include "analytic/layered/layered_contact.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "analytic/gsl.hpp"
#include "analytic/layered/fredholm.hpp"
#include "analytic/layered/layered_profile.hpp"
#include "analytic/out_of_range.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic::layered {
namespace {

using std::numbers::pi;

/// Contact radius over the thickness, beyond which matrices and tables become large.
constexpr double kThinnest = 150;

void require_resolved(double contact_radius, const Pair& pair) {
  if (!(contact_radius <= kThinnest * pair.thickness()))
    throw std::domain_error(
        fmt::format("contact radius over the layer's thickness = {:.6g} or more; allowed: at most {}",
                    contact_radius / pair.thickness(), kThinnest));
}

CosineTransform normal_transform(const Pair& pair, double largest_radius, Points points) {
  return {[&](double k) { return pair.normal_excess(k); }, pair.thickness(), 2 * largest_radius, 1, points};
}

CosineTransform torsional_transform(const Pair& pair, double radius, Points points) {
  return {[&](double k) { return pair.torsional_excess(k); }, pair.thickness(), 2 * radius, radius, points};
}

/// psi R pi/E* on a given contact radius, under a sphere; under a flat punch psi pi/(E* approach).
struct PressedRadius {
  PressedRadius(const CosineTransform& transform, double contact_radius, bool sphere)
      : solutions(solve_fredholm(transform, &CosineTransform::even, contact_radius,
                                 {[](double) { return 1; }, [](double t) { return t * t; }})),
        approach(sphere ? solutions[1](contact_radius) / solutions[0](contact_radius) : 1),
        curved(sphere ? 1 : 0) {}

  double psi(double t) const { return approach * solutions[0](t) - curved * solutions[1](t); }
  double integral() const { return approach * solutions[0].moment(0) - curved * solutions[1].moment(0); }

  std::vector<Solution> solutions;
  double approach;  ///< times R, under a sphere, where psi ends at zero
  double curved;
};

/// scale: of `approach`, to m.
LayeredContact contact_of(double load, double a, double scale, const PressedRadius& pressed, const Pair& pair,
                          Points points) {
  const bool sphere = pressed.curved != 0;
  const double unit = a / (2 * pressed.integral());  // the mean pressure is 1: psi over a has the integral 1/2
  std::vector<double> ends = panel_ends(1, 2 * pair.thickness() / a);
  for (double& end : ends) end *= end;
  const PiecewisePolynomial slope =
      PiecewisePolynomial([&](double y) { return unit * pressed.psi(a * std::sqrt(y)); }, ends, points).derivative();
  const Pressure pressure{sphere ? "coated_sphere" : "coated_flat_punch", "mean pressure",
                          PiecewisePolynomial([&](double y) { return -2 * slope(y); }, ends, points),
                          sphere ? 0 : unit * pressed.psi(a)};
  return {.indentation = {.contact_radius = a,
                          .approach = scale * pressed.approach,
                          .reference_pressure = load / (pi * a * a)},
          .profile = layered_profile(pressure, torsional_transform(pair, a, points)),
          .uncertainty = 0};
}

/// The contact radius is at most that on a half-space of the pair's largest compliance, but for the margin, since those
/// between a layer and its base may overshoot both; on a rigid base and the thinnest layer it is some fortieth of that.
LayeredContact sphere_contact(double load, double radius, const Pair& pair, Points points) {
  constexpr double kMargin = 1.5;
  constexpr double kLowest = 1e-3;
  const double softest = pair.effective_modulus() / std::max(1.0, 1 + pair.normal_excess(0));
  const double high = std::min(kMargin * std::cbrt(3 * load * radius / (4 * softest)), kThinnest * pair.thickness());
  const CosineTransform transform = normal_transform(pair, high, points);
  const double wanted = load * radius / (2 * pair.effective_modulus());  // W = 2 (E*/R) integral psi
  const auto excess = [&](double log_radius) {
    return std::log(PressedRadius(transform, std::exp(log_radius), true).integral() / wanted);
  };
  if (!(excess(std::log(high)) > 0)) require_resolved(std::nextafter(high, 2 * high), pair);
  const double a = std::exp(gsl::root(excess, std::log(kLowest * high), std::log(high)));
  return contact_of(load, a, 1 / radius, PressedRadius(transform, a, true), pair, points);
}

LayeredContact flat_contact(double load, double radius, const Pair& pair, Points points) {
  require_resolved(radius, pair);
  const CosineTransform transform = normal_transform(pair, radius, points);
  const PressedRadius pressed(transform, radius, false);
  return contact_of(load, radius, load / (2 * pair.effective_modulus() * pressed.integral()), pressed, pair, points);
}

/// The surfaces must touch everywhere within the contact radius, and slip must spread from the edge inwards:
/// it does where the twist grows as the stick radius shrinks, since then more tractions of bonded punches are
/// added, which are positive.
void require_one_ring(const Profile& profile) {
  constexpr int kRadii = 64;
  constexpr int kSticks = 6;
  const auto require = [](const char* name, double value, double radius, const char* otherwise) {
    if (!(value > 0))
      throw std::domain_error(
          fmt::format("{} = {:.6g} at r/a = {}; allowed: above 0, or {}", name, value, radius, otherwise));
  };
  for (int i = 0; i < kRadii; ++i) {
    const double r = static_cast<double>(i) / kRadii;
    require("pressure over its mean", profile.pressure(r), r, "the surfaces part there");
  }
  for (int i = kSticks; i > 0; --i) {
    const double c = static_cast<double>(i) / kSticks;
    require("growth of the twist", profile.twist_slope({.ratio = c, .complement = 1 - c}), c,
            "slip begins inside the contact");
  }
}

}  // namespace

LayeredContact press(Indenter indenter, double load, double radius, const Pair& pair) {
  constexpr double kRounding = 1e-13;  // of sums of some hundred terms
  require_positive("load", load);
  require_positive("radius", radius);
  const auto& pressed = indenter == Indenter::sphere ? sphere_contact : flat_contact;
  const LayeredContact coarse = pressed(load, radius, pair, Points::fewer);
  require_one_ring(*coarse.profile);
  LayeredContact fine = pressed(load, radius, pair, Points::all);
  const auto numbers = [](const LayeredContact& contact) {
    const Profile& profile = *contact.profile;
    return std::array{contact.indentation.contact_radius, contact.indentation.approach, profile.pressure(0),
                      profile.moment_limit(), from_moment_ratio(0.5, profile).twist};
  };
  for (std::size_t i = 0; i < numbers(fine).size(); ++i)
    fine.uncertainty = std::max(fine.uncertainty, std::abs(numbers(coarse)[i] / numbers(fine)[i] - 1));
  fine.uncertainty += kRounding;
  return fine;
}

}  // namespace slipstick::analytic::layered
