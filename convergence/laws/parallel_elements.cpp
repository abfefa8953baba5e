#include "convergence/laws/contact_law.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace slipstick::convergence {
namespace {

using analytic::TorsionState;

/// Least error of m that kMaxElements elements reach.
constexpr double kMinElementError = 1e-5;
/// Rows of a table at equal steps: a file of some 10 MB.
constexpr std::size_t kMaxEvenRows = 100000;
/// Error of m; 200 elements have a larger one with each profile.
constexpr double kMinCountedError = 1e-8;

void require_error(double error, double least) {
  if (error >= least && error <= kMaxLineError) return;
  throw std::domain_error(fmt::format("an error of {}; allowed: {} to {}", error, least, kMaxLineError));
}

/// dm/dt, by which a state on the curve is found directly.
double slope_of(const TorsionState& state, const analytic::Profile& profile) {
  return state.tangent_stiffness / profile.moment_limit();
}

/// Where the curve has this slope.
TorsionState touching(double slope, const analytic::Profile& profile) {
  const double cube = slope * profile.moment_limit() / kStiffness;
  return analytic::from_stick_ratio(std::min(1.0, std::cbrt(cube)), profile);
}

/// The stick ratio in (low, high) where a function that falls with it crosses zero.
double stick_ratio_where(const std::function<double(const TorsionState&)>& f, double low, double high,
                         const analytic::Profile& profile) {
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (f(analytic::from_stick_ratio(middle, profile)) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// How far the curve rises above the straight line between two of its states.
double rise_above(const TorsionState& from, const TorsionState& to, const analytic::Profile& profile) {
  const double slope = (to.moment_ratio - from.moment_ratio) / (to.twist - from.twist);
  const TorsionState state = touching(slope, profile);
  return state.moment_ratio - from.moment_ratio - slope * (state.twist - from.twist);
}

struct Corner {
  double twist;
  double moment_ratio;
};

/// The next corner of lines that stay within the error of the curve, from one where they start at its origin
/// or `error` above it; the last has moment ratio 1.
Corner next_corner(const Corner& from, double stick_ratio, const TorsionState& last, double error,
                   const analytic::Profile& profile) {
  if (1.0 - from.moment_ratio <= error) return {last.twist, 1.0};
  const auto below = [&](const TorsionState& state) {
    return state.moment_ratio - from.moment_ratio - slope_of(state, profile) * (state.twist - from.twist) -
           error;
  };
  constexpr double kNearlyNoStick = 1e-9;
  const double tangent = stick_ratio_where(below, kNearlyNoStick, stick_ratio, profile);
  const double slope = slope_of(analytic::from_stick_ratio(tangent, profile), profile);
  const double reaches = from.twist + (1.0 - from.moment_ratio) / slope;
  if (reaches >= last.twist) return {reaches, 1.0};
  const auto above = [&](const TorsionState& state) {
    return from.moment_ratio + slope * (state.twist - from.twist) - state.moment_ratio - error;
  };
  const TorsionState end =
      analytic::from_stick_ratio(stick_ratio_where(above, last.stick_ratio, tangent, profile), profile);
  return {end.twist, std::min(1.0, end.moment_ratio + error)};
}

/// The total variation of the lines' error, which falls and rises between two corners and falls after the
/// last.
double total_variation(const std::vector<Corner>& corners, const analytic::Profile& profile) {
  double sum = 0.0;
  double from = 0.0;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const Corner& one = corners[k - 1];
    const Corner& other = corners[k];
    const double slope = (other.moment_ratio - one.moment_ratio) / (other.twist - one.twist);
    const TorsionState state = touching(slope, profile);
    const double least = one.moment_ratio + slope * (state.twist - one.twist) - state.moment_ratio;
    const double to = other.moment_ratio - analytic::from_twist(other.twist, profile).moment_ratio;
    sum += from + to - 2.0 * least;
    from = to;
  }
  return sum + from;
}

/// The elements of an error; if they were more than `most`, the first `most + 1` of them.
ParallelElements with_error(const analytic::Profile& profile, double error, std::size_t most = SIZE_MAX - 1) {
  const TorsionState last = analytic::from_moment_deficit(error, profile);
  std::vector<Corner> corners{{0.0, 0.0}};
  for (double stick_ratio = 1.0; corners.back().moment_ratio < 1.0 && corners.size() <= most + 1;) {
    if (corners.back().twist > 0.0) {
      stick_ratio = analytic::from_twist(corners.back().twist, profile).stick_ratio;
    }
    corners.push_back(next_corner(corners.back(), stick_ratio, last, error, profile));
  }
  ParallelElements found{{}, error, total_variation(corners, profile)};
  const auto slope = [&](std::size_t k) {
    if (k == corners.size()) return 0.0;
    return (corners[k].moment_ratio - corners[k - 1].moment_ratio) /
           (corners[k].twist - corners[k - 1].twist);
  };
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const double stiffness = slope(k) - slope(k + 1);
    found.elements.push_back({stiffness, stiffness * corners[k].twist});
  }
  return found;
}

}  // namespace

double ParallelElements::moment_ratio_at(double twist) const {
  double sum = 0.0;
  for (const auto& [stiffness, slip] : elements) sum += std::clamp(stiffness * twist, -slip, slip);
  return sum;
}

StateTable tabulate(const analytic::Profile& profile, double error) {
  require_error(error, kMinLineError);
  const TorsionState last = analytic::from_moment_deficit(error, profile);
  StateTable table{{analytic::from_moment_ratio(0.0, profile)}, error};
  while (rise_above(table.rows.back(), last, profile) > error) {
    const TorsionState& from = table.rows.back();
    const auto too_far = [&](const TorsionState& state) {
      return (state.twist > from.twist ? rise_above(from, state, profile) : 0.0) - error;
    };
    const double next = stick_ratio_where(too_far, last.stick_ratio, from.stick_ratio, profile);
    table.rows.push_back(analytic::from_stick_ratio(next, profile));
  }
  table.rows.push_back(last);
  return table;
}

StateTable tabulate_evenly(const analytic::Profile& profile, double error) {
  require_error(error, kMinLineError);
  const TorsionState last = analytic::from_moment_deficit(error, profile);
  double worst = INFINITY;
  StateTable table{{}, error};
  for (std::size_t steps = 32; worst > error;) {
    if (steps > kMaxEvenRows) {
      throw std::domain_error(fmt::format(
          "more than {} even rows for an error of {}; allowed: a larger --table-error", kMaxEvenRows, error));
    }
    table.rows = {analytic::from_moment_ratio(0.0, profile)};
    worst = 0.0;
    for (std::size_t i = 1; i <= steps; ++i) {
      const double twist = last.twist * static_cast<double>(i) / static_cast<double>(steps);
      table.rows.push_back(i == steps ? last : analytic::from_twist(twist, profile));
      worst = std::max(worst, rise_above(table.rows[i - 1], table.rows[i], profile));
    }
    steps = static_cast<std::size_t>(1.1 * static_cast<double>(steps) * std::sqrt(worst / error)) + 1;
  }
  return table;
}

ParallelElements parallel_elements(const analytic::Profile& profile, double error) {
  require_error(error, kMinElementError);
  return with_error(profile, error);
}

ParallelElements parallel_elements(const analytic::Profile& profile, int count) {
  if (count < 1 || count > kMaxElements) {
    throw std::domain_error(fmt::format("{} elements; allowed: 1 to {}", count, kMaxElements));
  }
  double low = std::log(kMinCountedError);
  double high = std::log(kMaxLineError);
  constexpr int kHalvings = 30;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    const auto most = static_cast<std::size_t>(count);
    const bool few = with_error(profile, std::exp(middle), most).elements.size() <= most;
    (few ? high : low) = middle;
  }
  return with_error(profile, std::exp(high));
}

}  // namespace slipstick::convergence
