#include "solver/contact/full_coupling.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "solver/contact/anderson.hpp"
#include "solver/newton/admissible.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr int kMaxTurns = 100;
/// The gap has to fall by this part of the step below the largest of so many turns before, or the next ones
/// are more careful: it may rise for a turn or two on its way.
constexpr double kProgress = 0.1;
constexpr std::size_t kLastGaps = 3;
constexpr double kMinStep = 1.0 / 64.0;
constexpr double kNoGapYet = std::numeric_limits<double>::infinity();
/// Gap that is enough in the first turn, and in the others as a part of the one that the last has left.
constexpr double kFirstGap = 1e-2;
constexpr double kPartOfGap = 0.03;
/// Changes that are combined.
constexpr int kDepth = 4;

/// Complementarity gap of a pressure under an opening besides its own, over p.Kp/2.
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
/// The turns of one solve, each from the last one's pressure and tractions.
class Turns {
 public:
  Turns(const Elasticity& elasticity, const Grid& grid, const CoupledProblem& problem)
      : problem_(problem),
        opening_by_(elasticity, grid),
        complementarity_(elasticity, grid, problem.gap),
        opening_(opening_by_(problem.traction)),
        switches_(Eigen::ArrayXi::Zero(grid.cells())) {}

  CoupledSolution run() {
    double step = 1.0;
    double wanted = kFirstGap;
    for (solution_.turns = 1;; ++solution_.turns) {
      // A load that a roughly solved pressure does not carry may be carried by one that is solved in full.
      if (!take(wanted) && !take(0.0)) return std::move(solution_);
      const double largest = std::ranges::max(last_gaps_);
      measure();
      if (gap_ <= problem_.tolerance && (!finish() || gap_ <= problem_.tolerance)) return settled();
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

  /// gap: over the energy, that is enough for each of the two; 0: as well as is asked for.
  bool take(double gap) {
    solution_.normal = problem_.solve_pressure(opening_, {gap, pressure_});
    solution_.tangential = problem_.solve_tractions(solution_.normal.pressure, {gap, traction_guess()});
    return converged();
  }

  /// Tractions that slip keep to their circles.
  ArrayXd traction_guess() const {
    if (traction_.size() == 0) return {};
    const ArrayXd size = norms(traction_);
    const ArrayXd onto =
        (slips_ && size > 0.0).select(problem_.friction_bound(solution_.normal.pressure) / size, 1.0);
    return onto.replicate(2, 1) * traction_;
  }

  /// How far the opening is from that of the last tractions, and the pressure from one under that.
  void measure() {
    change_ = opening_by_(solution_.tangential.traction) - opening_;
    gap_ = complementarity_(solution_.normal.pressure, opening_ + change_);
    solution_.normal.complementarity = gap_;
  }

  /// The tractions in full, under a pressure that is good enough.
  bool finish() {
    const ArrayXd guess = solution_.tangential.traction;
    solution_.tangential = problem_.solve_tractions(solution_.normal.pressure, {0.0, guess});
    measure();
    return converged();
  }

  /// The approach is the mean of the displacement, weighted with the pressure: it takes what the last
  /// tractions have changed.
  CoupledSolution settled() {
    const ArrayXd& pressure = solution_.normal.pressure;
    solution_.normal.approach += (pressure * change_).sum() / pressure.sum();
    return std::move(solution_);
  }

  CoupledSolution unsettled() {
    solution_.normal.status = Status::not_converged;
    solution_.normal.message = fmt::format(
        "pressure and shear drive each other apart: complementarity gap {:.3g} after {} turns, asked for "
        "{:.3g}{}; "
        "contact.coupling = \"pressure\" leaves the shear's effect on the pressure out",
        gap_, solution_.turns, problem_.tolerance, at_the_edge());
    return std::move(solution_);
  }

  /// A bound that does not fall to zero with the pressure jumps where a cell comes into contact. With its
  /// shear such a cell may open, and without it close: then no state of it is an equilibrium.
  std::string at_the_edge() const {
    constexpr double kHardlyPressed = 1e-9;
    constexpr double kJump = 0.01;
    const ArrayXd& pressure = solution_.normal.pressure;
    const double most = problem_.friction_bound(pressure).maxCoeff();
    const bool jumps = problem_.friction_bound(kHardlyPressed * pressure).maxCoeff() > kJump * most;
    const Index switched = (switches_ > 1).count();
    if (!jumps || switched == 0) return "";
    return fmt::format(
        ", and {} cells at the edge come into contact and leave it again: each carries all of its friction "
        "as "
        "soon as it touches, which opens it, so that this mesh may have no answer",
        switched);
  }

  /// To the opening of the next turn, and its guesses.
  void advance(double step) {
    acceleration_.advance(opening_, change_, step);
    if (pressure_.size() > 0)
      switches_ += ((pressure_ > 0.0) != (solution_.normal.pressure > 0.0)).cast<int>();
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

ShearOpening::ShearOpening(const Elasticity& elasticity, const Grid& grid)
    : op_(elasticity.make(grid, shear_kernel())) {}

ArrayXd ShearOpening::operator()(const ArrayXd& traction) {
  ArrayXd u(op_->grid().cells());
  op_->apply(traction, u);
  return -u;
}

CoupledSolution solve_fully_coupled(const Elasticity& elasticity, const Grid& grid,
                                    const CoupledProblem& problem) {
  return Turns(elasticity, grid, problem).run();
}

}  // namespace slipstick::solver
