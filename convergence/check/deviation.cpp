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
std::vector<double> ring_excess(const GivenContact& contact, const ArrayXd& bound, const RightAnswer& right,
                                const Regions& regions) {
  std::vector<Index> ring = slip_ring(contact, right);
  std::erase_if(ring, [&](Index cell) { return regions.ring[cell] == 0.0; });
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

/// The highest value that many of some logarithms have, and how many.
struct Highest {
  double value = 0.0;
  std::size_t cells = 0;
};

Highest highest_of(std::vector<double>& logs) {
  constexpr double kFollows = 5e-3;  // relative, of |q|
  constexpr std::size_t kTop = 50;   // one in 50 cells may lie above
  if (logs.empty()) return {};
  const auto top = logs.end() - 1 - static_cast<std::ptrdiff_t>(logs.size() / kTop);
  std::ranges::nth_element(logs, top);
  const double value = *top;
  const auto cells =
      std::ranges::count_if(logs, [&](double log) { return std::abs(log - value) <= kFollows; });
  return {value, static_cast<std::size_t>(cells)};
}

/// The law |q| = k p^n that most cells follow; and how many follow a multiple of the scene's law.
struct PowerShown {
  double exponent = 0.0;
  double coefficient = 0.0;
  std::size_t cells = 0;
  double multiple = 1.0;
  std::size_t cells_of_multiple = 0;
};

PowerShown power_shown(const GivenContact& c) {
  constexpr int kExponents = 400;  // from 0 to 4
  constexpr double kExponentStep = 0.01;
  std::vector<Index> cells;
  const ArrayXd size = solver::norms(c.traction);
  for (Index cell = 0; cell < size.size(); ++cell) {
    if (size[cell] > 0.0 && c.friction_bound[cell] > 0.0) cells.push_back(cell);
  }
  std::vector<double> logs(cells.size());
  const auto highest_over = [&](const ArrayXd& unit) {
    std::ranges::transform(cells, logs.begin(),
                           [&](Index cell) { return std::log(size[cell] / unit[cell]); });
    return highest_of(logs);
  };
  const Highest own = highest_over(c.friction_bound);
  PowerShown best{.multiple = std::exp(own.value), .cells_of_multiple = own.cells};
  for (int k = 0; k <= kExponents; ++k) {
    const double n = k * kExponentStep;
    const Highest found = highest_over(c.pressure.pow(n));
    if (found.cells > best.cells) {
      best.exponent = n;
      best.coefficient = std::exp(found.value);
      best.cells = found.cells;
    }
  }
  return best;
}

OtherFriction multiple_of_law(const GivenContact& c, double factor) {
  const solver::FrictionLaw& law = c.friction;
  return {law.is_coulomb() ? fmt::format("a friction coefficient of {:.4g} in place of {:.4g}",
                                         factor * law.coefficient, law.coefficient)
                           : fmt::format("a friction {:.4g} times that of the scene's law", factor),
          factor * c.friction_bound};
}

/// Another law that the field follows: Coulomb's, Tresca's or a power of the pressure.
std::optional<OtherFriction> other_law(const GivenContact& c) {
  constexpr double kSameExponent = 0.03;
  constexpr double kSameMean = 0.02;
  const PowerShown shown = power_shown(c);
  const solver::FrictionLaw& law = c.friction;
  const auto is = [&](double n) { return std::abs(shown.exponent - n) <= kSameExponent; };
  if (std::max(shown.cells, shown.cells_of_multiple) < kMinSlipping) return std::nullopt;
  constexpr double kAsMany = 0.95;  // follow the scene's own law
  if (static_cast<double>(shown.cells_of_multiple) >= kAsMany * static_cast<double>(shown.cells))
    return multiple_of_law(c, shown.multiple);
  const bool same = (law.is_coulomb() && is(1.0)) || (law.kind == solver::FrictionKind::tresca && is(0.0)) ||
                    (law.kind == solver::FrictionKind::power && is(law.exponent));
  if (same) return std::nullopt;  // nearly the scene's law: something else is wrong
  std::string name;
  if (is(0.0)) {
    name =
        fmt::format("Tresca's law, with a shear strength of {:.4g} Pa,", shown.coefficient * c.stress_unit);
    const double mean = law.coefficient * c.pressure.sum() / static_cast<double>((c.pressure > 0.0).count());
    if (law.is_coulomb() && std::abs(shown.coefficient / mean - 1.0) <= kSameMean)
      name += " mu times the mean pressure,";
  } else if (is(1.0)) {
    name = fmt::format("Coulomb's law, with a coefficient of {:.4g},", shown.coefficient);
  } else {
    name = fmt::format("|q| = k p^n with n = {:.2f}", shown.exponent);
  }
  return OtherFriction{
      fmt::format("{} in place of friction_law = \"{}\"{}", name, solver::to_string(law.kind),
                  law.kind == solver::FrictionKind::power ? fmt::format(", n = {:g}", law.exponent) : ""),
      (c.pressure > 0.0).select(shown.coefficient * c.pressure.pow(shown.exponent), 0.0)};
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

std::optional<OtherFriction> friction_shown(const GivenContact& contact, const RightAnswer& right,
                                            const Regions& regions) {
  constexpr double kConstant = 0.2;  // spread between the quartiles, over the median excess
  const std::vector<double> excess = ring_excess(contact, contact.friction_bound, right, regions);
  if (excess.empty()) return std::nullopt;
  const Plateau shown(excess);
  if (shown.spread <= kConstant * std::abs(shown.middle)) {
    return multiple_of_law(contact, 1.0 + shown.middle);
  }
  return other_law(contact);
}

Regions find_regions(const GivenContact& contact, const RightAnswer& right) {
  Regions regions{inner_cells(contact.grid, contact.pressure), ArrayXd::Ones(contact.grid.cells())};
  const std::vector<Index> ring = slip_ring(contact, right);
  const auto inside = std::ranges::count_if(ring, [&](Index cell) { return regions.inner[cell] > 0.0; });
  if (inside >= static_cast<std::ptrdiff_t>(kMinSlipping)) regions.ring = regions.inner;
  return regions;
}

Deviation find_deviation(const GivenContact& contact, const RightAnswer& right, const State& reported,
                         const State& fitted, const Regions& regions) {
  const double moment = (right.traction * contact.rotation).sum();
  const std::vector<double> excess = ring_excess(contact, contact.friction_bound, right, regions);
  const ArrayXd off = solver::norms(contact.traction - right.traction);
  const double size = solver::norms(right.traction).sum();
  return {.tractions = off.sum() / size,
          .inside = (off * regions.inner).sum() / size,
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
  return {of(&Deviation::tractions), of(&Deviation::inside),   of(&Deviation::motion),
          of(&Deviation::moment),    of(&Deviation::friction), of(&Deviation::excess),
          of(&Deviation::gap),       of(&Deviation::pressure)};
}

}  // namespace slipstick::convergence
