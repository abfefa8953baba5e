#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/exchange/given_contact.hpp"
#include "convergence/oracle/oracle.hpp"
#include "solver/grid/grid.hpp"
#include "solver/input/field_file.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// The regular grid on which the cells of a field lie, worked out from their positions.
struct FieldGrid {
  solver::Grid grid;                 ///< the cells' bounding rectangle, in the file's unit of length
  std::array<double, 2> centre;      ///< of that rectangle, in the file's coordinates
  std::vector<solver::Index> cells;  ///< for each row of the file its cell on the grid
};

/// x1, x2: positions of the cells' centres, in any order; their digits have to distinguish them. Cells may be
/// missing. Throws InputError, with file, row and value, for positions on no regular grid, a cell that is
/// given twice, and too few cells to judge.
FieldGrid find_field_grid(const std::filesystem::path& file, const solver::Column& x1, const solver::Column& x2);

/// Whether positions are those of a regular grid, up to a few mistakes that find_field_grid() names, and not
/// those of a mesh.
bool lies_on_grid(const solver::Column& x1, const solver::Column& x2);

/// Pressure and shear tractions that another program computed, over the bounding rectangle of its contact
/// cells. A cell without a row in the file carries nothing.
struct ForeignField {
  std::filesystem::path file;
  solver::Grid grid;                 ///< m, about its own centre
  std::array<double, 2> centre;      ///< m, of the grid in the scene's coordinates
  Eigen::ArrayXd pressure;           ///< cells, Pa
  Eigen::ArrayXd traction;           ///< 2*cells, Pa, on the lower body
  Eigen::ArrayXd pressure_rounding;  ///< cells, Pa: the error that the file's digits allow
  Eigen::ArrayXd traction_rounding;  ///< cells, Pa: the same of |q|
};

/// Reads the columns x1, x2, pressure, q1, q2 as solver::read_columns() does (`columns` as in its options;
/// others are ignored). No unit is converted. There is no contact where the pressure is NaN, or where it is
/// zero and a traction is NaN. Throws InputError for a column that is missing, another value that is not
/// finite, a negative pressure, tractions that are all zero, and where find_field_grid() does.
ForeignField read_foreign_field(const std::filesystem::path& file, const std::vector<std::string>& columns = {});

/// The scene's bodies with the field's pressure and tractions, on the field's grid. bodies: on any grid.
GivenContact pose(const ForeignField& field, const solver::Dimensionless& bodies, int threads);

// ---------------------------------------------------------------- in the scene's units and signs (conventions.cpp)

/// A field in this project's conventions.
struct Interpretation {
  ForeignField field;
  std::vector<std::string> conventions;  ///< conventions that were undone, one sentence each
  std::vector<std::string> mistakes;     ///< mistakes that were undone, so that the rest can be judged
};

/// Finds the conventions in which a field fits the scene best, in this order:
///
///  1. unit of length: the contact's size shows it;
///  2. unit of stress: the load that the pressure carries shows it;
///  3. exchanged axes: the shape of an elliptic contact shows them;
///  4. origin: the contact's middle is moved onto the body's axis, or from the grid's corner to its middle;
///  5. tractions on the other body, a left-handed frame, exchanged columns: the loads that the tractions
///     carry show them. One reversed component is a mistake.
///
/// model: the scene's. Throws InputError where no unit fits.
Interpretation in_own_conventions(ForeignField field, const solver::Scene& scene, const solver::Model& model,
                                  const OracleAnswer& exact);

/// A scene's moment over `unit`, from the exact answer or the scene's load. limit: the limit moment of the
/// pressure, over the same unit. None under an imposed twist without an exact answer.
std::optional<double> known_moment(const solver::Scene& scene, const OracleAnswer& exact, double limit, double unit);

}  // namespace slipstick::convergence
