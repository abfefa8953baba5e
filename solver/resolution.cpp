#include "solver/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// The cells where a field is not zero.
struct Area {
  double cells = 0.0;
  double outline = 0.0;  ///< its length in sides of cells
  double mean = 0.0;     ///< of the field
  double edge = 0.0;     ///< of the field along the outline
};

Area measure(const Grid& grid, const ArrayXd& field) {
  Area area;
  for (Index i = 0, k = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j, ++k) {
      const double value = field[k];
      if (value == 0.0) continue;
      int sides = 0;
      sides += i == 0 || field[k - grid.n2] == 0.0;
      sides += i + 1 == grid.n1 || field[k + grid.n2] == 0.0;
      sides += j == 0 || field[k - 1] == 0.0;
      sides += j + 1 == grid.n2 || field[k + 1] == 0.0;
      area.cells += 1.0;
      area.mean += value;
      area.outline += sides;
      area.edge += sides * value;
    }
  }
  if (area.cells == 0.0) return area;
  area.mean /= area.cells;
  area.edge /= area.outline;
  // A staircase is longer than the curve that it follows, by 4/pi in the mean over all directions.
  area.outline *= std::numbers::pi / 4.0;
  return area;
}

/// The friction bound where the body would turn, over the contact's cells nearest to there; 0 where that is
/// outside the contact, or the body would not turn.
double bound_at_centre(const Grid& grid, const LoadStep& loads) {
  if (!loads.limit.centre) return 0.0;
  const auto cell = [](double x, double h, Index n) {
    return std::floor(x / h + 0.5 * static_cast<double>(n));
  };
  const double i = cell((*loads.limit.centre)[0], grid.h1, grid.n1);
  const double j = cell((*loads.limit.centre)[1], grid.h2, grid.n2);
  const bool on_grid =
      i >= 0.0 && j >= 0.0 && i < static_cast<double>(grid.n1) && j < static_cast<double>(grid.n2);
  return on_grid ? loads.problem.friction_bound[static_cast<Index>(i) * grid.n2 + static_cast<Index>(j)]
                 : 0.0;
}

/// What the twist lacks where the stick area should be smaller than the mesh shows it.
double missing_twist(const Grid& grid, const LoadStep& loads) {
  const double bound = bound_at_centre(grid, loads);
  if (!(bound > 0.0) || loads.limit.sliding.twist == 0.0) return 0.0;
  // The loads do unit work in the sliding motion: over its twist that is a moment, with all lever arms.
  const double moment = grid.cell_area() / std::abs(loads.limit.sliding.twist);
  const auto unresolved = [&](double missing) {
    constexpr double kPart = 0.5;
    const double stick_radius = std::cbrt(9.0 * missing / (8.0 * bound));
    return 0.5 * std::log1p(kPart * grid.cell_area() / (stick_radius * stick_radius));
  };
  const double limit = loads.limit.factor * moment;
  if (!std::isfinite(limit)) return 0.0;
  return 0.5 * bound * (unresolved(limit - moment) - unresolved(limit));
}

}  // namespace

Resolution resolution(const Grid& grid, const LoadStep& loads, const ArrayXd& stick, double twist) {
  const Area contact = measure(grid, loads.problem.friction_bound);
  if (contact.cells == 0.0) return {};
  const Area sticking = measure(grid, stick);
  const Area slipping = measure(grid, (loads.problem.friction_bound > 0.0 && stick == 0.0).cast<double>());
  Resolution result;
  if (sticking.cells > 0.0) result.stick_width = 4.0 * sticking.cells / sticking.outline;
  if (slipping.cells > 0.0) result.slip_width = 2.0 * slipping.cells / slipping.outline;
  const double cell = 0.5 * contact.outline / contact.cells;  // over the mean radius
  const double edge = std::min(1.0, contact.edge / contact.mean);
  result.uncertainty = 0.5 * cell * cell + 0.25 * edge * edge * cell;
  const double missing = missing_twist(grid, loads);
  if (missing > 0.0) {
    result.uncertainty +=
        sticking.cells > 0.0 ? missing / std::abs(twist) : std::numeric_limits<double>::infinity();
  }
  return result;
}

}  // namespace slipstick::solver
