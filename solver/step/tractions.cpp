#include "solver/step/tractions.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "solver/contact/coulomb_method.hpp"
#include "solver/contact/paper_method.hpp"
#include "solver/grid/own_rows.hpp"
#include "solver/grid/reduction.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/model/symmetry.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Relative difference of two pressures that are mirror images but for the rounding of their solve, and of
/// displacements by transforms.
constexpr double kMirrorRounding = 1e-12;
/// A factor of the loads this close to 1 is not printed.
constexpr double kNextTo = 1e-5;

/// Tangential displacement by the change of pressure, Eq. (12).
ArrayXd pressure_displacement(const Scene& scene, const Model& model, const ArrayXd& pressure,
                              const ContactState& before) {
  if (!moves_by_pressure(scene, model)) return {};
  const auto op = elasticity(scene, model, Reduction(model.grid)).make(model.grid, coupling_kernel());
  ArrayXd u = op->applied(!before.untouched() ? ArrayXd(pressure - before.normal.pressure) : pressure);
  // A single cell does not move itself: what transforms leave there is no displacement.
  const double in_contact = ((pressure > 0.0).cast<double>().replicate(2, 1) * u).abs().maxCoeff();
  return in_contact <= kMirrorRounding * u.abs().maxCoeff() ? ArrayXd() : u;
}

/// How a body would slide, in words; lengths in the scene's unit.
std::string sliding_text(const LimitLoad& limit, double length_unit) {
  if (limit.centre) {
    return fmt::format("turning about ({:.4g}, {:.4g}) m", (*limit.centre)[0] * length_unit,
                       (*limit.centre)[1] * length_unit);
  }
  const double size = std::hypot(limit.sliding.delta1, limit.sliding.delta2);
  return fmt::format("along ({:.4g}, {:.4g})", limit.sliding.delta1 / size, limit.sliding.delta2 / size);
}

[[noreturn]] void refuse(const Scene& scene, const Model& model, const Step& step, const LoadStep& loads) {
  const std::string file = scene.source.string();
  const std::string sliding = sliding_text(loads.limit, model.length_unit);
  const auto moment = value_if<Moment>(step.torsion);
  if (moment && step.force == std::array<double, 2>{}) {
    throw InputError(
        file, step.key + ".moment", fmt::format("{} N m", *moment),
        fmt::format("below {:.17g} N m in size, the limit moment of this pressure and mesh; at or above it the "
                    "contact slips everywhere, {}",
                    loads.moment_limit * model.grid.cell_area() * model.moment_unit(), sliding));
  }
  // Next to 1 the factor does not say which side of the limit the loads are on: their numbers do.
  const double factor = loads.limit.factor;
  const std::string times = std::abs(factor - 1.0) > kNextTo ? fmt::format("{:.6g} times these", factor)
                                                             : fmt::format("these up to {:g}", kNextTo);
  const auto ratio = value_if<MomentRatio>(step.torsion);
  if (ratio && loads.moment_limit == 0.0) {
    throw InputError(file, step.key + ".moment_ratio", fmt::format("{}", *ratio),
                     "0, since this contact carries no moment: its friction is zero wherever there is "
                     "pressure, or in all cells but one");
  }
  const bool turned = ratio && step.force == std::array<double, 2>{};
  const double torsion = loads.problem.moment.value_or(0.0) * model.grid.cell_area() * model.moment_unit();
  throw InputError(
      file, step.key + (turned ? ".moment_ratio" : ".force"),
      turned ? fmt::format("{}", *ratio) : fmt::format("[{}, {}] N", step.force[0], step.force[1]),
      fmt::format("loads below what this pressure and mesh can carry, which is {}: [{:.17g}, {:.17g}] N and "
                  "{:.17g} N m; at or beyond that the contact slips everywhere, {}",
                  times, factor * step.force[0], factor * step.force[1], factor * torsion, sliding));
}

/// The other methods solve torsion about the grid's origin only. The part of the pressure that is odd under
/// half a turn leaves a force that nothing balances. Over mu times the load, that part bounds the force where
/// all of the contact slips; it may be as large as the tolerance of the tractions.
void require_centred(const Scene& scene, const ArrayXd& bound) {
  const double odd = 0.5 * (bound - bound.reverse()).abs().sum() / bound.sum();
  const double allowed = std::max(scene.solver.tolerance, kMirrorRounding);
  if (odd <= allowed) return;
  throw InputError(
      scene.source.string(), "solver.method", fmt::format("\"{}\"", to_string(scene.solver.method)),
      fmt::format("coulomb, or a contact that half a turn about the origin brings onto itself: this method knows "
                  "torsion about the origin only, and {:.3g} of this pressure is odd (allowed: {:.3g})",
                  odd, allowed));
}

[[noreturn]] void refuse_infinite(const Scene& scene) {
  throw InputError(scene.source.string(), "contact.friction", fmt::format("{}", scene.contact.friction.coefficient),
                   "a law that is finite under the pressure of every cell");
}

/// The limit under a moment without force, from the limit under a unit moment.
LimitLoad under_moment(LimitLoad unit, double moment) {
  const auto [delta1, delta2, twist] = unit.sliding;
  return {unit.factor / std::abs(moment),
          unit.carried / std::abs(moment),
          {delta1 / moment, delta2 / moment, twist / moment},
          unit.centre};
}

void impose_turning(TangentialProblem& problem, const Model& model, const Step& step, double moment_limit,
                    const RigidMotion& before) {
  if (const auto twist = value_if<Twist>(step.torsion)) {
    problem.twist = *twist - before.twist;
  } else if (const auto ratio = value_if<MomentRatio>(step.torsion)) {
    problem.moment = *ratio * moment_limit;
  } else {
    problem.moment =
        to_dimensionless(std::get<Moment>(step.torsion).value, model.moment_unit()) / model.grid.cell_area();
  }
}

void impose_translation(TangentialProblem& problem, const Model& model, const Step& step, const RigidMotion& before) {
  if (step.displacement) {
    problem.displacement = {to_dimensionless((*step.displacement)[0], model.length_unit) - before.delta1,
                            to_dimensionless((*step.displacement)[1], model.length_unit) - before.delta2};
  } else {
    const double unit = model.force_unit();
    const double area = model.grid.cell_area();
    problem.force = {to_dimensionless(step.force[0], unit) / area, to_dimensionless(step.force[1], unit) / area};
  }
}

/// Energy scales with the square of the loads over the contact's size: the energy of the states before is
/// reduced to the part that the friction bounds can still hold.
double energy_before(const FrictionLaw& friction, const ArrayXd& pressure, const ContactState& before) {
  if (before.energy == 0.0) return 0.0;
  const double load = friction.bound(pressure).sum() / friction.bound(before.normal.pressure).sum();
  const double cells = static_cast<double>((pressure > 0.0).count());
  const double size = std::sqrt(cells / static_cast<double>((before.normal.pressure > 0.0).count()));
  return before.energy * std::min(1.0, load * load / size);
}

void expand(TangentialSolution& solution, const Reduction& part, const Grid& whole) {
  if (!part.trimmed() && !part.quadrant()) return;
  ArrayXd& u = solution.elastic_displacement;
  share_rows(part.grid(), u);
  for (ArrayXd* const field : {&solution.traction, &solution.elastic_displacement, &solution.slip}) {
    *field = (*field == 0.0).all() ? zeros(2 * whole.cells()) : part.expanded(std::move(*field), torsion_symmetry());
  }
  solution.stick = part.expanded(solution.stick, normal_symmetry());
}

/// gap: relative duality gap at which Coulomb's method may stop; 0: the scene's tolerance.
TangentialSolution solve_on(const Scene& scene, const Model& model, const Reduction& part, TangentialProblem problem,
                            const Progress& progress, double gap) {
  const Elasticity elastic = elasticity(scene, model, part);
  if (scene.solver.method == Method::coulomb) {
    return solve_by_coulomb_method(elastic, part.grid(), std::move(problem),
                                   {.tolerance = std::max(scene.solver.tolerance, gap),
                                    .max_applications = scene.solver.max_iterations,
                                    .refine_motion = gap == 0.0,
                                    .progress = progress,
                                    .on_cells_known = [&](double of_cells) {
                                      require_memory(scene, model, {.pressure = 0.0, .tractions = of_cells});
                                    }});
  }
  const auto op = elastic.make(part.grid(), tangential_kernel());
  TangentialSolution solution = solve_by_paper_method(
      *op, problem,
      {.tolerance = scene.solver.tolerance, .max_iterations = scene.solver.max_iterations, .progress = progress});
  solution.grids = {{part.grid().n1, part.grid().n2, op->applications(), solution.iterations, solution.change}};
  return solution;
}

}  // namespace

LoadStep load_step(const Scene& scene, const Model& model, const Step& step, const ArrayXd& pressure,
                   const ContactState& before) {
  if (scene.solver.method != Method::coulomb) require_centred(scene, pressure);
  LoadStep loads{};
  loads.is_coulomb = model.friction.is_coulomb();
  TangentialProblem& problem = loads.problem;
  problem.friction_bound = model.friction.bound(pressure);
  if (!problem.friction_bound.isFinite().all()) refuse_infinite(scene);
  problem.initial_displacement = pressure_displacement(scene, model, pressure, before);
  problem.start = before.traction;
  problem.energy_before = energy_before(model.friction, pressure, before);
  const bool translations = has_translations(scene, model, pressure, before.untouched());
  const LimitLoad unit = translations ? find_limit(model.grid, problem.friction_bound, {0.0, 0.0, 1.0}) : LimitLoad{};
  loads.moment_limit = translations ? unit.factor : moment_limit(model.grid, problem.friction_bound);
  impose_turning(problem, model, step, loads.moment_limit, before.motion);
  if (translations) impose_translation(problem, model, step, before.motion);
  const double moment = problem.moment.value_or(0.0);
  const bool turned = translations && moment != 0.0 && problem.force == std::array<double, 2>{};
  loads.limit = turned ? under_moment(unit, moment) : limit_of(problem, model.grid);
  const auto ratio = value_if<MomentRatio>(step.torsion);
  if (ratio.value_or(0.0) != 0.0 && loads.moment_limit == 0.0) loads.limit.factor = loads.limit.carried = 0.0;
  problem.limit_factor = loads.limit.factor;
  return loads;
}

void require_carried(const Scene& scene, const Model& model, const Step& step, const LoadStep& loads) {
  if (!loads.carried()) refuse(scene, model, step, loads);
}

FoundTractions find_tractions(const Scene& scene, const Model& model, LoadStep loads, const ArrayXd& pressure,
                              const ContactState& before, const Progress& progress, const StaggeredTarget& goal) {
  const Reduction part = traction_part(scene, model, pressure, before.normal.pressure);
  const bool translations = loads.problem.force || loads.problem.displacement;
  TangentialProblem problem = reduced(loads.problem, part);
  problem.guess = part.restricted(goal.guess);
  TangentialSolution solution = solve_on(scene, model, part, std::move(problem), progress, goal.gap);
  expand(solution, part, model.grid);
  loads.problem.friction_bound = model.friction.bound(pressure);
  return {std::move(loads), std::move(solution), omissions(scene, model, part, translations)};
}

ArrayXd complete_slip(ArrayXd slip, const TangentialSolution& solution, const Scene& scene, const Model& model,
                      const ArrayXd& bound, const ArrayXd& pressure, const ContactState& before) {
  const auto free = ((pressure > 0.0) && (bound == 0.0)).replicate(2, 1);
  if (!free.any()) return slip;
  const bool rests = solution.twist == 0.0 && solution.displacement == std::array<double, 2>{};
  if (scene.contact.friction.is_frictionless() && rests && !moves_by_pressure(scene, model)) return slip;  // zero
  const Reduction part = traction_part(scene, model, pressure, before.normal.pressure);
  ArrayXd u =
      part.restricted(before.traction.size() > 0 ? ArrayXd(solution.traction - before.traction) : solution.traction);
  elasticity(scene, model, part).make(part.grid(), tangential_kernel())->apply(u, u);
  u = part.expanded(std::move(u), torsion_symmetry());
  if (const ArrayXd pressed = pressure_displacement(scene, model, pressure, before); pressed.size() > 0) u += pressed;
  const Index cells = pressure.size();
  u.head(cells) -= solution.displacement[0];
  u.tail(cells) -= solution.displacement[1];
  u -= solution.twist * rotation_field(model.grid);
  slip = free.select(u, slip);
  return slip;
}

}  // namespace slipstick::solver
