#include "convergence/errors.hpp"

#include <cmath>
#include <limits>

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

double relative_error(double value, double exact) {
  return std::isfinite(exact) ? value / exact - 1.0 : std::numeric_limits<double>::quiet_NaN();
}

/// Both given as sizes in each cell: of the difference, and of the exact field.
FieldError field_error(const ArrayXd& difference, const ArrayXd& exact) {
  return {difference.sum() / exact.sum(), std::sqrt(difference.square().sum() / exact.square().sum()),
          difference.maxCoeff<Eigen::PropagateNaN>() / exact.maxCoeff<Eigen::PropagateNaN>()};
}

}  // namespace

ExactFields exact_fields(const Oracle& oracle, const solver::Model& model) {
  const ArrayXd rotation = solver::rotation_field(model.grid);
  const ArrayXd radius = solver::norms(rotation);
  const Index cells = radius.size();
  ExactFields exact{ArrayXd(cells), ArrayXd::Zero(2 * cells)};
  for (Index i = 0; i < cells; ++i) {
    const double metres = radius[i] * model.length_unit;
    exact.pressure[i] = oracle.pressure(metres) / model.stress_unit;
    if (radius[i] == 0.0) continue;  // the axis carries no traction
    const double over_radius = oracle.traction(metres) / model.stress_unit / radius[i];
    exact.traction[i] = over_radius * rotation[i];
    exact.traction[i + cells] = over_radius * rotation[i + cells];
  }
  return exact;
}

Errors compare(const solver::Solution& solution, const Oracle& oracle) {
  const ExactFields exact = exact_fields(oracle, solution.model);
  const auto finite = exact.pressure.isFinite();
  const ArrayXd pressure_difference = (solution.normal.pressure - exact.pressure).abs();
  return {
      .twist = relative_error(solution.twist_angle, oracle.twist_angle),
      .moment = relative_error(solution.moment, oracle.moment),
      .moment_limit = relative_error(solution.moment_limit, oracle.moment_limit),
      .stick_radius = relative_error(solution.stick_radius, oracle.stick_radius),
      .stick_radius_counted = relative_error(solution.stick_radius_counted, oracle.stick_radius),
      .contact_radius = relative_error(solution.contact_radius, oracle.contact_radius),
      .peak_pressure = relative_error(solution.peak_pressure, oracle.peak_pressure),
      .traction = field_error(solver::norms(solution.torsion.traction - exact.traction),
                              solver::norms(exact.traction)),
      .pressure = field_error(finite.select(pressure_difference, 0.0), finite.select(exact.pressure, 0.0)),
  };
}

}  // namespace slipstick::convergence
