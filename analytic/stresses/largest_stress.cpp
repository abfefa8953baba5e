#include <algorithm>
#include <array>
#include <cmath>

#include "analytic/out_of_range.hpp"
#include "analytic/stresses/stress_field.hpp"

namespace slipstick::analytic {

namespace {

/// Samples of the body in which the largest stress is bracketed: radii to 1.25, depths that crowd at the
/// surface, where torsion adds its own maximum, and reach beyond the maximum by any pressure.
constexpr int kSampleRadii = 26;
constexpr double kSampleSpacing = 0.05;
constexpr std::array kSampleDepths{0.0, 0.02, 0.05, 0.1,  0.15, 0.2, 0.25, 0.3, 0.35,
                                   0.4, 0.45, 0.5,  0.55, 0.6,  0.7, 0.8,  1.0};
/// Of the samples so many are starts; neighbours share a maximum.
constexpr std::size_t kStarts = 4;

template <class Function>
LargestStress sample(const Function& f, BodyPoint at) {
  return {f(at), at};
}

/// The local maximum from a start: a step to the best of eight neighbours, or half the step.
template <class Function>
LargestStress climb(const Function& f, LargestStress best) {
  constexpr double kFinest = 1e-9;  // its square is no part of the value
  for (double step = kSampleSpacing / 2; step > kFinest;) {
    const LargestStress from = best;
    for (const int dr : {-1, 0, 1})
      for (const int dz : {-1, 0, 1}) {
        if (dr == 0 && dz == 0) continue;
        const BodyPoint at{std::max(0.0, from.at.radius + dr * step),
                           std::max(0.0, from.at.depth + dz * step)};
        if (at.radius == from.at.radius && at.depth == from.at.depth) continue;
        const LargestStress next = sample(f, at);
        if (next.value > best.value) best = next;
      }
    if (best.value == from.value) step /= 2;
  }
  return best;
}

}  // namespace

LargestStress largest(const StressField& field, double friction, double poisson, double Severity::*measure) {
  const Profile& profile = field.profile();
  if (!field.has_pressure())
    throw std::domain_error(
        fmt::format("profile \"{}\" is a bound of the traction, not a pressure", profile.name()));
  if (!std::isfinite(profile.pressure(0)) || profile.pressure(1) != 0)
    throw std::domain_error(
        fmt::format("profile \"{}\": the stress is infinite where the pressure is infinite or "
                    "ends in a step",
                    profile.name()));
  const auto f = [&](BodyPoint at) {
    return severity(field.by_pressure(at, poisson), field.by_torsion(at), friction).*measure;
  };
  std::vector<double> radii = field.fronts();
  for (int i = 0; i < kSampleRadii; ++i) radii.push_back(kSampleSpacing * i);
  std::vector<LargestStress> samples;
  for (const double r : radii)
    for (const double z : kSampleDepths) samples.push_back(sample(f, {r, z}));
  std::ranges::sort(samples, std::ranges::greater{}, &LargestStress::value);
  LargestStress best = samples.front();
  std::vector<LargestStress> starts;
  for (const LargestStress& start : samples) {
    constexpr double kApart = 3 * kSampleSpacing;
    const auto is_near = [&](const LargestStress& other) {
      return std::hypot(start.at.radius - other.at.radius, start.at.depth - other.at.depth) < kApart;
    };
    if (starts.size() == kStarts || std::ranges::any_of(starts, is_near)) continue;
    starts.push_back(start);
    const LargestStress top = climb(f, start);
    if (top.value > best.value) best = top;
  }
  return best;
}

LargestSeverity largest(const StressField& field, double friction, double poisson) {
  return {.von_mises = largest(field, friction, poisson, &Severity::von_mises),
          .tresca = largest(field, friction, poisson, &Severity::tresca),
          .tension = largest(field, friction, poisson, &Severity::tension)};
}

}  // namespace slipstick::analytic
