#pragma once

#include <optional>
#include <string>

#include "convergence/results/result_parts.hpp"
#include "convergence/solve/measured_accuracy.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/scene.hpp"

/// How a wanted accuracy is reached: mesh and tolerance from measured data, what they will cost, and the way
/// on where they were not enough.
namespace slipstick::convergence {

/// The finest mesh that is chosen: cells across the contact. Twice as fine as the finest measured one.
inline constexpr double kMaxCellsAcross = 2048.0;

/// A relative error that is asked for.
struct AccuracyTarget {
  double error;
  AccuracyOf of = AccuracyOf::twist;
  double path = 0.0;  ///< of the error, what the length of steps leaves: the mesh has the rest

  double of_mesh() const { return error - path; }
};

/// The quantity whose error is asked for: its name, and paths into a result. The moment, where the twist is
/// imposed.
struct AccuracyQuantity {
  std::string name;   ///< twist | moment | traction | stick_radius
  std::string error;  ///< path of its error against the exact answer
  std::string value;  ///< path of the value; empty: a field
};
AccuracyQuantity accuracy_quantity(const solver::Scene& scene, AccuracyOf of);

/// Contact of the last step on a coarse grid: how fine a mesh becomes in it.
struct ContactOnGrid {
  double longer;        ///< cells along the grid's longer side
  double margin;        ///< of these, outside the contact whatever the mesh
  double cells_across;  ///< diameter of the circle of equal area over the side of a square of a cell's area
};

/// Determined from the pressure on that grid; of a height map or a pressure file, whose grid is not free, as
/// if all of it were pressed. Throws InputError as make_model().
ContactOnGrid contact_on_grid(const solver::Scene& scene);

/// Cells along the longer side, a multiple of four or another, that put at least `cells_across` across the
/// contact.
solver::Index cells_for(const ContactOnGrid& contact, double cells_across, solver::Index multiple = 4);
double cells_across(const ContactOnGrid& contact, solver::Index cells);

/// The scene on another mesh, in the shape of its own.
solver::Scene with_cells(solver::Scene scene, solver::Index longer);

/// The tightest tolerance of a chosen solve; scene files may have one that is ten times tighter.
inline constexpr double kTightestTolerance = 1e-14;

/// What is solved to reach a target.
struct AccuracyChoice {
  solver::Index cells = 0;  ///< along the grid's longer side
  double tolerance = 0.0;
};

/// Checks a target against the scene before anything is computed. Throws InputError for an error that is not
/// between 0 and 1, a scene that has no such quantity or whose file says the grid, a method whose stopping
/// test bounds no error.
void require_reachable(const solver::Scene& scene, const AccuracyTarget& target);

/// Whether the exact side answers with this quantity.
bool answers_exactly(const solver::Scene& scene, AccuracyOf of);

/// The complaint about an error that no grid reaches. least: the error of the finest.
solver::InputError out_of_reach(const solver::Scene& scene, const AccuracyTarget& target, double least);

/// On a grid. estimated: its error will be estimated from two meshes, with a safety factor that the mesh has
/// to make up for. Throws InputError, with what is reachable, where the data say that no grid gets there.
AccuracyChoice choose_grid(const solver::Scene& scene, const ContactOnGrid& contact,
                           const AccuracyTarget& target, bool estimated);

/// The next choice after one that left too large an error, which falls in that order of the cell size; none
/// where what the error suggests is finer than kMaxCellsAcross, or the next mesh does not fit in memory.
std::optional<AccuracyChoice> refined(const solver::Scene& scene, const ContactOnGrid& contact,
                                      const AccuracyTarget& target, const AccuracyChoice& before,
                                      double reached, double order);

/// Predicted seconds of a solve on this machine: measured work times an application's seconds here. NaN for
/// methods and operators that were not measured.
double predicted_seconds(const solver::Scene& scene, const ContactOnGrid& contact);

/// Cells, unknowns, bytes and seconds of what a scene asks for. Throws InputError as make_model().
Json plan_json(const solver::Scene& scene, int ranks = 1);
std::string plan_text(const Json& result);

}  // namespace slipstick::convergence
