#include "analytic/tabulated_pressure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace slipstick::analytic {

namespace {

using Points = std::vector<PressurePoint>;

/// The error at a point of the interpolant without it; the point is neither the first nor the last.
double misfit(const Points& points, std::size_t left_out) {
  constexpr std::size_t kReach = 3;  // two neighbours on either side shape a piece; the third, ends of its own
  const std::size_t from = left_out - std::min(left_out, kReach);
  const std::size_t to = std::min(points.size(), left_out + kReach + 1);
  Points rest;
  for (std::size_t i = from; i < to; ++i)
    if (i != left_out) rest.push_back(points[i]);
  return std::abs(interpolated_pressure(rest, points[left_out].radius) - points[left_out].pressure);
}

/// For each point the largest misfit among it and its neighbours: a single one may vanish by chance.
std::vector<double> misfits_nearby(const Points& points) {
  constexpr std::size_t kNeighbours = 4;  // radii rounded to few digits err alike over a few points
  std::vector<double> misfits(points.size());
  for (std::size_t i = 1; i + 1 < points.size(); ++i) misfits[i] = misfit(points, i);
  std::vector<double> largest(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = i - std::min(i, kNeighbours); k <= std::min(i + kNeighbours, points.size() - 1); ++k)
      largest[i] = std::max(largest[i], misfits[k]);
  return largest;
}

/// Without every second point of a stretch, its first point included.
Points thinned(const Points& points, std::size_t from, std::size_t to, std::size_t parity) {
  Points rest;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i < from || i >= to || i % 2 == parity) rest.push_back(points[i]);
  return rest;
}

/// With the pressures of a stretch, its first point included, moved by `factor` times `by`, but no lower than half.
Points moved(Points points, std::size_t from, std::size_t to, const std::vector<double>& by, double factor) {
  for (std::size_t i = from; i < to; ++i)
    points[i].pressure = std::max(points[i].pressure + factor * by[i], points[i].pressure / 2);
  return points;
}

/// With a pressure like this power of the distance from the edge between the last two points.
Points ending_like(double power, Points points) {
  constexpr double kNearest = 1e-10;  // nearer, the radius leaves the distance few digits
  const PressurePoint edge = points.back();
  points.pop_back();
  const auto [radius, pressure] = points.back();
  for (double share = 0.5; (1 - radius) * share > kNearest; share /= 2)
    points.push_back({.radius = 1 - (1 - radius) * share, .pressure = pressure * std::pow(share, power)});
  points.push_back(edge);
  return points;
}

/// The power of the distance from the edge that the pressure follows between a point and the one before.
double power_at(const Points& points, std::size_t i) {
  return std::log(points[i].pressure / points[i - 1].pressure) /
         std::log((1 - points[i].radius) / (1 - points[i - 1].radius));
}

/// As the pressure may end where it is 0 at the edge: like the power that the last points follow, like that
/// to which this tends, and like the square root by which smooth bodies part.
std::vector<Points> other_endings(const Points& points) {
  constexpr double kMin = 0.1;  // nearly a step
  constexpr double kMax = 8;
  const std::size_t last = points.size() - 2;
  const double power = power_at(points, last);
  std::vector<Points> endings;
  for (const double p : {power, 2 * power - power_at(points, last - 1), 0.5})
    endings.push_back(ending_like(std::clamp(p, kMin, kMax), points));
  return endings;
}

/// Groups of other points, each for a stretch of the radius.
std::vector<std::vector<Points>> other_points(const Points& points) {
  // Enough that what cancels within one is a small part, and that random errors, which add like the root of
  // their number, are not overrated much when sizes are added.
  constexpr std::size_t kStretches = 16;
  // Times the largest misfit nearby. interpolation_errors() doubles what comes of it.
  constexpr double kNoise = 0.6;
  constexpr double kAtEdge = 2;  // beyond the last misfit known
  constexpr double kOnAxis = 6;  // a cone's pressure is infinite there, whatever the table says
  const std::vector<double> misfits = misfits_nearby(points);
  const std::size_t inner = points.size() - 2;
  const std::size_t stretches = std::min(kStretches, inner / 2);
  std::vector<std::vector<Points>> groups;
  for (std::size_t i = 0; i < stretches; ++i) {
    const std::size_t from = 1 + inner * i / stretches;
    const std::size_t to = 1 + inner * (i + 1) / stretches;
    groups.push_back(
        {thinned(points, from, to, 0), thinned(points, from, to, 1), moved(points, from, to, misfits, kNoise)});
  }
  const auto moved_end = [&](std::size_t end, double factor) {
    return std::vector{moved(points, end, end + 1, misfits, factor), moved(points, end, end + 1, misfits, -factor)};
  };
  groups.push_back(moved_end(0, kOnAxis));
  groups.push_back(points.back().pressure > 0 ? moved_end(points.size() - 1, kAtEdge) : other_endings(points));
  return groups;
}

}  // namespace

std::vector<double> interpolation_errors(
    const TabulatedProfile& table,
    const std::function<std::vector<double>(const Profile&, double mean_pressure)>& numbers) {
  constexpr double kSafety = 2;           // covers every error of 14 pressures in 70 tables, see the test
  constexpr double kComputation = 1e-12;  // of the interpolant's own numbers
  const std::vector<double> values = numbers(*table.profile, table.mean_pressure);
  std::vector<double> errors;
  for (const double value : values) errors.push_back(kComputation * std::abs(value));
  for (const auto& group : other_points(table.points)) {
    std::vector<double> largest(values.size());
    for (const Points& points : group) {
      const auto [profile, mean] = interpolate("another reading of " + table.profile->name(), points);
      const std::vector<double> others = numbers(*profile, table.largest_pressure * mean);
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double change = std::abs(others[i] - values[i]);
        if (!std::isfinite(change)) throw std::domain_error(fmt::format("{} is no number", others[i]));
        largest[i] = std::max(largest[i], change);
      }
    }
    for (std::size_t i = 0; i < values.size(); ++i) errors[i] += kSafety * largest[i];
  }
  return errors;
}

}  // namespace slipstick::analytic
