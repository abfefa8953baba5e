#include "solver/contact/coulomb_method.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <optional>

#include "solver/contact/certificate.hpp"
#include "solver/grid/own_rows.hpp"
#include "solver/grid/reduction.hpp"
#include "solver/newton/nested_iteration.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Torsion: q1 is even in x1 and odd in x2, q2 odd in x1 and even in x2.
constexpr std::array<Parity, 2> kTorsionParities{{{1, -1}, {-1, 1}}};

/// By the motions (1, 0), (0, 1) and (-x2, x1); empty: not imposed, or not given.
using PerMotion = std::array<std::optional<double>, 3>;

PerMotion per_motion(const std::optional<std::array<double, 2>>& translations, const std::optional<double>& rotation) {
  if (!translations) return {std::nullopt, std::nullopt, rotation};
  return {(*translations)[0], (*translations)[1], rotation};
}

/// The loads along the motions to be found, and the given motions.
PerMotion loads_of(const TangentialProblem& problem) { return per_motion(problem.force, problem.moment); }
PerMotion given_of(const TangentialProblem& problem) { return per_motion(problem.displacement, problem.twist); }

/// The tangential problem on one grid: a NestedProblem.
class TangentialOnGrid {
 public:
  /// turns: true if all fields but the friction bound turn into themselves under half a turn.
  TangentialOnGrid(const Grid& grid, TangentialProblem problem, bool turns)
      : grid_(grid),
        problem_(std::move(problem)),
        turns_(turns && is_half_turn_symmetric(grid, problem_.friction_bound)),
        motions_{MotionField(grid, 1.0), MotionField(grid, 0.0, 1.0), MotionField(grid, 0.0, 0.0, 1.0)} {}

  static BlockKernel kernel() { return tangential_kernel(); }
  static std::span<const Parity> parities() { return kTorsionParities; }
  FrictionDiscs admissible() const { return {packing_.cells(), problem_.friction_bound}; }
  Packing& packing() { return packing_; }
  /// In many spots each cell takes the part of its friction bound that the coarse tractions have there:
  /// bounds vary from cell to cell at the edges of spots. The contact cells are known.
  void predict(const TangentialOnGrid& coarse, const NewtonSummary&, ArrayXd& traction) const {
    if (problem_.start.size() > 0 || !Sweep(grid_, problem_.friction_bound).is_ragged()) return;
    constexpr double kLeastPart = 1e-30;  // a coarse bound may be too small to divide by
    constexpr std::array<Parity, 1> kEven{{{1, 1}}};
    const ArrayXd& bound = problem_.friction_bound;
    const ArrayXd prolonged = prolong_to(grid_, coarse.grid_, restrict_to(coarse.grid_, grid_, bound), kEven);
    traction *= (prolonged > kLeastPart * bound).select(bound / prolonged, 0.0).replicate(2, 1);
  }
  static bool missed_contact_cells(LinearOperator&, const NestedSummary&, double) { return false; }
  ArrayXd start() const {
    return problem_.start.size() > 0 ? problem_.start : ArrayXd::Zero(2 * problem_.friction_bound.size());
  }
  ArrayXd guess() const { return problem_.guess; }
  void keep_own_rows() {
    problem_.friction_bound = in_own_rows(grid_, std::move(problem_.friction_bound));
    problem_.initial_displacement = in_own_rows(grid_, std::move(problem_.initial_displacement));
  }

  /// Call it once: it packs the problem's fields.
  ConvexProgram program(LinearOperator& op) {
    reference_ = std::move(problem_.initial_displacement);
    if ((problem_.start != 0.0).any()) {
      ArrayXd before(problem_.start.size());
      op.apply(problem_.start, before);
      reference_ = reference_.size() > 0 ? ArrayXd(reference_ - before) : ArrayXd(-before);
    }
    packing_ = Packing(grid_, Sweep(grid_, problem_.friction_bound), 2);
    for (ArrayXd* const field : {&problem_.friction_bound, &reference_}) *field = packing_.packed(*field);
    for (MotionField& motion : motions_) motion = motion.packed(packing_);
    ConvexProgram program;
    program.energy_before = problem_.energy_before;
    program.turns_into_itself = turns_;
    if (reference_.size() > 0) program.g = &reference_;
    const PerMotion loads = loads_of(problem_), given = given_of(problem_);
    for (std::size_t k = 0; k < motions_.size(); ++k) {
      if (loads[k]) program.imposed.push_back({&motions_[k], *loads[k]});
      if (given[k]) program.given.push_back({&motions_[k], *given[k]});
    }
    return program;
  }

  /// 1 where tractions stay within their bound, once the program is solved. Slipping cells lie on their circle up to
  /// rounding; within it a cell sticks.
  ArrayXd stick_area(const ArrayXd& traction) const {
    constexpr double kOnCircle = 1e-12;
    const ArrayXd size = norms(packing_.packed(traction));
    ArrayXd stick = packing_.unpacked((size < (1.0 - kOnCircle) * problem_.friction_bound).cast<double>());
    share_rows(grid_, stick);
    return stick;
  }

  /// The same part of the limit loads on the coarse grid.
  TangentialOnGrid coarsened(const Grid& coarse) const {
    TangentialProblem problem{
        .friction_bound = restrict_to(coarse, grid_, problem_.friction_bound),
        .initial_displacement = restrict_to(coarse, grid_, problem_.initial_displacement),
        .moment = problem_.moment,
        .twist = problem_.twist,
        .force = problem_.force,
        .displacement = problem_.displacement,
        .start = restrict_to(coarse, grid_, problem_.start),
        .energy_before = problem_.energy_before * grid_.cell_area() / coarse.cell_area(),
        .limit_factor = problem_.limit_factor ? *problem_.limit_factor : limit_of(problem_, grid_).factor};
    const double scaled = limit_of(problem, coarse).factor / *problem.limit_factor;
    const double scale = std::isfinite(scaled) ? scaled : 1.0;  // no load: nothing to scale
    if (problem.moment) *problem.moment *= scale;
    if (problem.force) *problem.force = {scale * (*problem.force)[0], scale * (*problem.force)[1]};
    return {coarse, problem, turns_};
  }

 private:
  Grid grid_;
  TangentialProblem problem_;
  bool turns_;                          ///< its answer turns into itself under half a turn
  std::array<MotionField, 3> motions_;  ///< in the order of PerMotion
  ArrayXd reference_;
  Packing packing_;  ///< of the contact
};

/// Sets the solution's motions: found, given, or 0 if not modelled.
void describe_motion(TangentialSolution& solution, const NewtonSummary& newton, const TangentialProblem& problem) {
  const PerMotion loads = loads_of(problem), given = given_of(problem);
  std::array<double, 3> motion{};
  Index found = 0;
  for (std::size_t k = 0; k < motion.size(); ++k) {
    if (given[k]) motion[k] = *given[k];
    if (!loads[k]) continue;
    motion[k] =
        found < newton.multipliers.size() ? newton.multipliers[found] : std::numeric_limits<double>::quiet_NaN();
    ++found;
  }
  solution.displacement = {motion[0], motion[1]};
  solution.twist = motion[2];
}

/// True without tangential loads, motions and earlier tractions: then zero tractions satisfy Coulomb's law.
bool is_at_rest(const TangentialProblem& problem) {
  const auto nothing = [](const std::optional<std::array<double, 2>>& pair) {
    return !pair || *pair == std::array<double, 2>{};
  };
  return problem.moment.value_or(0.0) == 0.0 && problem.twist.value_or(0.0) == 0.0 && nothing(problem.force) &&
         nothing(problem.displacement) && (problem.initial_displacement == 0.0).all() && (problem.start == 0.0).all();
}

/// No traction, and only the given motion: every cell with friction sticks.
TangentialSolution at_rest(const Grid& grid, const TangentialProblem& problem) {
  TangentialSolution solution;
  solution.twist = problem.twist.value_or(0.0);
  solution.displacement = problem.displacement.value_or(std::array{0.0, 0.0});
  solution.status = Status::converged;
  solution.part = 0.0;
  for (ArrayXd* const field : {&solution.traction, &solution.elastic_displacement, &solution.slip})
    *field = zeros(2 * grid.cells());
  solution.stick = (problem.friction_bound > 0.0).cast<double>();
  return solution;
}

}  // namespace

TangentialSolution solve_by_coulomb_method(const Elasticity& elasticity, const Grid& grid, TangentialProblem problem,
                                           const CoulombOptions& options) {
  require_valid(problem, grid);
  if ((problem.friction_bound == 0.0).all() || is_at_rest(problem)) return at_rest(grid, problem);
  const NewtonOptions newton{.tolerance = options.tolerance,
                             .max_applications = options.max_applications,
                             .refine_multipliers = options.refine_motion,
                             .progress = options.progress};
  const TangentialProblem loads{
      .moment = problem.moment, .twist = problem.twist, .force = problem.force, .displacement = problem.displacement};
  const bool turns = !grid.quadrant && !problem.force && !problem.displacement &&
                     turns_into_itself(problem.initial_displacement) && turns_into_itself(problem.start);
  TangentialOnGrid contact(grid, std::move(problem), turns);
  NestedSummary nested = solve_nested(elasticity, grid, contact, newton, options.on_cells_known);
  TangentialSolution solution;
  solution.status = nested.newton.converged ? Status::converged : Status::not_converged;
  if (!nested.newton.converged) {
    solution.message = fmt::format("{}: gap / energy {:.3g}, tolerance {:.3g}", nested.newton.message,
                                   nested.newton.gap, options.tolerance);
  }
  describe_motion(solution, nested.newton, loads);
  solution.traction = std::move(nested.field);
  solution.elastic_displacement = std::move(nested.displacement);
  solution.change = nested.newton.gap;
  solution.iterations = nested.newton.iterations;
  solution.grids = std::move(nested.grids);
  solution.safeguards = nested.safeguards;
  solution.part = nested.part;
  solution.slip = std::move(nested.slip);
  solution.stick = contact.stick_area(solution.traction);
  return solution;
}

}  // namespace slipstick::solver
