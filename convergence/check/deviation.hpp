#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "convergence/check/given_contact.hpp"
#include "solver/contact/certificate.hpp"

namespace slipstick::convergence {

/// A gap over energy up to which an iteration has done its work: it stands for tractions good to about 1e-3
/// at worst.
inline constexpr double kIterationGap = 1e-5;

/// What Coulomb's law has for an answer on a contact's grid, with its pressure, under the motions that the
/// scene imposes and else under the contact's own loads.
struct RightAnswer {
  Eigen::ArrayXd traction;             ///< 2*cells
  double twist;                        ///< rad
  std::array<double, 2> displacement;  ///< about the scene's origin
  /// The own loads are beyond what friction can carry with this pressure: they are scaled down to
  /// kScaledLoads of the limit.
  bool scaled;
};
inline constexpr double kScaledLoads = 0.9;

/// Throws std::runtime_error where the solve gets nowhere near kIterationGap.
RightAnswer find_right_answer(const GivenContact& contact, const solver::Step& load);

/// The same from a problem of one's own; its loads are scaled down if they have to be.
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

/// How far tractions are from the right answer with their pressure and loads, and from Coulomb's law.
struct Deviation {
  double tractions = 0.0;  ///< sum |q - r| / sum |r|
  double motion = 0.0;     ///< signed: see motion_error()
  double moment = 0.0;     ///< relative to the right one, signed; of a moment that is asked for: 0
  /// |q|/(mu p) in the slip ring less one: the median over the cells that slip in the right answer, which a
  /// few cells along its edges do not move. 0 where hardly any cell slips.
  double friction = 0.0;
  double gap = 0.0;  ///< of Coulomb's law, over energy
  /// sum |p - r| / sum r, with p under the right normal load: the contact's shape. Not find_deviation()'s.
  double pressure = 0.0;
};
/// The motion is compared as it is reported, the gap is that under the motion that Coulomb's law fits best:
/// a wrong twist is no mistake of the tractions.
Deviation find_deviation(const GivenContact& contact, const RightAnswer& right, const State& reported,
                         const State& fitted);

/// Direction of slip that is more than a part of the displacements, what the mesh leaves open of them (in
/// sticking cells the rest has any direction), in cells that carry something.
solver::SlipDirection noticeable_direction(const GivenContact& contact, const State& state, double part);

/// Each the larger one of two, without sign.
Deviation larger(const Deviation& a, const Deviation& b);

/// The friction coefficient that the slip ring shows, if it is constant there: |q|/p is the same in half of
/// it, up to a part of what it is off by.
std::optional<double> plateau_of_friction(const GivenContact& contact, const RightAnswer& right);

/// The cells that slip in the right answer, of those that carry more than next to nothing.
std::vector<solver::Index> slip_ring(const GivenContact& contact, const RightAnswer& right);

}  // namespace slipstick::convergence
