#include "solver/step/to_si.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace slipstick::solver {
namespace {

Eigen::ArrayXd times(Eigen::ArrayXd field, double unit) {
  field *= unit;
  return field;
}

void require_finite(const Solution& solution) {
  const bool finite = std::isfinite(solution.twist_angle) && std::isfinite(solution.moment) &&
                      solution.pressure.isFinite().all() && solution.traction.isFinite().all();
  if (solution.status == Status::converged && !finite) {
    throw std::domain_error("the answer in the scene's units");
  }
}

}  // namespace

StepNumbers to_si(StepNumbers numbers, const Model& model) {
  const double length = model.length_unit;
  const double area = model.grid.cell_area();
  auto& [contact, stick, loads, energy, quality] = numbers;
  contact.normal_load *= model.force_unit();
  contact.peak_pressure *= model.stress_unit;
  for (double* const number : {&contact.approach, &contact.contact_radius, &contact.contact_radius_counted,
                               &stick.stick_radius, &stick.stick_radius_counted})
    *number *= length;
  // The mesh leaves more of the stick area open than counting does.
  stick.stick_area.uncertainty += quality.resolution.stick_area * model.grid_in_m().cell_area();
  for (double& shift : loads.displacement) shift *= length;
  for (double* const force : {&loads.force[0], &loads.force[1], &loads.friction_force})
    *force *= area * model.force_unit();
  for (double* const number : {&loads.moment, &loads.moment_limit, &energy.elastic_energy, &energy.dissipated,
                               &energy.work, &quality.certificate.energy})
    *number *= area * model.moment_unit();
  if (loads.limit.centre) {
    for (double& x : *loads.limit.centre) x *= length;
  }
  quality.resolution.open.displacement *= length;
  return numbers;
}

Solution to_si(StepResult result, const Model& model) {
  StepNumbers numbers = to_si(std::move(result.numbers), model);
  TangentialSolution& tangential = result.solved.tangential;
  const double stress = model.stress_unit;
  const double length = model.length_unit;
  Solution solution;
  static_cast<SolutionFields&>(solution) = {
      .grid = model.grid_in_m(),
      .pressure = times(std::move(result.solved.normal.pressure), stress),
      .traction = times(std::move(tangential.traction), stress),
      .elastic_displacement = times(std::move(tangential.elastic_displacement), length),
      .slip = times(std::move(tangential.slip), length),
      .stick = std::move(tangential.stick)};
  static_cast<ContactNumbers&>(solution) = numbers.contact;
  static_cast<StickNumbers&>(solution) = std::move(numbers.stick);
  static_cast<LoadNumbers&>(solution) = numbers.loads;
  static_cast<EnergyNumbers&>(solution) = numbers.energy;
  static_cast<QualityNumbers&>(solution) = numbers.quality;
  static_cast<WorkNumbers&>(solution) = std::move(result.work);
  solution.status = result.status;
  solution.message = std::move(result.message);
  solution.loads = std::move(result.step.loads);
  solution.detail = result.step.detail;
  solution.friction = model.friction.to_dimensionless(1.0 / stress);
  solution.shear_modulus = stress;
  solution.coupled = model.pressure_coupling && model.law->couples();
  solution.left_out = std::move(result.left_out);
  require_finite(solution);
  return solution;
}

}  // namespace slipstick::solver
