#include "solver/step/solve_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "solver/contact/full_coupling.hpp"
#include "solver/elasticity/elasticity.hpp"
#include "solver/grid/grid_transfer.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/step/pressure.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Rounding of a sum over a million cells, relative to the sum of sizes.
constexpr double kSumRounding = 1e-12;
/// Rounding of the duality gap, in which sums cancel, relative to the energy.
constexpr double kGapRounding = 1e-13;
/// Pressure and shear of a coarse grid agree up to this part of their first gap, which is about the error of
/// the mesh, and the first turn of the next grid is solved to the same gap.
constexpr double kPartOfFirstTurn = 0.3;

/// The bounds that a result's certificate must keep. The paper's method stops on change, Eq. (26), and freezes slip
/// directions: it promises no gap. Loads and friction bounds are met to the tolerance, or to rounding. The other
/// methods have stopped on the gap of the part of the grid that they solved; the whole grid's differs by rounding.
CertificateBounds promised(const Scene& scene) {
  const double loads = std::max(scene.solver.tolerance, kSumRounding);
  const double gap = scene.solver.method == Method::paper ? std::numeric_limits<double>::infinity()
                                                          : scene.solver.tolerance + kGapRounding;
  return {.gap = gap, .moment = loads, .force = loads, .friction_bound = loads};
}

RigidMotion moved(const RigidMotion& before, const TangentialSolution& tangential) {
  return {before.delta1 + tangential.displacement[0], before.delta2 + tangential.displacement[1],
          before.twist + tangential.twist};
}

/// ContactState::slip after a step that is not the first.
ArrayXd slip_onwards(const ContactState& before, const SolvedStep& solved) {
  const TangentialSolution& tangential = solved.tangential;
  if ((solved.normal.pressure > 0.0 && before.normal.pressure == 0.0).any()) return {};
  if (before.slip.size() == 0) return tangential.slip;
  const ArrayXd onwards = (tangential.stick == 0.0 && dot_products(before.slip, tangential.slip) > 0.0).cast<double>();
  return tangential.slip + onwards.replicate(2, 1) * before.slip;
}

struct Found {
  SolvedStep solved;
  WorkNumbers work;
  std::vector<Omission> left_out;
  double first_gap = 0.0;  ///< of full coupling, after its first turn
};

/// The same contact on a coarse grid.
Model coarsened(const Model& model, const Grid& coarse) {
  Model there = model;
  there.grid = coarse;
  there.gap = coarsened_gap(coarse, model.grid, model.gap);
  there.friction = resampled(model.friction, model.grid, coarse, {});
  return there;
}

/// The contact before a step, as far as the step on a coarse grid needs it.
ContactState coarsened(const ContactState& before, const Grid& grid, const Grid& coarse) {
  ContactState there;
  if (before.untouched()) return there;
  there.normal.pressure = restrict_to(coarse, grid, before.normal.pressure);
  there.traction = restrict_to(coarse, grid, before.traction);
  there.motion = before.motion;
  there.energy = before.energy * grid.cell_area() / coarse.cell_area();
  return there;
}

/// before + the change on a coarse grid since that state, which there is `start`; both may be empty: zero.
ArrayXd with_change(const ArrayXd& before, const ArrayXd& start, const Grid& grid, const Grid& coarse,
                    const ArrayXd& there) {
  constexpr std::array<Parity, 2> kParities{};
  const std::span components(kParities.data(), static_cast<std::size_t>(there.size() / coarse.cells()));
  if (before.size() == 0) return prolong_to(grid, coarse, there, components);
  return before + prolong_to(grid, coarse, there - start, components);
}

Found solve_coupled(const Scene& scene, const Model& model, const Step& step, const ContactState& before,
                    const Progress& progress, bool is_coarse);

/// Pressure and tractions of the coarse grid, solved to the error of the mesh. Adds to the work.
CoupledGuess guess_from_coarse_grid(const Scene& scene, const Model& model, const Step& step,
                                    const ContactState& before, WorkNumbers& work) {
  const Grid& grid = model.grid;
  CoupledGuess guess{before.untouched() ? ArrayXd::Zero(2 * grid.cells()) : before.traction};
  if (!can_coarsen(grid)) return guess;
  const Grid coarse = coarser(grid);
  const ContactState start = coarsened(before, grid, coarse);
  const Found found = solve_coupled(scene, coarsened(model, coarse), step, start, {}, true);
  const double cells = static_cast<double>(coarse.cells()) / static_cast<double>(grid.cells());
  work.pressure_applications = cells * found.work.pressure_applications;
  work.operator_applications = cells * found.work.operator_applications;
  work.safeguards = found.work.safeguards;
  const auto& [loads, normal, tangential] = found.solved;
  if (normal.status != Status::converged || tangential.status != Status::converged) return guess;
  guess.pressure = with_change(before.normal.pressure, start.normal.pressure, grid, coarse, normal.pressure).max(0.0);
  guess.traction = with_change(before.traction, start.traction, grid, coarse, tangential.traction);
  guess.gap = kPartOfFirstTurn * found.first_gap;
  return guess;
}

/// Pressure and tractions, each under the other.
Found solve_coupled(const Scene& scene, const Model& model, const Step& step, const ContactState& before,
                    const Progress& progress, bool is_coarse) {
  const Reduction whole(model.grid);
  Found found;
  LoadStep& loads = found.solved.loads;
  const CoupledProblem problem{
      .gap = model.gap,
      .guess = guess_from_coarse_grid(scene, model, step, before, found.work),
      .tolerance = scene.solver.tolerance,
      .part_of_first_gap = is_coarse ? kPartOfFirstTurn : 0.0,
      .friction_bound = [&](const ArrayXd& pressure) { return model.friction.bound(pressure); },
      .solve_pressure =
          [&](const ArrayXd& opening, const StaggeredTarget& goal) {
            NormalSolution normal = find_pressure(scene, model, step, opening, goal, progress);
            found.work.pressure_applications += finest_grid_applications(normal.grids);
            found.work.safeguards += normal.safeguards;
            return normal;
          },
      .solve_tractions =
          [&](const ArrayXd& pressure, const StaggeredTarget& goal) {
            loads = load_step(scene, model, step, pressure, before);
            if (!loads.carried()) return TangentialSolution{};
            FoundTractions tractions = find_tractions(scene, model, std::move(loads), pressure, before, progress, goal);
            loads = std::move(tractions.loads);
            found.left_out = std::move(tractions.left_out);
            found.work.operator_applications += finest_grid_applications(tractions.solution.grids);
            found.work.safeguards += tractions.solution.safeguards;
            return std::move(tractions.solution);
          }};
  CoupledSolution coupled = solve_fully_coupled(elasticity(scene, model, whole), model.grid, problem);
  if (!is_coarse) require_carried(scene, model, step, loads);
  if (!is_coarse && coupled.tangential.status == Status::converged) {
    require_contact_within_grid(scene, model, step, coupled.normal, coupled.tangential.traction);
  }
  found.first_gap = coupled.first_gap;
  found.solved.normal = std::move(coupled.normal);
  found.solved.tangential = std::move(coupled.tangential);
  found.work.turns = coupled.turns;
  return found;
}

Found solve_in_sequence(const Scene& scene, const Model& model, const Step& step, const ContactState& before,
                        const Progress& progress) {
  Stopwatch watch(model.cache.get());
  Found found;
  WorkNumbers& work = found.work;
  NormalSolution& normal = found.solved.normal;
  if (before.untouched() || before.normal_load != step.normal) {
    normal = find_pressure(scene, model, step, {}, {}, progress);
    work.pressure_applications = finest_grid_applications(normal.grids);
    work.safeguards = normal.safeguards;
    require_contact_within_grid(scene, model, step, normal);
  } else {
    normal = before.normal;
  }
  work.seconds.pressure = watch.lap();
  LoadStep loads = load_step(scene, model, step, normal.pressure, before);
  require_carried(scene, model, step, loads);
  FoundTractions tractions = find_tractions(scene, model, std::move(loads), normal.pressure, before, progress);
  work.operator_applications = finest_grid_applications(tractions.solution.grids);
  work.safeguards += tractions.solution.safeguards;
  work.seconds.traction = watch.lap();
  found.solved.loads = std::move(tractions.loads);
  found.solved.tangential = std::move(tractions.solution);
  found.left_out = std::move(tractions.left_out);
  return found;
}

/// Adds predictions, and the numbers of the two solves.
WorkNumbers work_of(const Scene& scene, const Model& model, const SolvedStep& solved, WorkNumbers work) {
  const bool pressed = work.pressure_applications > 0.0;
  const CandidateFraction parts{pressed ? solved.normal.part : 0.0, solved.tangential.part};
  work.bytes = predicted_memory(scene, model).solver;
  work.predicted_bytes = predicted_memory(scene, model, parts).total();
  work.threads = model.threads;
  work.iterations = solved.tangential.iterations;
  work.change = solved.tangential.change;
  work.grids = solved.tangential.grids;
  work.pressure_iterations = solved.normal.iterations;
  work.pressure_complementarity = solved.normal.complementarity;
  return work;
}

std::string message_of(const SolvedStep& solved) {
  std::string message;
  if (!solved.normal.message.empty()) message = "pressure: " + solved.normal.message;
  if (!solved.tangential.message.empty())
    message += (message.empty() ? "traction: " : "; traction: ") + solved.tangential.message;
  return message;
}

ArrayXd times(ArrayXd field, double unit) {
  if ((field != 0.0).any()) field *= unit;  // see zeros()
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

StepResult solve_step(const Scene& scene, const Model& model, const StepLoads& step, const ContactState& before,
                      const Progress& progress) {
  Stopwatch watch(model.cache.get());
  const KeptRounding rounding;  // solves that draw their rounding change it
  Found found = model.shear_coupling && model.law->couples()
                    ? solve_coupled(scene, model, step.loads, before, progress, false)
                    : solve_in_sequence(scene, model, step.loads, before, progress);
  StepResult result;
  result.step = step;
  result.solved = std::move(found.solved);
  result.left_out = std::move(found.left_out);
  SolvedStep& solved = result.solved;
  TangentialSolution& tangential = solved.tangential;
  result.work = work_of(scene, model, solved, std::move(found.work));
  result.motion = moved(before.motion, tangential);
  const ArrayXd onwards = before.untouched() ? ArrayXd() : slip_onwards(before, solved);
  result.numbers =
      describe_step(scene, model, step, solved, result.motion, before.untouched() ? tangential.slip : onwards);
  result.message = message_of(solved);
  if (solved.normal.status == Status::converged && tangential.status == Status::converged) {
    result.message = violated_bounds(result.numbers.certificate, promised(scene));
    if (result.message.empty()) result.status = Status::converged;
  }
  if (step.detail == Detail::all) {
    tangential.slip = complete_slip(std::move(tangential.slip), tangential, scene, model,
                                    solved.loads.problem.friction_bound, solved.normal.pressure, before);
  }
  result.work.seconds.total = watch.lap();
  return result;
}

ContactState contact_after(const ContactState& before, const StepResult& step) {
  const SolvedStep& solved = step.solved;
  return {.normal = solved.normal,
          .normal_load = step.step.loads.normal,
          .traction = solved.tangential.traction,
          .slip = before.untouched() ? solved.tangential.slip : slip_onwards(before, solved),
          .motion = step.motion,
          .energy = std::max(solved.loads.problem.energy_before, step.numbers.certificate.energy)};
}

StepNumbers to_si(StepNumbers numbers, const Model& model) {
  const double length = model.length_unit;
  const double area = model.grid.cell_area();
  numbers.normal_load *= model.force_unit();
  numbers.peak_pressure *= model.stress_unit;
  for (double* const number : {&numbers.approach, &numbers.contact_radius, &numbers.contact_radius_counted,
                               &numbers.stick_radius, &numbers.stick_radius_counted})
    *number *= length;
  // The mesh leaves more of the stick area open than counting does.
  numbers.stick_area.uncertainty += numbers.resolution.stick_area * model.grid_in_m().cell_area();
  for (double& shift : numbers.displacement) shift *= length;
  for (double* const force : {&numbers.force[0], &numbers.force[1], &numbers.friction_force})
    *force *= area * model.force_unit();
  for (double* const number : {&numbers.moment, &numbers.moment_limit, &numbers.elastic_energy, &numbers.dissipated,
                               &numbers.work, &numbers.certificate.energy})
    *number *= area * model.moment_unit();
  if (numbers.limit.centre) {
    for (double& x : *numbers.limit.centre) x *= length;
  }
  numbers.resolution.open.displacement *= length;
  return numbers;
}

Solution to_si(StepResult result, const Model& model) {
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
  static_cast<StepNumbers&>(solution) = to_si(std::move(result.numbers), model);
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
