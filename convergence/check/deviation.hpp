#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "convergence/exchange/given_contact.hpp"
#include "solver/contact/certificate.hpp"
#include "solver/contact/tangential_problem.hpp"

namespace slipstick::convergence {

/// Gap over energy at which an iteration counts as finished: tractions are then good to about 1e-3 at worst.
inline constexpr double kIterationGap = 1e-5;

/// Part of the largest mu p. Only the tolerance of the normal contact distinguishes cells that carry less
/// from empty ones.
inline constexpr double kNextToNothing = 1e-3;

// ---------------------------------------------------------------- fields on other grids about the same centre

/// The same bodies with another pressure and other tractions, without rounding.
GivenContact with_fields(const GivenContact& contact, const solver::Grid& grid, Eigen::ArrayXd pressure,
                         Eigen::ArrayXd traction);

/// A field on a larger or smaller grid with cells of the same size: continued by zero or cut off. The numbers
/// of cells along each axis differ by an even number.
Eigen::ArrayXd resized(const solver::Grid& from, const solver::Grid& to, const Eigen::ArrayXd& values);

/// The pressure of the scene's own normal contact, in the units of `contact`. `grid` is enlarged until it
/// covers the scene's grid. None without a normal load. Measured surfaces, pressures from files and pressures
/// that shear changes exist only on the scene's grid: none where `grid` has other cells.
std::optional<Eigen::ArrayXd> scene_pressure(const GivenContact& contact, const solver::Scene& scene,
                                             const solver::Model& model, solver::Grid& grid);

// ---------------------------------------------------------------- the right answer, and the distance from it

/// The motion that a scene imposes on a contact, in the contact's units; and a twist, if one is given.
KnownMotion known_motion(const GivenContact& contact, const solver::Step& load, std::optional<double> twist);

/// The tangential problem of a contact with this pressure, on its grid: under the motions that the scene
/// imposes, otherwise under the loads that the tractions carry.
solver::TangentialProblem own_problem(const GivenContact& contact, const solver::Step& load);

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

/// Solves a problem on any grid for the contact's bodies, on one quadrant where the bound and the loads have
/// two mirror axes, to a gap over energy: of its fields only the traction is complete. Throws as find_right_answer().
solver::TangentialSolution solve_problem(const GivenContact& contact, const solver::Grid& grid,
                                         solver::TangentialProblem problem, double tolerance = 1e-8);

/// Leaves the force out, and the translations with it, where it is nothing but the rounding of these
/// tractions on a contact that half a turn brings onto itself.
void leave_out_translations(solver::TangentialProblem& problem, const solver::Grid& grid,
                            const Eigen::ArrayXd& traction);

/// Multiplies the loads that a problem imposes.
void scale_loads(solver::TangentialProblem& problem, double factor);

/// Parts of a contact: a mesh leaves more open where the edge cuts its cells.
struct Regions {
  /// 1 in contact cells all of whose neighbours, also at corners, are in contact: the contact's edge cuts
  /// none of them. The others carry a part of a traction, which depends on the discretisation.
  Eigen::ArrayXd inner;
  Eigen::ArrayXd ring;  ///< 1 in cells whose friction is judged: inner ones if enough of them slip, else all
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
  double gap = 0.0;  ///< of Coulomb's law, over energy
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

/// The cells that slip in the right answer and carry more than kNextToNothing.
std::vector<solver::Index> slip_ring(const GivenContact& contact, const RightAnswer& right);

/// |q|/(mu p) - 1 in the ring's judged cells, in ascending order; empty where fewer than kMinSlipping slip.
std::vector<double> ring_excess(const GivenContact& contact, const RightAnswer& right, const Regions& regions);
inline constexpr std::size_t kMinSlipping = 8;  ///< a median over fewer cells would show the ring's edges

}  // namespace slipstick::convergence
