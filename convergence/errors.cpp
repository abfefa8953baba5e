#include "convergence/errors.hpp"

#include <cmath>

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

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
  const ArrayXd& pressure = solution.normal.pressure;
  return {
      .twist = solution.twist_angle / oracle.twist_angle - 1.0,
      .moment = solution.moment / oracle.moment - 1.0,
      .moment_limit = solution.moment_limit / oracle.moment_limit - 1.0,
      .stick_radius = solution.stick_radius_counted / oracle.stick_radius - 1.0,
      .contact_radius = solution.contact_radius / oracle.contact_radius - 1.0,
      .peak_pressure = solution.peak_pressure / oracle.peak_pressure - 1.0,
      .traction = field_error(solver::norms(solution.torsion.traction - exact.traction),
                              solver::norms(exact.traction)),
      .pressure = field_error((pressure - exact.pressure).abs(), exact.pressure),
  };
}

}  // namespace slipstick::convergence
