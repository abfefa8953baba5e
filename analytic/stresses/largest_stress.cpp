#include "analytic/stresses/largest_stress.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace slipstick::analytic {

namespace {

constexpr double kSpacing = 0.05;     // of the samples, over a
constexpr std::size_t kStarts = 4;    // of the ascents
constexpr double kFinestStep = 1e-8;  // its square is no part of the value

double distance(BodyPoint one, BodyPoint other) {
  return std::hypot(one.radius - other.radius, one.depth - other.depth);
}

/// Depths are denser at the surface, where torsion has a maximum of its own.
std::vector<BodyPoint> sample_points(double stick_ratio) {
  std::vector<double> depths{0.0, 0.02};
  for (int i = 1; i <= 12; ++i) depths.push_back(kSpacing * i);
  depths.insert(depths.end(), {0.7, 0.8, 1.0});
  std::vector<BodyPoint> points;
  for (const double depth : depths) {
    for (int i = 0; i <= 25; ++i) points.push_back({kSpacing * i, depth});
    points.push_back({stick_ratio, depth});
  }
  return points;
}

}  // namespace

LargestStress largest_stress(const StressField& field, double Severity::*measure, double friction, double poisson,
                             double stick_ratio) {
  const auto stress = [&](BodyPoint at) {
    return LargestStress{severity(field.by_pressure(at, poisson), field.by_torsion(at), friction).*measure, at};
  };
  const auto smaller = [](const LargestStress& a, const LargestStress& b) { return a.value < b.value; };
  // From one point to the best of its eight neighbours, or to half the step.
  const auto ascend = [&](LargestStress best) {
    for (double step = kSpacing / 2; step > kFinestStep;) {
      LargestStress next = best;
      for (const double dr : {-step, 0.0, step}) {
        for (const double dz : {-step, 0.0, step}) {
          const BodyPoint to{std::max(best.at.radius + dr, 0.0), std::max(best.at.depth + dz, 0.0)};
          if (dr != 0.0 || dz != 0.0) next = std::max(next, stress(to), smaller);
        }
      }
      if (next.value > best.value) {
        best = next;
      } else {
        step /= 2;
      }
    }
    return best;
  };
  const Profile& profile = field.profile();
  const bool is_finite =
      profile.pressure(1) == 0 && std::isfinite(profile.pressure(0)) && std::isfinite(stress({0, 0}).value);
  if (!is_finite)
    throw std::domain_error(fmt::format(
        "profile {}; allowed: pressures that are finite and end at zero, where no stress is infinite", profile.name()));
  std::vector<LargestStress> samples;
  for (const BodyPoint at : sample_points(stick_ratio)) samples.push_back(stress(at));
  std::ranges::stable_sort(samples, [&](const auto& a, const auto& b) { return smaller(b, a); });
  std::vector<LargestStress> starts;
  for (const LargestStress& sample : samples) {
    const bool apart =
        std::ranges::all_of(starts, [&](const auto& start) { return distance(sample.at, start.at) > 3 * kSpacing; });
    if (apart && starts.size() < kStarts) starts.push_back(sample);
  }
  std::ranges::transform(starts, starts.begin(), ascend);
  return *std::ranges::max_element(starts, smaller);
}

}  // namespace slipstick::analytic
