#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/given_contact.hpp"
#include "solver/contact/certificate.hpp"

namespace slipstick::convergence {

/// Gap over energy at which an iteration counts as finished. It stands for tractions good to about 1e-3 at
/// worst.
inline constexpr double kIterationGap = 1e-5;

/// The solution of Coulomb's law on a contact's grid with its pressure, under the motions that the scene
/// imposes, otherwise under the contact's own loads.
struct RightAnswer {
  Eigen::ArrayXd traction;             ///< 2*cells
  double twist;                        ///< rad
  std::array<double, 2> displacement;  ///< about the scene's origin
  bool scaled;  ///< friction cannot carry the own loads with this pressure: they are scaled to kScaledLoads
};
inline constexpr double kScaledLoads = 0.9;  ///< of the limit load: near it, and clear of gross slip
/// Part of the limit load by which loads have to be below it to be solved. A field that slips everywhere
/// carries the limit up to rounding.
inline constexpr double kBelowLimit = 1e-8;

/// The multiple of loads that is solved, where a contact can carry `factor` times them: 1, unless they are
/// above kBelowLimit or less from the limit. Above the limit it is kScaledLoads of it.
double solved_multiple(double factor);

/// Throws std::runtime_error where the solve gets nowhere near kIterationGap.
RightAnswer find_right_answer(const GivenContact& contact, const solver::Step& load);

/// Solves a problem on any grid for the contact's bodies. Throws as find_right_answer().
solver::TangentialSolution solve_problem(const GivenContact& contact, const solver::Grid& grid,
                                         const solver::TangentialProblem& problem);

/// Multiplies the loads that a problem imposes.
void scale_loads(solver::TangentialProblem& problem, double factor);

/// Tractions under a rigid motion: the given twist, or else the motion that Coulomb's law fits best.
struct State {
  double twist;                        ///< rad
  std::array<double, 2> displacement;  ///< about the scene's origin
  Eigen::ArrayXd slip;                 ///< 2*cells
  Eigen::ArrayXd gap;                  ///< cells
};
State find_state(const GivenContact& contact, const solver::Step& load, std::optional<double> twist);

/// Parts of a contact: a mesh leaves more open where the edge cuts its cells.
struct Regions {
  Eigen::ArrayXd inner;  ///< inner_cells()
  Eigen::ArrayXd ring;   ///< 1 in cells whose friction is judged: inner ones if enough of them slip, else all
};
Regions find_regions(const GivenContact& contact, const RightAnswer& right);

/// Distances of tractions from the right answer with their pressure and loads, and from Coulomb's law.
struct Deviation {
  double tractions = 0.0;  ///< sum |q - r| / sum |r|
  double inside = 0.0;     ///< the part of that sum in inner cells
  double motion = 0.0;     ///< signed: see motion_error()
  double moment = 0.0;     ///< relative to the right one, signed; 0 where the right one is 0
  /// Median of |q|/(mu p) - 1 over the cells that slip in the right answer; 0 where hardly any cell slips.
  double friction = 0.0;
  double excess = 0.0;  ///< the same, where it is above 0: cut cells carry less than their bound, none more
  double gap = 0.0;     ///< of Coulomb's law, over energy
  /// sum |p - r| / sum r, with p under the right normal load; find_deviation() leaves it zero.
  double pressure = 0.0;
};
/// The motion is the reported one. The gap is that under the motion that fits best: a wrong twist is no
/// mistake of the tractions.
Deviation find_deviation(const GivenContact& contact, const RightAnswer& right, const State& reported,
                         const State& fitted, const Regions& regions);

/// Direction of slip in cells that carry something and slip by more than a part of the largest displacement.
/// Smaller slip, within the mesh error, has any direction.
solver::SlipDirection noticeable_direction(const GivenContact& contact, const State& state, double part);

/// The larger one of each pair of numbers, without sign.
Deviation larger(const Deviation& a, const Deviation& b);

/// Another friction than the scene's.
struct OtherFriction {
  std::string name;
  Eigen::ArrayXd bound;  ///< cells
};

/// The friction that a field shows: the scene's law times a factor, unless |q| over its bound varies in half
/// of the slip ring by more than a part of its distance from 1; or else the law |q| = k p^n that most cells
/// follow (n = 0: Tresca's, n = 1: Coulomb's), or the multiple of the scene's law, if as many follow it. None
/// where few cells follow any.
std::optional<OtherFriction> friction_shown(const GivenContact& contact, const RightAnswer& right,
                                            const Regions& regions);

/// The cells that slip in the right answer and carry more than next to nothing.
std::vector<solver::Index> slip_ring(const GivenContact& contact, const RightAnswer& right);

}  // namespace slipstick::convergence
