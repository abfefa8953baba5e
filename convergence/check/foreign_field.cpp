#include "convergence/check/foreign_field.hpp"

#include <fmt/core.h>

#include <cmath>

#include "convergence/check/field_grid.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/file_precision.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {

using Eigen::ArrayXd;
using solver::Index;
using solver::InputError;

namespace {

/// NaN is zero where there is no contact.
void read_missing_as_no_contact(const std::filesystem::path& file, std::vector<solver::Column>& columns) {
  ArrayXd& pressure = columns[2].values;
  for (Index row = 0; row < pressure.size(); ++row) {
    const bool no_contact = std::isnan(pressure[row]) || pressure[row] == 0.0;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      double& value = columns[c].values[row];
      if (!std::isnan(value)) continue;
      if (c < 2 || !no_contact) {
        throw InputError(file.string(),
                         fmt::format("row {}: {} is no number; allowed: NaN where there is no contact, "
                                     "in pressure, q1 and q2",
                                     row + 1, columns[c].name));
      }
      value = 0.0;
    }
  }
}

}  // namespace

ForeignField read_foreign_field(const std::filesystem::path& file, const std::vector<std::string>& names) {
  auto columns = solver::read_columns(file, {"x1", "x2", "pressure", "q1", "q2"},
                                      {.columns = names, .may_be_missing = true});
  read_missing_as_no_contact(file, columns);
  const FieldGrid found = find_field_grid(file, columns[0], columns[1]);
  const ArrayXd& pressure = columns[2].values;
  const ArrayXd pressure_rounding = solver::find_precision(pressure).rounding(pressure);
  const ArrayXd q1_rounding = solver::find_precision(columns[3].values).rounding(columns[3].values);
  const ArrayXd q2_rounding = solver::find_precision(columns[4].values).rounding(columns[4].values);
  const Index cells = found.grid.cells();
  ForeignField field{.file = file,
                     .grid = found.grid,
                     .centre = found.centre,
                     .pressure = ArrayXd::Zero(cells),
                     .traction = ArrayXd::Zero(2 * cells),
                     .pressure_rounding = ArrayXd::Zero(cells),
                     .traction_rounding = ArrayXd::Zero(cells)};
  for (Index row = 0; row < pressure.size(); ++row) {
    if (!(pressure[row] >= 0.0)) {
      throw InputError(file.string(), fmt::format("row {}: pressure = {}; allowed: zero or positive", row + 1,
                                                  pressure[row]));
    }
    const Index cell = found.cells[static_cast<std::size_t>(row)];
    field.pressure[cell] = pressure[row];
    field.traction[cell] = columns[3].values[row];
    field.traction[cell + cells] = columns[4].values[row];
    field.pressure_rounding[cell] = pressure_rounding[row];
    field.traction_rounding[cell] = std::hypot(q1_rounding[row], q2_rounding[row]);
  }
  if (!(field.pressure.sum() > 0.0)) throw InputError(file.string(), "pressure is zero everywhere");
  if ((field.traction == 0.0).all()) {
    throw InputError(file.string(), "q1 and q2 are zero everywhere: there is nothing to judge");
  }
  return field;
}

}  // namespace slipstick::convergence
