#pragma once

#include <optional>
#include <string>

#include "convergence/results/solve_record.hpp"
#include "convergence/solve/measured_accuracy.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/scene.hpp"

/// Chooses the mesh and the tolerance that reach a relative error, from measured data, finds the error of a
/// solve, and chooses the next ones if it is too large.
namespace slipstick::convergence {

/// The finest mesh that is chosen, in cells across the contact: twice as fine as the finest measured mesh.
inline constexpr double kMaxCellsAcross = 2048.0;

/// A relative error to reach.
struct AccuracyTarget {
  double error;
  AccuracyOf of = AccuracyOf::twist;
  double path = 0.0;  ///< its part by the length of the steps; the mesh has the rest

  double of_mesh() const { return error - path; }
};

/// The quantity of a target. The twist means the moment if the twist is imposed.
struct AccuracyQuantity {
  std::string name;  ///< twist | moment | traction | stick_radius
  std::string path;  ///< in a result: of the value; of the tractions, of their error

  bool is_field() const { return name == "traction"; }
  /// Relative error against the exact answer; NaN: none.
  double error(const ErrorsRecord& errors) const;
};
AccuracyQuantity accuracy_quantity(const solver::Scene& scene, AccuracyOf of);

/// Size of the last step's contact on a coarse grid, which relates cells of a grid to cells across the contact.
struct ContactOnGrid {
  double longer;        ///< cells along the grid's longer side
  double margin;        ///< cells of these outside the contact, the same number on each mesh
  double cells_across;  ///< diameter of the circle of equal area over the side of a square of a cell's area
};

/// From the pressure on that grid. A height map and a pressure file fix the grid: all of it counts as
/// contact. Throws InputError as make_model().
ContactOnGrid contact_on_grid(const solver::Scene& scene);

/// Cells along the longer side, a multiple of `multiple`, for at least `cells_across` across the contact.
solver::Index cells_for(const ContactOnGrid& contact, double cells_across, solver::Index multiple = 4);
double cells_across(const ContactOnGrid& contact, solver::Index cells);

/// The scene on another mesh with the same ratio of sides.
solver::Scene with_cells(solver::Scene scene, solver::Index longer);

/// The tightest tolerance that is chosen; scene files may have one ten times tighter.
inline constexpr double kTightestTolerance = 1e-14;

struct AccuracyChoice {
  solver::Index cells = 0;  ///< along the grid's longer side
  double tolerance = 0.0;
};

/// Checks a target against the scene. Throws InputError for an error that is not between 0 and 1, a scene
/// without the quantity, a grid that is fixed by a file, and a method whose stopping test bounds no error.
void require_reachable(const solver::Scene& scene, const AccuracyTarget& target);

/// Whether the scene has an exact answer with this quantity.
bool answers_exactly(const solver::Scene& scene, AccuracyOf of);

/// The error for a target that no grid reaches. least: the relative error of the finest grid.
solver::InputError out_of_reach(const solver::Scene& scene, const AccuracyTarget& target, double least);

/// The mesh and tolerance for a target by the measured data. estimated: the error will be estimated from two
/// meshes, and the mesh is chosen for the target over the estimate's safety factor. Throws InputError, with
/// the least error that a grid reaches, if no grid reaches the target.
AccuracyChoice choose_grid(const solver::Scene& scene, const ContactOnGrid& contact, const AccuracyTarget& target,
                           bool estimated);

/// The next choice after one whose error `reached` is too large; the error falls as cell size to the power
/// `order`. None if that mesh is finer than kMaxCellsAcross or does not fit in memory.
std::optional<AccuracyChoice> refined(const solver::Scene& scene, const ContactOnGrid& contact,
                                      const AccuracyTarget& target, const AccuracyChoice& before, double reached,
                                      double order);

/// Safety factor of an estimated error.
double estimation_safety(AccuracyOf of);

/// The error of a solve, and its basis.
struct ReachedError {
  double error;     ///< relative, not negative; NaN where it is not known
  std::string how;  ///< exact | estimated
  std::string why;  ///< basis of the estimate, or why the error is not known
};

/// The error against the exact answer, if `errors` has it. Else an estimate from a second solve on half as
/// many cells over the same extent. For a number it is the difference of the two over r^p - 1 with the
/// theoretical order p, times Roache's safety factor 3 (1998) for two meshes. For the tractions it is the
/// root mean square of the differences on the coarser cells over r^p - 1, in which nothing cancels,
/// times 1.25. It is at least the error measured for smooth contacts on such a mesh.
ReachedError reached_error(const solver::Scene& scene, const solver::Solution& solution, const ErrorsRecord& errors,
                           AccuracyOf of);

}  // namespace slipstick::convergence
