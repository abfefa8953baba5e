#include "convergence/check/foreign_field.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/input/file_precision.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {

using Eigen::ArrayXd;
using solver::find_precision;
using solver::Index;
using solver::InputError;

namespace {

/// Rows of cells across a contact: it has an inside and an edge on both sides.
constexpr std::size_t kMinRowsAcross = 4;
/// Positions that differ by less than this part of the grid's side are one: no grid has a million rows.
constexpr double kSamePlace = 1e-6;
/// Cells of the bounding rectangle for each row of the file. Rough contacts and bodies side by side leave
/// most cells free; a larger number is taken for a mistake in a position, unless the grid has few cells.
constexpr double kMaxCellsPerRow = 100.0;
constexpr double kQuickGridCells = 65536.0;  // judged within seconds
/// Length of a cell over its width. No contact is so slender: a larger ratio is a mistake in a column.
constexpr double kMaxSlender = 1000.0;
/// Positions are those of a mesh where more than this part of them lies off a regular grid by more than this
/// part of a cell: one row that is astray moves the fitted grid by less.
constexpr double kMaxOff = 0.1;
constexpr double kClearlyOff = 0.1;
/// Rows are taken to be astray where at most this part of all rows lies beyond the widest gap,
constexpr double kMaxAstray = 0.02;
/// and that gap is wider than this multiple of the width of all rows of cells side by side,
constexpr double kTimesAcross = 10.0;
/// or wider than this many steps of the grid while some position fits no grid.
constexpr double kStepsAway = 10.0;
/// A position may be off its cell's centre by this part of the cell, or by twice its rounding,
constexpr double kOffCentre = 1e-2;
/// up to this part of the cell, within which positions still distinguish cells.
constexpr double kDistinguishesCells = 0.25;
/// Part of a cell that the sums which fit a grid leave: squares are squares, and an axis is a mirror, without it.
constexpr double kGridRounding = 1e-9;

/// Equally spaced places along one axis.
struct Axis {
  double first = 0.0;
  double spacing = 0.0;
  Index count = 0;

  double place(double x) const { return (x - first) / spacing; }
  bool is_rounding(double length) const { return std::abs(length) <= kGridRounding * spacing; }
  double centre() const { return first + 0.5 * static_cast<double>(count - 1) * spacing; }

  /// How far values are off the nearest places, and how far they may be, in steps.
  ArrayXd off(const ArrayXd& x) const {
    const ArrayXd place = (x - first) / spacing;
    return (place - place.round()).abs();
  }
  double accepted(const ArrayXd& x) const {
    const double rounding = find_precision(x).rounding(x).maxCoeff() / spacing;
    return std::clamp(2.0 * rounding, kOffCentre, kDistinguishesCells);
  }
};

/// Each place once, in order; a place is the mean of the values that differ by no more than `same`.
std::vector<double> distinct_places(const ArrayXd& values, double same) {
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  std::vector<double> places;
  for (std::size_t first = 0; first < sorted.size();) {
    std::size_t end = first;
    double sum = 0.0;
    while (end < sorted.size() && sorted[end] - sorted[first] <= same) sum += sorted[end++];
    places.push_back(sum / static_cast<double>(end - first));
    first = end;
  }
  return places;
}

double median_step(const std::vector<double>& places) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < places.size(); ++i) steps.push_back(places[i] - places[i - 1]);
  std::ranges::nth_element(steps, steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2));
  return steps[steps.size() / 2];
}

/// Fits places to whole numbers of steps by least squares. Missing rows of cells leave gaps.
Axis fit_axis(const std::vector<double>& places) {
  const double step = median_step(places);
  double whole = 0.0;
  ArrayXd x(static_cast<Index>(places.size()));
  ArrayXd k(x.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i > 0) whole += std::round((places[i] - places[i - 1]) / step);
    x[static_cast<Index>(i)] = places[i];
    k[static_cast<Index>(i)] = whole;
  }
  const ArrayXd from_mean = k - k.mean();
  const double spacing = (from_mean * x).sum() / from_mean.square().sum();
  return {x.mean() - k.mean() * spacing, spacing, static_cast<Index>(whole) + 1};
}

/// The first of the few rows beyond the widest gap between values; none where the gap is narrower than
/// `distance` or too many rows lie beyond it.
std::optional<Index> row_astray(const ArrayXd& values, double distance) {
  if (values.size() < 2) return std::nullopt;
  std::vector<Index> rows(static_cast<std::size_t>(values.size()));
  std::iota(rows.begin(), rows.end(), Index{0});
  std::ranges::sort(rows, {}, [&](Index row) { return values[row]; });
  std::size_t widest = 1;
  const auto gap = [&](std::size_t i) { return values[rows[i]] - values[rows[i - 1]]; };
  for (std::size_t i = 2; i < rows.size(); ++i) {
    if (gap(i) > gap(widest)) widest = i;
  }
  const auto middle = rows.begin() + static_cast<std::ptrdiff_t>(widest);
  const bool above = widest > rows.size() / 2;
  const auto few = static_cast<double>(above ? rows.size() - widest : widest);
  const bool astray = gap(widest) > distance && few <= kMaxAstray * static_cast<double>(rows.size());
  if (!astray) return std::nullopt;
  return above ? *std::min_element(middle, rows.end()) : *std::min_element(rows.begin(), middle);
}

/// The first of few rows that lie far beyond all others.
std::optional<Index> row_far_away(const ArrayXd& values, const std::vector<double>& places) {
  const double step = places.size() < kMinRowsAcross ? 0.0 : median_step(places);
  return row_astray(values, kTimesAcross * static_cast<double>(places.size()) * step);
}

Axis find_axis(const std::filesystem::path& file, const solver::Column& x) {
  const double range = x.values.maxCoeff() - x.values.minCoeff();
  const std::vector<double> places = distinct_places(x.values, kSamePlace * range);
  if (const auto far = row_far_away(x.values, places)) {
    throw InputError(file.string(),
                     fmt::format("row {}: {} = {} is far away from the others; allowed: one row for each "
                                 "cell of the contact, on one regular grid",
                                 *far + 1, x.name, x.values[*far]));
  }
  if (places.size() < kMinRowsAcross) {
    throw InputError(file.string(),
                     fmt::format("column {}: {} different values; allowed: at least {}, one for each row "
                                 "of cells across the contact",
                                 x.name, places.size(), kMinRowsAcross));
  }
  const Axis axis = fit_axis(places);
  Index worst = 0;
  if (axis.off(x.values).maxCoeff(&worst) <= axis.accepted(x.values)) return axis;
  worst = row_astray(x.values, kStepsAway * axis.spacing).value_or(worst);
  throw InputError(file.string(),
                   fmt::format("row {}: {} = {} is on no regular grid; allowed: about {:.4g} plus a whole "
                               "number of steps of {:.4g}, as most rows have it",
                               worst + 1, x.name, x.values[worst], axis.first, axis.spacing));
}

/// Refuses a grid with too many or too slender cells, before memory is taken for each of them.
void require_judgeable(const std::filesystem::path& file, const solver::Column& x1, const Axis& axis1,
                       const solver::Column& x2, const Axis& axis2) {
  const auto rows = static_cast<double>(x1.values.size());
  const double cells = static_cast<double>(axis1.count) * static_cast<double>(axis2.count);
  const double allowed = std::max(kQuickGridCells, kMaxCellsPerRow * rows);
  if (cells > allowed) {
    throw InputError(
        file.string(),
        fmt::format("{} rows on a grid of {} x {} cells of {:.4g} x {:.4g}; allowed: one row for each cell of the "
                    "contact, on one regular grid of at most {:.0f} cells",
                    rows, axis1.count, axis2.count, axis1.spacing, axis2.spacing, allowed));
  }
  const double slender = axis1.spacing / axis2.spacing;
  if (!(slender <= kMaxSlender && slender >= 1.0 / kMaxSlender)) {
    throw InputError(
        file.string(),
        fmt::format("row 1: ({}, {}) and those below are cells of {:.4g} x {:.4g}; allowed: one unit of length "
                    "in both columns, and cells at most {} times as long as wide",
                    x1.values[0], x2.values[0], axis1.spacing, axis2.spacing, kMaxSlender));
  }
}

/// Sets NaN to zero where there is no contact; refuses it elsewhere.
void read_missing_as_no_contact(const std::filesystem::path& file, std::vector<solver::Column>& columns) {
  ArrayXd& pressure = columns[2].values;
  for (Index row = 0; row < pressure.size(); ++row) {
    const bool no_contact = std::isnan(pressure[row]) || pressure[row] == 0.0;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      double& value = columns[c].values[row];
      if (!std::isnan(value)) continue;
      if (c < 2 || !no_contact) {
        throw InputError(file.string(), fmt::format("row {}: {} is no number; allowed: NaN where there is no contact, "
                                                    "in pressure, q1 and q2",
                                                    row + 1, columns[c].name));
      }
      value = 0.0;
    }
  }
}

}  // namespace

bool lies_on_grid(const solver::Column& x1, const solver::Column& x2) {
  double cells = 1.0;
  for (const solver::Column& x : {x1, x2}) {
    if (x.values.hasNaN()) return true;
    const double range = x.values.maxCoeff() - x.values.minCoeff();
    const std::vector<double> places = distinct_places(x.values, kSamePlace * range);
    if (places.size() < kMinRowsAcross || row_far_away(x.values, places)) return true;
    const Axis axis = fit_axis(places);
    const double clearly = std::max(axis.accepted(x.values), kClearlyOff);
    if ((axis.off(x.values) > clearly).cast<double>().mean() > kMaxOff) return false;
    cells *= static_cast<double>(axis.count);
  }
  return cells <= std::max(kQuickGridCells, kMaxCellsPerRow * static_cast<double>(x1.values.size()));
}

FieldGrid find_field_grid(const std::filesystem::path& file, const solver::Column& x1, const solver::Column& x2) {
  const Axis axis1 = find_axis(file, x1);
  const Axis axis2 = find_axis(file, x2);
  require_judgeable(file, x1, axis1, x2, axis2);
  const double spacing2 = axis1.is_rounding(axis2.spacing - axis1.spacing) ? axis1.spacing : axis2.spacing;
  const auto centre = [](const Axis& axis) { return axis.is_rounding(axis.centre()) ? 0.0 : axis.centre(); };
  FieldGrid found{{axis1.count, axis2.count, axis1.spacing, spacing2}, {centre(axis1), centre(axis2)}, {}};
  std::vector<Index> row_of(static_cast<std::size_t>(found.grid.cells()), -1);
  for (Index row = 0; row < x1.values.size(); ++row) {
    const Index cell =
        std::lround(axis1.place(x1.values[row])) * axis2.count + std::lround(axis2.place(x2.values[row]));
    Index& before = row_of[static_cast<std::size_t>(cell)];
    if (before >= 0) {
      throw InputError(file.string(), fmt::format("row {}: ({}, {}) is the cell of row {} again; allowed: one row "
                                                  "a cell",
                                                  row + 1, x1.values[row], x2.values[row], before + 1));
    }
    before = row;
    found.cells.push_back(cell);
  }
  return found;
}

ForeignField read_foreign_field(const std::filesystem::path& file, const std::vector<std::string>& names) {
  auto columns =
      solver::read_columns(file, {"x1", "x2", "pressure", "q1", "q2"}, {.columns = names, .may_be_missing = true});
  read_missing_as_no_contact(file, columns);
  const FieldGrid found = find_field_grid(file, columns[0], columns[1]);
  const ArrayXd& pressure = columns[2].values;
  const ArrayXd pressure_rounding = find_precision(pressure).rounding(pressure);
  const ArrayXd q1_rounding = find_precision(columns[3].values).rounding(columns[3].values);
  const ArrayXd q2_rounding = find_precision(columns[4].values).rounding(columns[4].values);
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
      throw InputError(file.string(),
                       fmt::format("row {}: pressure = {}; allowed: zero or positive", row + 1, pressure[row]));
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

GivenContact pose(const ForeignField& field, const solver::Dimensionless& bodies, int threads) {
  const solver::Dimensionless here = bodies.on_grid(field.grid, field.centre);
  const double length = here.length_unit;
  const double stress = here.stress_unit;
  GivenContact contact(here, {.law = here.law, .threads = threads},
                       {field.centre[0] / length, field.centre[1] / length}, field.pressure / stress,
                       field.traction / stress);
  const ArrayXd rounding = field.pressure_rounding / stress;
  const ArrayXd& p = contact.pressure;
  contact.bound_rounding =
      here.friction.is_coulomb()
          ? ArrayXd(here.friction.coefficient * rounding)
          : ArrayXd((p > 0.0).select(here.friction.bound(ArrayXd(p + rounding)) - contact.friction_bound, 0.0));
  contact.traction_rounding = field.traction_rounding / stress;
  return contact;
}

}  // namespace slipstick::convergence
