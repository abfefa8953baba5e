#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "solver/input/field_file.hpp"

namespace slipstick::solver {

/// The names in the header of a table that is text, in small letters and without their units.
std::vector<std::string> text_table_names(const std::filesystem::path& file);

/// Columns of a table that is text, in SI units where its header says units, as read_columns().
std::vector<Column> read_text_columns(const std::filesystem::path& file, const std::vector<std::string>& names,
                                      const TableOptions& options);

/// A table without a header, as read_matrix().
Eigen::ArrayXXd read_text_matrix(const std::filesystem::path& file, Index max_values);

}  // namespace slipstick::solver
