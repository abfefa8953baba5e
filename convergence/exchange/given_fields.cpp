#include "convergence/exchange/given_fields.hpp"

#include <utility>

#include "convergence/exchange/given_contact.hpp"
#include "solver/contact/fitted_motion.hpp"
#include "solver/history/history_state.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"
#include "solver/step/pressure.hpp"
#include "solver/step/resolution.hpp"
#include "solver/step/solve_step.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using namespace solver;

ArrayXd applied(const Scene& scene, const Model& model, const solver::BlockKernel& kernel, const ArrayXd& to) {
  return solver::elasticity(scene, model, solver::Reduction(model.grid)).make(model.grid, kernel)->applied(to);
}

/// A pressure as the answer to the normal contact: the surfaces' approach is the mean gap under it; the
/// energy of the gaps above the least one is its complementarity.
NormalSolution describe_pressure(const Scene& scene, const Model& model, const ArrayXd& pressure) {
  NormalSolution normal;
  normal.status = solver::Status::converged;
  normal.pressure = pressure;
  if (scene.contact.pressure != solver::PressureModel::solved) return normal;
  const ArrayXd displacement = applied(scene, model, solver::normal_kernel(), pressure);
  const ArrayXd gap = (pressure > 0.0).select(displacement + model.gap, 0.0);
  const double total = pressure.sum();
  normal.approach = (pressure * gap).sum() / total;
  const double least = (displacement + model.gap).minCoeff();
  normal.complementarity = 2.0 * ((pressure * gap).sum() - least * total) / (pressure * displacement).sum();
  return normal;
}

TangentialSolution describe_tractions(const Scene& scene, const Model& model, const TangentialProblem& problem,
                                      const ArrayXd& pressure, const ArrayXd& traction) {
  const GivenContact contact(model, solver::elasticity(scene, model, solver::Reduction(model.grid)), {}, pressure,
                             traction);
  const bool translates = problem.force || problem.displacement;
  State state =
      find_state(contact, {.twist = problem.twist, .displacement = problem.displacement, .translates = translates});
  const ArrayXd& bound = problem.friction_bound;
  TangentialSolution found;
  found.status = solver::Status::converged;
  found.traction = traction;
  found.elastic_displacement = contact.elastic_displacement;
  found.slip = std::move(state.slip);
  found.stick = ((bound > 0.0) && solver::norms(traction) < (1.0 - solver::kOnCircle) * bound).cast<double>();
  found.twist = state.twist;
  found.displacement = state.displacement;
  return found;
}

void require_one_load(const Scene& scene) {
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  if (steps == 1 && scene.solver.substeps == 1) return;
  throw InputError(scene.source.string(), scene.solver.substeps == 1 ? "step" : "solver.substeps",
                   std::to_string(steps * static_cast<std::size_t>(scene.solver.substeps)),
                   "one load, with solver.program: a field does not show the steps before");
}

}  // namespace

solver::Solution describe_given(Scene scene, const GivenFields& fields) {
  scene.solver.method = solver::Method::coulomb;  // others know less than a field may be
  solver::validate(scene);
  require_one_load(scene);
  const Model model = solver::make_model(scene);
  const Index cells = model.grid.cells();
  if (fields.pressure.size() != cells || fields.traction.size() != 2 * cells) {
    throw std::invalid_argument("fields of another grid");
  }
  solver::StepResult result;
  result.status = solver::Status::converged;
  result.step.loads = scene.steps.front();
  solver::SolvedStep& solved = result.solved;
  solved.normal = describe_pressure(scene, model, fields.pressure / model.stress_unit);
  solved.loads = solver::load_step(scene, model, result.step.loads, solved.normal.pressure, {});
  solved.tangential = describe_tractions(scene, model, solved.loads.problem, solved.normal.pressure,
                                         fields.traction / model.stress_unit);
  const auto& [shift1, shift2] = solved.tangential.displacement;
  result.motion = {shift1, shift2, solved.tangential.twist};
  result.numbers = solver::describe_step(scene, model, result.step, solved, result.motion, solved.tangential.slip);
  result.work.threads = model.threads;
  result.work.pressure_complementarity = solved.normal.complementarity;
  solver::Solution solution = solver::to_si(std::move(result), model);
  solver::OpenHistory open;
  open.add({}, solution, solution.resolution);
  solution.resolution = solver::with_uncertainty(solution, scene, 0, open.mesh());
  return solution;
}

PosedScene pose(Scene scene, bool with_limit) {
  scene.solver.method = solver::Method::coulomb;
  solver::validate(scene);
  require_one_load(scene);
  const Model model = solver::make_model(scene);
  const solver::ElasticPair& pair = model.pair;
  PosedScene posed{.grid = model.grid_in_m(),
                   .gap = model.gap * model.length_unit,
                   .pressure = {},
                   .contact_modulus = pair.effective_modulus() * model.stress_unit,
                   .shear_modulus = pair.shear_modulus() * model.stress_unit,
                   .poisson_ratio = pair.poisson_compliance / pair.shear_compliance,
                   .mismatch = model.pressure_coupling ? pair.mismatch / model.stress_unit : 0.0,
                   .coupled = model.pressure_coupling && model.law->couples(),
                   .moment_limit = 0.0};
  const bool given = scene.contact.pressure != solver::PressureModel::solved;
  if (!given && !with_limit) return posed;
  const ArrayXd pressure = solver::find_pressure(scene, model, scene.steps.front()).pressure;
  if (given) posed.pressure = pressure * model.stress_unit;
  if (with_limit) {
    Step unloaded;
    unloaded.normal = scene.steps.front().normal;
    posed.moment_limit = solver::load_step(scene, model, unloaded, pressure, {}).moment_limit * model.grid.cell_area() *
                         model.moment_unit();
  }
  return posed;
}

}  // namespace slipstick::convergence
