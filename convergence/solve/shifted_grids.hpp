#pragma once

#include <functional>
#include <string>

#include "convergence/runs/solve_scene.hpp"
#include "convergence/solve/accuracy.hpp"

/// One number from several grids. The error of one grid is the staircase of its cells along the edges of
/// contact and stick area: it changes its sign as the cells are shifted under them, so that a mean over
/// shifted grids is far better than each of them, and their scatter says how good it is. With smooth cell
/// tractions (solver::CellTraction) nothing else is left that matters: no extrapolation is needed.
namespace slipstick::convergence {

/// Solves one grid, to the detail that is asked for.
using GridSolve = std::function<SolvedScene(const solver::Scene&, solver::Detail)>;

/// Grids of a mean. The stick radius in cells, of them all, is spread evenly over one cell, the period of its
/// staircase.
inline constexpr int kShiftedGrids = 3;
/// The order in which the mean's uncertainty falls with the cell size, measured on the paper's sphere.
inline constexpr double kShiftedOrder = 2.5;

/// Whether the quantity is a number of a contact whose pressure is solved, falls to zero at its edge, and
/// whose grid may be any: what smooth cell tractions make more accurate on the same mesh.
bool gains_by_smooth_cells(const solver::Scene& scene, AccuracyOf of);

/// Whether it is also one whose error is the staircase alone: a twist, or the moment by an imposed one. The
/// stick radius keeps an error of its own, since it is fitted to the slip beside its edge.
bool takes_shifted_grids(const solver::Scene& scene, AccuracyOf of);

/// The form of a contact, by which a mesh is chosen.
struct ContactForm {
  double stick_ratio = 0.5;  ///< stick radius over contact radius
  double slender = 1.0;      ///< longer over shorter axis of the contact
};
/// From a coarse grid, as far as that can say: a finer one where the target takes many more cells.
ContactForm coarse_form(const solver::Scene& scene, const AccuracyTarget& target);

/// The mesh on which the mean is expected to have the wanted uncertainty. Throws InputError, with what is
/// reachable, where none does, and where it does not fit in memory.
AccuracyChoice choose_shifted(const solver::Scene& scene, const ContactOnGrid& contact,
                              const AccuracyTarget& target, const ContactForm& form);

/// The mean over grids of equal cells and growing extent.
struct ShiftedMean {
  SolvedScene answer;  ///< of the grid with the smallest cells; its result has the mean for its own value
  double error;        ///< of the mean, against the exact answer; NaN where there is none
  /// Relative, covers the error in at least 95 of 100 scenes; NaN where a grid did not converge.
  double uncertainty;
  std::string why;  ///< what the uncertainty was made from, or which grid did not converge
  Json grids;       ///< [{extent, value}], in the order of their solves
};
ShiftedMean mean_over_shifted_grids(const solver::Scene& scene, const AccuracyQuantity& quantity,
                                    const ContactForm& form, const ContactOnGrid& contact,
                                    const GridSolve& solve);

}  // namespace slipstick::convergence
