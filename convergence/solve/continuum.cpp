#include "convergence/solve/continuum.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <variant>

#include "solver/solve.hpp"
#include "solver/step/continuum_gap.hpp"

namespace slipstick::convergence {
namespace {

using solver::Scene;
using solver::Solution;

/// Least energies lie between low and high, J.
struct Energy {
  double low;
  double high;
  double twist;  ///< rad, on the grid
};

Energy energy_of(const Scene& scene, const Solution& solution) {
  const auto [gap, energy, quadrature_error] = solver::continuum_gap(scene, solution);
  return {energy * (1.0 - gap - quadrature_error), energy, solution.twist_angle};
}

Scene under(Scene scene, double moment) {
  scene.steps.front().torsion = solver::Moment{moment};
  return scene;
}

/// The twist's bound by the moment at a distance, which may be negative; none above the limit moment.
std::optional<double> slope(const Scene& scene, double moment, double distance, const Energy& at) {
  const Scene there = under(scene, moment + distance);
  try {
    const Energy other = energy_of(there, solver::solve(there));
    return (other.high - at.low) / distance;
  } catch (const solver::InputError&) {  // gross slip
    return std::nullopt;
  }
}

Number bound_or(const std::optional<double>& bound) {
  return number_or(bound.value_or(NAN), "the moment at the other end is above the limit moment");
}

}  // namespace

ContinuumRecord continuum_record(const Scene& scene, const Solution& solution) try {
  const auto [gap, energy, quadrature_error] = solver::continuum_gap(scene, solution);
  const std::string broken = "the fields are not finite";
  ContinuumRecord record{.gap = number_or(gap, broken),
                         .energy = number_or(energy, broken),
                         .quadrature_error = number_or(quadrature_error, broken),
                         .twist_low = {.why_missing = "only for a moment that is not zero"},
                         .twist_high = {.why_missing = "only for a moment that is not zero"}};
  const double moment = solution.moment;
  if (moment == 0.0 || std::holds_alternative<solver::Twist>(scene.steps.front().torsion)) return record;
  const Energy at = energy_of(scene, solution);
  // The best distance is sqrt(2 G/J''), and J'' the change of twist over that of the moment.
  const double open = 2.0 * (at.high - at.low);
  const double first = std::copysign(std::sqrt(open * moment / solution.twist_angle), moment);
  const Scene before = under(scene, moment - first);
  const double stiffness = first / (solution.twist_angle - solver::solve(before).twist_angle);
  const double distance = std::copysign(std::sqrt(open * stiffness), moment);
  const std::optional<double> high = slope(scene, moment, distance, at);
  const std::optional<double> low = slope(scene, moment, -distance, at);
  record.twist_low = bound_or(moment > 0.0 ? low : high);
  record.twist_high = bound_or(moment > 0.0 ? high : low);
  return record;
} catch (const std::invalid_argument& refused) {
  const Number missing{.why_missing = refused.what()};
  return {missing, missing, missing, missing, missing};
}

}  // namespace slipstick::convergence
