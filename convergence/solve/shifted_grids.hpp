#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "convergence/runs/path_uncertainty.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "convergence/solve/accuracy.hpp"

/// One number from several grids. With smooth cell tractions (solver::CellTraction) the main error of one grid is the
/// staircase of its cells along the edges of contact and stick area. It changes its sign as the grid is shifted under
/// the edges, so the mean over shifted grids has a much smaller error, and the scatter measures it.
namespace slipstick::convergence {

/// Solves a scene on its grid, in this detail.
using GridSolve = std::function<SolvedScene(const solver::Scene&, solver::Detail)>;

/// Grids of a mean. Their stick radii, in cells, are spread evenly over one cell, the period of the staircase.
inline constexpr int kShiftedGrids = 3;
/// Power of the cell size with which the mean's uncertainty falls, measured on the paper's sphere.
inline constexpr double kShiftedOrder = 2.5;

/// Whether smooth cell tractions make the quantity more accurate on the same mesh: a number of a contact with
/// a free grid, whose pressure is solved and falls to zero at the edge.
bool gains_by_smooth_cells(const solver::Scene& scene, AccuracyOf of);

/// Whether, in addition, its only error is the staircase: a twist, or the moment of an imposed twist. The
/// stick radius has another error, since it is fitted to the slip near the edge.
bool takes_shifted_grids(const solver::Scene& scene, AccuracyOf of);

/// The form of a contact, by which a mesh is chosen.
struct ContactForm {
  double stick_ratio = 0.5;  ///< stick radius over contact radius
  double slender = 1.0;      ///< longer over shorter axis of the contact
};
/// Estimated on a coarse grid, or on a finer one if the target needs many more cells and the slip ring is
/// narrow. The defaults if that solve fails.
ContactForm coarse_form(const solver::Scene& scene, const AccuracyTarget& target);

/// The mesh on which the mean's expected uncertainty is within the target. Throws InputError, with the least
/// error that a mesh reaches, if there is none, and if the mesh does not fit in memory.
AccuracyChoice choose_shifted(const solver::Scene& scene, const ContactOnGrid& contact, const AccuracyTarget& target,
                              const ContactForm& form);

struct ShiftedGrid {
  std::array<double, 2> extent;  ///< m
  double value;                  ///< of the quantity, in SI units
};

/// The mean over grids of equal numbers of cells and growing extent.
struct ShiftedMean {
  SolvedScene answer;  ///< of the grid with the smallest cells; its record has the mean
  double error;        ///< of the mean, relative, against the exact answer; NaN: none
  /// Relative, covers the error in at least 95 of 100 scenes; NaN if a grid did not converge.
  double uncertainty;
  std::string why;                 ///< basis of the uncertainty, or which grid did not converge
  std::vector<ShiftedGrid> grids;  ///< in the order of their solves
  /// That the record's mean includes.
  std::optional<PathCorrection> path = {};
};
ShiftedMean mean_over_shifted_grids(const solver::Scene& scene, const AccuracyQuantity& quantity,
                                    const ContactForm& form, const ContactOnGrid& contact, const GridSolve& solve);

}  // namespace slipstick::convergence
