#include "convergence/laws/contact_law.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "analytic/elliptic.hpp"
#include "analytic/gsl.hpp"

namespace slipstick::convergence {
namespace {

/// Integrals around a circle of radius r of the sliding direction's part along the force and of its arm,
/// about a centre at distance d: (2/d) ((d + r) E + (d - r) K) and 2 ((d + r) E - (d - r) K), of the
/// complementary modulus |d - r|/(d + r).
struct CircleIntegrals {
  double force;
  double moment;
};
CircleIntegrals around(double radius, double centre) {
  if (centre == 0.0) return {0.0, 2.0 * std::numbers::pi * radius};
  if (std::isinf(centre)) return {2.0 * std::numbers::pi, 0.0};
  const double sum = centre + radius;
  const double difference = centre - radius;
  if (std::abs(difference) < 1e-15 * sum) return {2.0 * sum / centre, 2.0 * sum};
  const auto elliptic = analytic::complete_elliptic(std::abs(difference) / sum);
  return {2.0 / centre * (sum * elliptic.e + difference * elliptic.k),
          2.0 * (sum * elliptic.e - difference * elliptic.k)};
}

/// Panels that get narrower so often towards an end: where the contact turns, which the integrand bends at;
/// and where the contact ends, nearer to which an angle's sine does not hold the digits of 1 - r.
constexpr int kToCentre = 12;
constexpr int kToEdge = 5;

/// Ends of panels between two angles.
std::vector<double> graded(double low, int to_low, double high, int to_high) {
  constexpr double kNarrower = 0.25;
  const double half = 0.5 * (high - low);
  std::vector<double> ends{low, low + half, high};
  for (int i = 1; i <= to_low; ++i) ends.push_back(low + half * std::pow(kNarrower, i));
  for (int i = 1; i <= to_high; ++i) ends.push_back(high - half * std::pow(kNarrower, i));
  std::ranges::sort(ends);
  return ends;
}

/// Force over mu W and moment over mu W a of a contact that turns about a centre. The radius is the sine of
/// an angle, so that a pressure that is infinite at the edge is not.
CircleIntegrals sliding_load(const analytic::Profile& profile, double centre) {
  const double quarter = 0.5 * std::numbers::pi;
  std::vector<std::vector<double>> parts;
  if (centre < 1.0) {
    const double turning = std::asin(centre);
    if (centre > 0.0) parts.push_back(graded(0.0, kToEdge, turning, kToCentre));
    parts.push_back(graded(turning, kToCentre, quarter, kToEdge));
  } else {
    parts.push_back(graded(0.0, kToEdge, quarter, kToEdge));
  }
  CircleIntegrals sum{0.0, 0.0};
  for (const std::vector<double>& ends : parts) {
    for (std::size_t panel = 0; panel + 1 < ends.size(); ++panel) {
      const auto density = [&](double angle, double CircleIntegrals::*of) {
        const double radius = std::sin(angle);
        return profile.pressure(radius) * radius * std::cos(angle) * (around(radius, centre).*of);
      };
      for (double CircleIntegrals::*of : {&CircleIntegrals::force, &CircleIntegrals::moment}) {
        sum.*of += analytic::gsl::gauss_legendre([&](double angle) { return density(angle, of); },
                                                 ends[panel], ends[panel + 1]);
      }
    }
  }
  return {sum.force / profile.load(), sum.moment / profile.load()};
}

double distance(const LimitLoad& load) { return std::hypot(load.force, load.moment); }

/// The farther ends of chord and tangents between two loads, seen from the origin, less 1. `arm`: M_lim/(mu W
/// a), by which centres become normals in the plane of the two ratios.
double gap_between(const LimitLoad& one, const LimitLoad& other, double arm) {
  const auto normal = [&](const LimitLoad& load) {
    return std::isinf(load.centre) ? std::array{1.0, 0.0} : std::array{load.centre / arm, 1.0};
  };
  const auto [n1, m1] = normal(one);
  const auto [n2, m2] = normal(other);
  const double support_1 = n1 * one.force + m1 * one.moment;
  const double support_2 = n2 * other.force + m2 * other.moment;
  const double determinant = n1 * m2 - n2 * m1;
  const double force = (support_1 * m2 - support_2 * m1) / determinant;
  const double moment = (n1 * support_2 - n2 * support_1) / determinant;
  // The chord through both loads crosses the ray to (force, moment) at this part of it.
  const double across_force = other.force - one.force;
  const double across_moment = other.moment - one.moment;
  const double part = (one.force * across_moment - one.moment * across_force) /
                      (force * across_moment - moment * across_force);
  return 1.0 / part - 1.0;
}

}  // namespace

LimitSurface limit_surface(const analytic::Profile& profile, int loads) {
  if (loads < 3) throw std::domain_error(fmt::format("{} loads; allowed: at least 3", loads));
  const double arm = profile.moment_limit();
  LimitSurface surface{};
  double farthest = -1.0;
  for (int i = 0; i < loads; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / (loads - 1);
    const double centre = i + 1 == loads ? INFINITY : arm * std::tan(angle);
    const CircleIntegrals load = sliding_load(profile, centre);
    surface.loads.push_back({centre, load.force, load.moment / arm});
    const double error = 1.0 / distance(surface.loads.back()) - 1.0;
    if (std::abs(error) > farthest) {
      farthest = std::abs(error);
      surface.ellipsoid_error = error;
      surface.ellipsoid_farthest = surface.loads.back();
    }
    if (i > 0) {
      surface.gap = std::max(surface.gap, gap_between(surface.loads[static_cast<std::size_t>(i - 1)],
                                                      surface.loads.back(), arm));
    }
  }
  return surface;
}

}  // namespace slipstick::convergence
