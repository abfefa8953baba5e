#include "convergence/oracle/exact_stresses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analytic/stresses/stress_field.hpp"
#include "convergence/oracle/oracle.hpp"

namespace slipstick::convergence {
namespace {

/// Polar components, whose z points out of the body, in the axes of the scene.
std::array<double, solver::kStresses> in_axes(const analytic::PressureStress& p, const analytic::TorsionStress& t,
                                              double cosine, double sine) {
  return {p.rr * cosine * cosine + p.tt * sine * sine - 2.0 * t.rt * cosine * sine,
          p.rr * sine * sine + p.tt * cosine * cosine + 2.0 * t.rt * cosine * sine,
          p.zz,
          (p.rr - p.tt) * cosine * sine + t.rt * (cosine * cosine - sine * sine),
          -p.rz * cosine + t.tz * sine,
          -p.rz * sine - t.tz * cosine};
}

}  // namespace

std::optional<ExactStresses> exact_stresses(const solver::Scene& scene, solver::Body body, std::string& reason) {
  auto theory = exact_history(scene);
  std::optional<analytic::LoadingHistory> history;
  OracleAnswer answer;
  for (std::size_t k = 0; k < scene.steps.size() * static_cast<std::size_t>(scene.cycles); ++k) {
    answer = theory.advance(step_of(scene, k));
    reason = answer.oracle ? answer.oracle->only_normal : answer.reason;
    if (!reason.empty()) return std::nullopt;
    reason = "no exact stresses are known here under a tangential force or where pressing slips";
    if (!answer.oracle->shear || answer.oracle->place.direction != std::array{0.0, 0.0}) return std::nullopt;
    if (!history) history.emplace(*answer.oracle->friction.bound);
    history->load_to(answer.oracle->state.moment_ratio);
  }
  const double sign = body == solver::Body::lower ? 1.0 : -1.0;
  const auto at = [oracle = *answer.oracle, history = *history, sign](const std::vector<std::array<double, 3>>& points,
                                                                      double poisson) {
    const NormalContact& normal = oracle.normal;
    const analytic::StressField pressed(analytic::LoadingHistory(*normal.profile), *normal.profile);
    const analytic::StressField twisted(history, *oracle.friction.bound);
    const double a = oracle.contact_radius, p0 = normal.reference_pressure;
    const double q0 = sign * oracle.friction.reference_bound;
    std::vector<solver::PointStresses> parts;
    for (const auto& [x1, x2, depth] : points) {
      const double y1 = x1 - oracle.place.centre[0], y2 = x2 - oracle.place.centre[1];
      const double radius = std::hypot(y1, y2);
      const double cosine = radius > 0.0 ? y1 / radius : 1.0, sine = radius > 0.0 ? y2 / radius : 0.0;
      const auto p = pressed.by_pressure({radius / a, depth / a}, poisson);
      const auto t = twisted.by_torsion({radius / a, depth / a});
      parts.push_back({in_axes({p0 * p.rr, p0 * p.tt, p0 * p.zz, p0 * p.rz}, {}, cosine, sine),
                       in_axes({}, {q0 * t.rt, q0 * t.tz}, cosine, sine)});
    }
    return parts;
  };
  return ExactStresses{answer.oracle->contact_radius, answer.oracle->place.centre, at};
}

FieldError stress_error(const solver::Scene& scene, const solver::Solution& solution, std::string& reason) {
  constexpr double kDepth = 0.4, kReach = 1.5;  // contact radii
  constexpr int kPoints = 24;
  const bool upper = std::isinf(scene.lower.young_modulus);
  const solver::Body body = upper ? solver::Body::upper : solver::Body::lower;
  reason = "the body has a layer";
  const auto exact = solver::is_bare(scene) ? exact_stresses(scene, body, reason) : std::nullopt;
  if (!exact) return {};
  std::vector<std::array<double, 3>> points;  // a spiral: radii and angles are even
  for (int k = 0; k < kPoints; ++k) {
    const double radius = kReach * exact->contact_radius * std::sqrt((k + 0.5) / kPoints);
    const double angle = 2.0 * std::numbers::pi * k / (std::numbers::phi * std::numbers::phi);
    points.push_back({exact->centre[0] + radius * std::cos(angle), exact->centre[1] + radius * std::sin(angle),
                      kDepth * exact->contact_radius});
  }
  const double poisson = (upper ? scene.upper : scene.lower).poisson_ratio;
  const auto right = exact->at(points, poisson);
  const auto found = stresses_at(solution, poisson, body, points);
  std::array<double, 3> off{}, size{};  // sums, of squares, largest
  const auto add = [](std::array<double, 3>& to, double value) {
    to = {to[0] + std::abs(value), to[1] + value * value, std::max(std::abs(value), to[2])};
  };
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (std::size_t c = 0; c < solver::kStresses; ++c) {
      const double stress = right[k].by_pressure[c] + right[k].by_shear[c];
      add(off, found[k].by_pressure[c] + found[k].by_shear[c] - stress);
      add(size, stress);
    }
  }
  return {off[0] / size[0], std::sqrt(off[1] / size[1]), off[2] / size[2]};
}

}  // namespace slipstick::convergence
