#include "solver/contact/full_coupling.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "solver/contact/anderson.hpp"
#include "solver/newton/admissible.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr int kMaxTurns = 100;
/// The step is halved unless the gap falls by this part of the step below the largest of the last kLastGaps
/// gaps: it may rise for a turn or two.
constexpr double kProgress = 0.1;
constexpr std::size_t kLastGaps = 3;
constexpr double kMinStep = 1.0 / 64.0;
constexpr double kNoGapYet = std::numeric_limits<double>::infinity();
/// Relative gap at which a turn stops, over the last turn's gap.
constexpr double kPartOfGap = 0.03;
/// A traction slips if it is above this part of its bound: a guess comes from another grid.
constexpr double kNearlyBound = 0.99;
/// Changes that Anderson's acceleration combines.
constexpr int kDepth = 4;

/// Complementarity gap of a pressure with an additional opening, over p.Kp/2.
class Complementarity {
 public:
  Complementarity(const Elasticity& elasticity, const Grid& grid, const ArrayXd& gap)
      : op_(elasticity.make(grid, normal_kernel())),
        reachable_(gap.isFinite().cast<double>()),
        height_((reachable_ > 0.0).select(gap, 0.0)),
        u_(grid.cells()) {}

  double operator()(const ArrayXd& pressure, const ArrayXd& opening) {
    op_->apply(pressure, u_);
    const double energy = 0.5 * (pressure * u_).sum();
    return PositivePressures(reachable_).gap(pressure, u_ + height_ + opening) / energy;
  }

 private:
  Cached<LinearOperator> op_;
  ArrayXd reachable_, height_, u_;
};

/// The turns of one solve. Each starts from the pressure and tractions of the last.
class Turns {
 public:
  Turns(const Elasticity& elasticity, const Grid& grid, const CoupledProblem& problem)
      : problem_(problem),
        opening_by_(elasticity, grid),
        complementarity_(elasticity, grid, problem.gap),
        opening_(opening_by_(problem.guess.traction)),
        pressure_(problem.guess.pressure),
        switches_(Eigen::ArrayXi::Zero(grid.cells())) {
    if (pressure_.size() == 0) return;
    traction_ = problem.guess.traction;
    slips_ = norms(traction_) > kNearlyBound * problem.friction_bound(pressure_);
  }

  CoupledSolution run() {
    double step = 1.0;
    double wanted = problem_.guess.gap;
    for (solution_.turns = 1;; ++solution_.turns) {
      // A pressure solved to its tolerance may carry a load that a rough one does not.
      if (!take(wanted) && !take(0.0)) return std::move(solution_);
      const double largest = std::ranges::max(last_gaps_);
      measure();
      if (solution_.turns == 1) solution_.first_gap = gap_;
      if (is_settled() && (is_final(wanted) || !finish() || is_settled())) return settled();
      if (!(gap_ <= (1.0 - kProgress * step) * largest)) step *= 0.5;
      std::rotate(last_gaps_.begin(), last_gaps_.begin() + 1, last_gaps_.end());
      last_gaps_.back() = gap_;
      if (!(step >= kMinStep) || solution_.turns == kMaxTurns) break;
      advance(step);
      wanted = kPartOfGap * gap_;
    }
    return unsettled();
  }

 private:
  bool converged() const {
    return solution_.normal.status == Status::converged && solution_.tangential.status == Status::converged;
  }

  bool is_settled() const {
    return gap_ <= std::max(problem_.tolerance, problem_.part_of_first_gap * solution_.first_gap);
  }

  /// True if a turn solves the tractions to the scene's tolerance.
  bool is_final(double gap) const { return gap <= problem_.tolerance || problem_.part_of_first_gap > 0.0; }

  /// gap: relative gap at which to stop both; 0: the scene's tolerance.
  bool take(double gap) {
    solution_.normal = problem_.solve_pressure(opening_, {gap, pressure_});
    solution_.tangential =
        problem_.solve_tractions(solution_.normal.pressure, {gap <= problem_.tolerance ? 0.0 : gap, traction_guess()});
    return converged();
  }

  /// The last tractions; slipping ones are scaled to their new circles.
  ArrayXd traction_guess() const {
    if (traction_.size() == 0) return {};
    const ArrayXd size = norms(traction_);
    const ArrayXd onto = (slips_ && size > 0.0).select(problem_.friction_bound(solution_.normal.pressure) / size, 1.0);
    return onto.replicate(2, 1) * traction_;
  }

  /// change_: opening by the last tractions less opening_; gap_: of the pressure under the former.
  void measure() {
    change_ = opening_by_(solution_.tangential.traction) - opening_;
    gap_ = complementarity_(solution_.normal.pressure, opening_ + change_);
    solution_.normal.complementarity = gap_;
  }

  /// Solves the tractions to the scene's tolerance once the pressure has converged.
  bool finish() {
    const ArrayXd guess = solution_.tangential.traction;
    solution_.tangential = problem_.solve_tractions(solution_.normal.pressure, {0.0, guess});
    measure();
    return converged();
  }

  /// The approach is the mean of the displacement, weighted by the pressure; it includes change_.
  CoupledSolution settled() {
    const ArrayXd& pressure = solution_.normal.pressure;
    solution_.normal.approach += (pressure * change_).sum() / pressure.sum();
    return std::move(solution_);
  }

  CoupledSolution unsettled() {
    solution_.normal.status = Status::not_converged;
    solution_.normal.message = fmt::format(
        "the staggered iteration of pressure and shear diverges: complementarity gap {:.3g} after {} turns, "
        "tolerance {:.3g}{}; contact.coupling = \"pressure\" omits the shear's effect on the pressure",
        gap_, solution_.turns, problem_.tolerance, at_the_edge());
    return std::move(solution_);
  }

  /// A friction bound that is not zero at zero pressure jumps where a cell comes into contact. If the shear
  /// of the cell opens it and without shear it closes, no state is an equilibrium.
  std::string at_the_edge() const {
    constexpr double kHardlyPressed = 1e-9;
    constexpr double kJump = 0.01;
    const ArrayXd& pressure = solution_.normal.pressure;
    const double most = problem_.friction_bound(pressure).maxCoeff();
    const bool jumps = problem_.friction_bound(kHardlyPressed * pressure).maxCoeff() > kJump * most;
    const Index switched = (switches_ > 1).count();
    if (!jumps || switched == 0) return "";
    return fmt::format(
        ", and {} cells at the edge come into contact and leave it again: each carries its full friction as "
        "soon as it touches, which opens it, so that this mesh may have no solution",
        switched);
  }

  /// To the opening of the next turn, and its guesses.
  void advance(double step) {
    acceleration_.advance(opening_, change_, step);
    if (pressure_.size() > 0) switches_ += ((pressure_ > 0.0) != (solution_.normal.pressure > 0.0)).cast<int>();
    pressure_ = std::move(solution_.normal.pressure);
    traction_ = std::move(solution_.tangential.traction);
    slips_ = solution_.tangential.stick == 0.0;
  }

  const CoupledProblem& problem_;
  ShearOpening opening_by_;
  Complementarity complementarity_;
  Anderson acceleration_{kDepth};
  ArrayXd opening_, change_;
  ArrayXd pressure_, traction_;  ///< guesses; empty in the first turn
  Eigen::Array<bool, Eigen::Dynamic, 1> slips_;
  Eigen::ArrayXi switches_;  ///< how often each cell has come into contact or left it
  double gap_ = kNoGapYet;
  std::array<double, kLastGaps> last_gaps_{kNoGapYet, kNoGapYet, kNoGapYet};
  CoupledSolution solution_;
};

}  // namespace

CoupledSolution solve_fully_coupled(const Elasticity& elasticity, const Grid& grid, const CoupledProblem& problem) {
  return Turns(elasticity, grid, problem).run();
}

}  // namespace slipstick::solver
