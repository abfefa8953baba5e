#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// A named column: one value for each row of its table.
struct Column {
  std::string name;
  Eigen::ArrayXd values;
};

/// A column over the cells of a grid that is worked out where it is written, and kept nowhere: values() of
/// the cells [first, last).
struct FieldColumn {
  std::string name;
  std::function<void(Index first, Index last, double* values)> values;
};

/// Rows of a table are cells of a contact, of 4,096 x 4,096 at most.
inline constexpr Index kMaxRows = Index{1} << 24;

struct TableOptions {
  /// Names of all columns of a table without a header, "x1 [mm]" with a unit; of an HDF5 file the paths of
  /// the datasets to read, in this order.
  std::vector<std::string> columns = {};
  bool may_be_missing = false;  ///< NaN and empty cells are NaN; they are refused otherwise
};

/// Reads columns by name. The ending .h5 or .hdf5 is HDF5 (1-D or 2-D datasets of equal shape, in the root or the one
/// group that has them all), .vti VTK image data as write_fields() writes it; others are text: a line of names in any
/// case, perhaps as a comment (#, %) and with units ("x1 [mm]": the values are returned in SI units), then a row a
/// cell, with commas, semicolons, tabs or blanks between columns and decimal points or commas. Throws InputError for a
/// file that cannot be read, a missing column, and a value that is not a finite number (with its row).
std::vector<Column> read_columns(const std::filesystem::path& file, const std::vector<std::string>& names,
                                 const TableOptions& options = {});

/// The cell of each row of a table whose first two columns are x1 and x2, positions of cells' centres in the
/// grid's unit. Throws InputError for a row that is not at the centre of a cell, to a thousandth of its size,
/// and for a cell that is given twice.
std::vector<Index> cells_of_rows(const std::filesystem::path& file, const Grid& grid,
                                 const std::vector<Column>& columns);

/// A matrix with a number for each cell: text as above without header, one line for each x1; or a 2-D HDF5
/// dataset. A number that is missing, an empty or "nan" cell of a CSV file, is NaN.
Eigen::ArrayXXd read_matrix(const std::filesystem::path& file, const std::string& dataset);

/// Throws InputError, which names the option, unless the ending is one that write_fields knows.
void require_field_format(const std::filesystem::path& file, const std::string& option = "--fields");

/// The ending of the files of fields that this program's own scripts read: .h5, or .csv where the HDF5
/// library is not installed.
std::string fields_ending();

/// Writes columns over all cells of a grid: .csv and .h5 get the rows where `keep` is not zero; .vti (VTK image data,
/// for ParaView) gets all cells. The file is the old one or the whole new one, and the same numbers give the same
/// bytes. Memory holds a row of one column for .h5, a row for .csv and a column for .vti. All processes of the grid
/// call it: into .h5 each writes its own rows, other files the first one writes. Throws InputError if it cannot write.
void write_fields(const std::filesystem::path& file, const Grid& grid, const std::vector<FieldColumn>& columns,
                  const Eigen::ArrayXd& keep);
/// Columns that are kept.
void write_fields(const std::filesystem::path& file, const Grid& grid, const std::vector<Column>& columns,
                  const Eigen::ArrayXd& keep);

}  // namespace slipstick::solver
