#include "convergence/solve/continuum.hpp"

#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <variant>

#include "solver/input/input_error.hpp"
#include "solver/solve.hpp"
#include "solver/step/continuum_gap.hpp"

namespace slipstick::convergence {
namespace {

using solver::ContinuumGap;
using solver::Scene;
using solver::Solution;

/// The least energy, less the work of a displacement d that is imposed (d.F), lies between low and high, J.
struct Energy {
  double low;
  double high;
};

Energy energy_of(const Scene& scene, const Solution& solution, const ContinuumGap& found) {
  const auto& [gap, energy, quadrature_error] = found;
  double work = 0.0;
  if (scene.steps.front().displacement) {
    const solver::Index cells = solution.grid.cells();
    work = solution.grid.cell_area() * (solution.displacement[0] * solution.traction.head(cells).sum() +
                                        solution.displacement[1] * solution.traction.tail(cells).sum());
  }
  return {energy * (1.0 - gap - quadrature_error) - work, energy * (1.0 + quadrature_error) - work};
}

Scene under(Scene scene, double moment) {
  scene.steps.front().torsion = solver::Moment{moment};
  return scene;
}

/// Both ends of the twist's interval under a moment.
std::pair<Number, Number> twist_interval(const Scene& scene, const Solution& solution,
                                         const ContinuumGap& found) try {
  const double moment = solution.moment;
  const auto [at_low, at_high] = energy_of(scene, solution, found);
  // A bound by the energy at another moment.
  const auto slope = [&, low = at_low](double distance) -> Number {
    try {
      const Scene there = under(scene, moment + distance);
      const Solution other = solver::solve(there);
      const double high = energy_of(there, other, solver::continuum_gap(there, other)).high;
      return number_or((high - low) / distance, "the energy at the other moment is not finite");
    } catch (const solver::InputError& refused) {  // gross slip
      return {.why_missing = refused.what()};
    }
  };
  // The best distance is sqrt(2 G/J''), and J'' the change of twist over that of the moment.
  const double open = 2.0 * (at_high - at_low);
  const double first = std::copysign(std::sqrt(open * moment / solution.twist_angle), moment);
  const double before = solver::solve(under(scene, moment - first)).twist_angle;
  const double distance = std::sqrt(open * first / (solution.twist_angle - before));
  return {slope(-distance), slope(distance)};
} catch (const solver::InputError& refused) {
  const Number missing{.why_missing = refused.what()};
  return {missing, missing};
}

}  // namespace

ContinuumRecord continuum_record(const Scene& scene, const Solution& solution) try {
  const ContinuumGap found = solver::continuum_gap(scene, solution);
  const std::string broken = "the fields are not finite";
  ContinuumRecord record{.gap = number_or(found.gap, broken),
                         .energy = number_or(found.energy, broken),
                         .quadrature_error = number_or(found.quadrature_error, broken)};
  const bool moment_given = !std::holds_alternative<solver::Twist>(scene.steps.front().torsion);
  record.twist_low = record.twist_high = {.why_missing = "only for a moment that is not zero"};
  if (!std::isfinite(found.gap) || !moment_given || solution.moment == 0.0) return record;
  std::tie(record.twist_low, record.twist_high) = twist_interval(scene, solution, found);
  return record;
} catch (const std::invalid_argument& refused) {
  const Number missing{.why_missing = refused.what()};
  return {missing, missing, missing, missing, missing};
}

}  // namespace slipstick::convergence
