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

/// Length of the difference over that of the exact vector.
double relative_difference(const std::array<double, 2>& value, const std::array<double, 2>& exact) {
  return std::hypot(value[0] - exact[0], value[1] - exact[1]) / std::hypot(exact[0], exact[1]);
}

/// Both given as sizes in each cell: of the difference, and of the exact field.
FieldError field_error(const ArrayXd& difference, const ArrayXd& exact) {
  return {difference.sum() / exact.sum(), std::sqrt(difference.square().sum() / exact.square().sum()),
          difference.maxCoeff<Eigen::PropagateNaN>() / exact.maxCoeff<Eigen::PropagateNaN>()};
}

}  // namespace

ExactFields exact_fields(const Oracle& oracle, const solver::Model& model) {
  ArrayXd rotation = solver::rotation_field(model.grid);
  rotation.head(model.grid.cells()) += oracle.centre[1] / model.length_unit;
  rotation.tail(model.grid.cells()) -= oracle.centre[0] / model.length_unit;
  const ArrayXd radius = solver::norms(rotation);
  const Index cells = radius.size();
  ExactFields exact{radius, ArrayXd(cells), ArrayXd::Zero(2 * cells)};
  for (Index i = 0; i < cells; ++i) {
    const double metres = radius[i] * model.length_unit;
    exact.pressure[i] = oracle.pressure(metres) / model.stress_unit;
    const double shear = oracle.traction(metres) / model.stress_unit;
    if (oracle.direction != std::array<double, 2>{}) {
      exact.traction[i] = shear * oracle.direction[0];
      exact.traction[i + cells] = shear * oracle.direction[1];
    } else if (radius[i] != 0.0) {  // around the axis, which carries no traction itself
      exact.traction[i] = shear / radius[i] * rotation[i];
      exact.traction[i + cells] = shear / radius[i] * rotation[i + cells];
    }
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
      .stick_ratio =
          relative_error(solution.stick_radius / solution.contact_radius, oracle.state.stick_ratio),
      .displacement = relative_difference(solution.displacement, oracle.displacement),
      .dissipated = relative_error(solution.dissipated, oracle.dissipated),
      .stick_radius_counted = relative_error(solution.stick_radius_counted, oracle.stick_radius),
      .contact_radius = relative_error(solution.contact_radius, oracle.contact_radius),
      .peak_pressure = relative_error(solution.peak_pressure, oracle.peak_pressure),
      .traction = field_error(solver::norms(solution.tangential.traction - exact.traction),
                              solver::norms(exact.traction)),
      .pressure = field_error(finite.select(pressure_difference, 0.0), finite.select(exact.pressure, 0.0)),
  };
}

}  // namespace slipstick::convergence
