#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "convergence/oracle/oracle.hpp"
#include "solver/solution.hpp"

namespace slipstick::convergence {

/// Relative errors of a field: sum |f - exact| / sum |exact|, the same of squares under a root, and of
/// maxima. A cell where the exact value is infinite (a cone's axis, with an odd number of cells) is left out.
struct FieldError {
  double l1 = NAN;  ///< NaN: not known, as the following
  double l2 = NAN;
  double max = NAN;
};

/// Errors of a traction field, all relative to the exact field of the whole contact, so that the errors of
/// the regions add up to `averaged` (l1; l2 in squares).
struct TractionError {
  FieldError at_centres;    ///< against the exact values at cell centres
  FieldError averaged;      ///< against exact averages over the cells, which differ where the traction has an edge
  FieldError stick_edge;    ///< within kEdgeBand cells of the stick radius
  FieldError contact_edge;  ///< within kEdgeBand cells of the contact radius, the stick edge's band excluded
  FieldError inside;        ///< the rest of the stick area
  FieldError outside;       ///< the rest of the slip ring, and cells that should carry nothing
};
inline constexpr double kEdgeBand = 2.0;

/// Signed relative errors computed/exact - 1, and errors of the fields at cell centres. Where the exact value
/// is zero (no load: twist, moment, traction), infinite (peak pressure of a cone and a flat punch) or not
/// known, the error is NaN.
struct Errors {
  double twist;
  double moment;
  double moment_limit;
  double stick_radius;
  double stick_ratio;
  double displacement;  ///< length of the difference, not signed
  double dissipated;    ///< in the step
  double stick_radius_counted;
  double contact_radius;
  double peak_pressure;
  TractionError traction;
  FieldError sharpened;  ///< of sharpened() tractions at cell centres
  std::string kept;      ///< see Sharpened
  FieldError pressure;
};

/// Exact fields at the cell centres of a grid, in SI units.
struct ExactFields {
  Eigen::ArrayXd radius;    ///< cells: as the oracle measures it
  Eigen::ArrayXd pressure;  ///< cells
  Eigen::ArrayXd traction;  ///< 2*cells; NaN where the oracle does not know it
};

/// computed/exact - 1; NaN where the exact value is infinite or not known.
double relative_error(double value, double exact);

ExactFields exact_fields(const Oracle& oracle, const solver::Grid& grid);
/// grid: m; traction: 2*cells, Pa.
TractionError traction_error(const Eigen::ArrayXd& traction, const Oracle& oracle, const solver::Grid& grid);
/// pressure: cells, Pa. Where the exact one is infinite it is left out.
FieldError pressure_error(const Eigen::ArrayXd& pressure, const Oracle& oracle, const solver::Grid& grid);
/// Errors of fields only where the solution has all detail, else NaN.
Errors compare(const solver::Solution& solution, const Oracle& oracle);

// ---------------------------------------------------------------- fields at their edges (sharpened.cpp)

/// Values at the centre of a cut cell, Pa.
struct SharpenedCell {
  solver::Index cell;
  double pressure;
  std::array<double, 2> traction;
};

/// A solution's fields where their square-root edges are read off, cell by cell in their order. A solve knows means: in
/// the cells that the contact's edge or the stick front cuts they are off by h^(1/2). Towards the edge p^2 falls
/// linearly, and towards the front, from inside, (f - |q|)^2 does, f the friction bound, whatever the contact's shape.
/// So the quadratic that fits this square best in the whole cells beyond says what it is at the centres of the cut
/// ones. All cells of an edge keep their numbers where the fit is doubtful: it changes their sum, though each is a
/// mean; or it is further off, in whole cells that it leaves out, than what it changes. Cells keep theirs where too few
/// whole cells are near, and at edges towards which the pressure rises (a punch's). Tractions keep their directions and
/// stay within the bound of the pressure in their cell.
struct Sharpened {
  std::vector<SharpenedCell> cells;
  std::string kept;  ///< which edges' cells keep their numbers, and why; empty: none
};
Sharpened sharpened(const solver::Solution& solution);

}  // namespace slipstick::convergence
