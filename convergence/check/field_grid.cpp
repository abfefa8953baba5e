#include "convergence/check/field_grid.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "convergence/check/file_precision.hpp"
#include "solver/input_error.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

/// A contact has an inside and an edge on both sides.
constexpr std::size_t kFewestAcross = 4;
/// Positions closer than this part of the grid's side are one: no grid has so many cells.
constexpr double kSamePlace = 1e-6;
/// Contacts that fill less of their bounding rectangle are taken for a mistake in a position.
constexpr double kSparsest = 1e-4;
/// A position may be off its cell's centre by this part of the cell, or by what its digits leave open, as far
/// as that still tells cells apart.
constexpr double kOffCentre = 1e-2;
constexpr double kTellsCellsApart = 0.25;

/// Equally spaced places along one axis.
struct Axis {
  double first = 0.0;
  double spacing = 0.0;
  Index count = 0;

  double place(double x) const { return (x - first) / spacing; }
  double centre() const { return first + 0.5 * static_cast<double>(count - 1) * spacing; }
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

/// Least squares of the places against whole numbers of steps. Rows that miss are left as gaps.
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

Axis find_axis(const std::filesystem::path& file, const solver::Column& x) {
  const double range = x.values.maxCoeff() - x.values.minCoeff();
  const std::vector<double> places = distinct_places(x.values, kSamePlace * range);
  if (places.size() < kFewestAcross) {
    throw solver::InputError(
        file.string(), fmt::format("column {}: {} different values; allowed: at least {}, one for each row "
                                   "of cells across the contact",
                                   x.name, places.size(), kFewestAcross));
  }
  const Axis axis = fit_axis(places);
  const ArrayXd place = (x.values - axis.first) / axis.spacing;
  Index worst = 0;
  const double off = (place - place.round()).abs().maxCoeff(&worst);
  const double rounding = find_precision(x.values).rounding(x.values).maxCoeff() / axis.spacing;
  if (off <= std::clamp(2.0 * rounding, kOffCentre, kTellsCellsApart)) return axis;
  throw solver::InputError(
      file.string(), fmt::format("row {}: {} = {} is on no regular grid; allowed: about {:.4g} plus a whole "
                                 "number of steps of {:.4g}, as most rows have it",
                                 worst + 1, x.name, x.values[worst], axis.first, axis.spacing));
}

}  // namespace

FieldGrid find_field_grid(const std::filesystem::path& file, const solver::Column& x1,
                          const solver::Column& x2) {
  const Axis axis1 = find_axis(file, x1);
  const Axis axis2 = find_axis(file, x2);
  FieldGrid found{
      {axis1.count, axis2.count, axis1.spacing, axis2.spacing}, {axis1.centre(), axis2.centre()}, {}};
  if (static_cast<double>(x1.values.size()) < kSparsest * static_cast<double>(found.grid.cells())) {
    throw solver::InputError(
        file.string(), fmt::format("{} rows on a grid of {} x {} cells of {:.4g} x {:.4g}; allowed: one row "
                                   "for each cell of the contact, on one regular grid",
                                   x1.values.size(), axis1.count, axis2.count, axis1.spacing, axis2.spacing));
  }
  std::vector<Index> row_of(static_cast<std::size_t>(found.grid.cells()), -1);
  for (Index row = 0; row < x1.values.size(); ++row) {
    const Index cell =
        std::lround(axis1.place(x1.values[row])) * axis2.count + std::lround(axis2.place(x2.values[row]));
    Index& before = row_of[static_cast<std::size_t>(cell)];
    if (before >= 0) {
      throw solver::InputError(file.string(),
                               fmt::format("row {}: ({}, {}) is the cell of row {} again; allowed: one row "
                                           "a cell",
                                           row + 1, x1.values[row], x2.values[row], before + 1));
    }
    before = row;
    found.cells.push_back(cell);
  }
  return found;
}

}  // namespace slipstick::convergence
