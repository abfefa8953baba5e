#include "convergence/check/deviation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solver/contact/coulomb_method.hpp"
#include "solver/contact/fitted_motion.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Grid;
using solver::Index;

/// Part of mu p by which rounding may change |q| of a slipping cell.
constexpr double kExactlyOnCircle = 1e-9;
/// Cells of a slip ring: a median over fewer would show the ring's edges.
constexpr std::size_t kMinSlipping = 8;

/// The error of the rigid motion in the mean over the contact, weighted with mu p and relative to the motion
/// or to the displacements, whichever are larger. Its sign is that of the change in size.
double motion_error(const GivenContact& c, const RightAnswer& right, const State& state) {
  const auto size = [&](const ArrayXd& motion) { return (c.friction_bound * solver::norms(motion)).sum(); };
  const auto about_origin = [&](const std::array<double, 2>& displacement, double twist) {
    ArrayXd motion = twist * c.rotation;
    motion.head(c.pressure.size()) += displacement[0];
    motion.tail(c.pressure.size()) += displacement[1];
    return motion;
  };
  const ArrayXd found = about_origin(state.displacement, state.twist);
  const ArrayXd expected = about_origin(right.displacement, right.twist);
  return std::copysign(size(found - expected), size(found) - size(expected)) /
         std::max(size(expected), size(c.displacement));
}

/// |q| over a bound, less 1, in the slip ring, in order; empty where hardly any cell slips.
std::vector<double> ring_excess(const GivenContact& contact, const ArrayXd& bound, const RightAnswer& right) {
  const std::vector<Index> ring = slip_ring(contact, right);
  if (ring.size() < kMinSlipping) return {};
  const ArrayXd size = solver::norms(contact.traction);
  std::vector<double> excess;
  for (const Index cell : ring) excess.push_back(size[cell] / bound[cell] - 1.0);
  std::ranges::sort(excess);
  return excess;
}

/// The median of an ordered excess, and the spread between its quartiles.
struct Plateau {
  explicit Plateau(const std::vector<double>& excess)
      : middle(excess[excess.size() / 2]),
        spread(excess[excess.size() * 3 / 4] - excess[excess.size() / 4]) {}

  double middle;
  double spread;
};

/// Another law, whose bound under its unit coefficient or strength is given, where the ring follows it.
std::optional<OtherFriction> other_law(const GivenContact& contact, const RightAnswer& right,
                                       solver::FrictionKind kind) {
  constexpr double kFollows = 0.02;  // spread between the quartiles, over |q| itself
  solver::FrictionLaw law = 1.0;
  law.kind = kind;
  law.shear_strength = 1.0;
  const ArrayXd unit = law.bound(contact.pressure);
  const Plateau shown(ring_excess(contact, unit, right));
  const double factor = 1.0 + shown.middle;
  if (kind == contact.friction.kind || !(shown.spread <= kFollows * factor)) return std::nullopt;
  const std::string name =
      kind == solver::FrictionKind::tresca
          ? fmt::format("Tresca's law, with a shear strength of {:.4g} Pa,", factor * contact.stress_unit)
          : fmt::format("Coulomb's law, with a coefficient of {:.4g},", factor);
  return OtherFriction{
      fmt::format("{} in place of friction_law = \"{}\"", name, solver::to_string(contact.friction.kind)),
      factor * unit};
}

bool is_above_limit(double factor) { return !(factor > 1.0 - kBelowLimit); }

}  // namespace

double solved_multiple(double factor) {
  if (is_above_limit(factor)) return kScaledLoads * factor;
  return factor > 1.0 + kBelowLimit ? 1.0 : (1.0 - kBelowLimit) * factor;
}

void scale_loads(solver::TangentialProblem& problem, double factor) {
  if (problem.moment) *problem.moment *= factor;
  if (!problem.force) return;
  for (double& force : *problem.force) force *= factor;
}

solver::TangentialSolution solve_problem(const GivenContact& contact, const Grid& grid,
                                         const solver::TangentialProblem& problem) {
  solver::TangentialSolution solution = solve_by_coulomb_method(contact.elasticity, grid, problem);
  const bool usable = solution.status == solver::Status::converged || solution.change <= kIterationGap;
  if (!usable) throw std::runtime_error("the right answer to judge by was not found: " + solution.message);
  return solution;
}

RightAnswer find_right_answer(const GivenContact& contact, const solver::Step& load) {
  const Grid& grid = contact.grid;
  solver::TangentialProblem problem = own_problem(contact, load);
  const double factor = solver::limit_of(problem, grid).factor;
  scale_loads(problem, solved_multiple(factor));
  const solver::TangentialSolution solution = solve_problem(contact, grid, problem);
  return {.traction = solution.traction,
          .twist = solution.twist,
          .displacement = {solution.displacement[0] + solution.twist * contact.centre[1],
                           solution.displacement[1] - solution.twist * contact.centre[0]},
          .scaled = is_above_limit(factor)};
}

State find_state(const GivenContact& c, const solver::Step& load, std::optional<double> twist) {
  // A gap is not negative only where |q| is within its bound.
  const ArrayXd bound =
      c.friction_bound.max(solver::norms(c.traction) * (c.friction_bound > 0.0).cast<double>());
  const RigidMotions motions = rigid_motions(c, load, twist);
  solver::FittedMotion fitted =
      solver::fit_motion(c.displacement - motions.imposed, c.traction, bound, motions.free);
  const auto& found = fitted.coefficients;
  State state{.twist = twist ? *twist : found[found.size() - 1],
              .displacement = {},
              .slip = std::move(fitted.slip),
              .gap = std::move(fitted.gap)};
  for (std::size_t k = 0; k < 2; ++k) {
    state.displacement[k] =
        load.displacement ? (*load.displacement)[k] / c.length_unit : found[static_cast<Index>(k)];
  }
  return state;
}

std::vector<Index> slip_ring(const GivenContact& contact, const RightAnswer& right) {
  const ArrayXd size = solver::norms(right.traction);
  const double least = kNextToNothing * contact.friction_bound.maxCoeff();
  std::vector<Index> cells;
  for (Index cell = 0; cell < size.size(); ++cell) {
    const double bound = contact.friction_bound[cell];
    if (bound > least && size[cell] >= (1.0 - kExactlyOnCircle) * bound) cells.push_back(cell);
  }
  return cells;
}

std::optional<OtherFriction> friction_shown(const GivenContact& contact, const RightAnswer& right) {
  constexpr double kConstant = 0.2;  // spread between the quartiles, over the median excess
  const std::vector<double> excess = ring_excess(contact, contact.friction_bound, right);
  if (excess.empty()) return std::nullopt;
  const Plateau shown(excess);
  const solver::FrictionLaw& law = contact.friction;
  if (shown.spread <= kConstant * std::abs(shown.middle)) {
    const double factor = 1.0 + shown.middle;
    return OtherFriction{law.is_coulomb()
                             ? fmt::format("a friction coefficient of {:.4g} in place of {:.4g}",
                                           factor * law.coefficient, law.coefficient)
                             : fmt::format("a friction {:.4g} times that of the scene's law", factor),
                         factor * contact.friction_bound};
  }
  for (const auto kind : {solver::FrictionKind::coulomb, solver::FrictionKind::tresca}) {
    if (auto other = other_law(contact, right, kind)) return other;
  }
  return std::nullopt;
}

Deviation find_deviation(const GivenContact& contact, const RightAnswer& right, const State& reported,
                         const State& fitted) {
  const double moment = (right.traction * contact.rotation).sum();
  const std::vector<double> excess = ring_excess(contact, contact.friction_bound, right);
  return {.tractions =
              solver::norms(contact.traction - right.traction).sum() / solver::norms(right.traction).sum(),
          .motion = motion_error(contact, right, reported),
          .moment = moment == 0.0 ? 0.0 : contact.moment() / moment - 1.0,
          .friction = excess.empty() ? 0.0 : excess[excess.size() / 2],
          .gap = fitted.gap.sum() / contact.energy()};
}

solver::SlipDirection noticeable_direction(const GivenContact& c, const State& state, double part) {
  const double least = part * solver::norms(c.displacement).maxCoeff();
  const ArrayXd size = solver::norms(state.slip);
  const double something = kNextToNothing * c.friction_bound.maxCoeff();
  const ArrayXd noticeable = ((size > least) && (c.friction_bound > something)).cast<double>();
  return solver::slip_direction(c.traction, noticeable.replicate(2, 1) * state.slip);
}

Deviation larger(const Deviation& a, const Deviation& b) {
  const auto of = [&](double Deviation::*part) { return std::max(std::abs(a.*part), std::abs(b.*part)); };
  return {of(&Deviation::tractions), of(&Deviation::motion), of(&Deviation::moment),
          of(&Deviation::friction),  of(&Deviation::gap),    of(&Deviation::pressure)};
}

}  // namespace slipstick::convergence
