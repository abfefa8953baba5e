#include "solver/scene/surface_geometry.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/roughness.hpp"
#include "solver/scene/shape_kind.hpp"
#include "solver/scene/to_dimensionless.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Heights over a grid of cells as a field over it.
ArrayXd as_field(const Eigen::ArrayXXd& heights) {
  const Eigen::ArrayXXd by_x2 = heights.transpose();  // column-major: x2 runs fastest
  return by_x2.reshaped();
}

Eigen::ArrayXXd read_heights(const Surface& surface) {
  const Eigen::ArrayXXd heights = read_matrix(surface.map.file, "height");
  const Grid grid{heights.rows(), heights.cols(), surface.map.spacing[0], surface.map.spacing[1]};
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) {
      if (std::isfinite(heights(i, j))) continue;
      throw InputError(surface.map.file.string(),
                       fmt::format("row {}, column {} (x1 = {:.6g}, x2 = {:.6g}): no height; allowed: a "
                                   "finite number at every point",
                                   i + 1, j + 1, grid.x1(i), grid.x2(j)));
    }
  }
  return (heights - heights.minCoeff()) * surface.map.unit;
}

/// Half the sides of the rectangle, along x1 and x2, about an ellipse that is turned.
std::array<double, 2> box_of_ellipse(const std::array<double, 2>& semi_axes, double angle) {
  const auto [along, across] = semi_axes;
  if (along == across) return semi_axes;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {std::hypot(c * along, s * across), std::hypot(s * along, c * across)};
}

ArrayXd gap_field(const Surface& surface, const Grid& grid) {
  if (surface.shape == Shape::height_map) return as_field(surface.map.heights);
  if (surface.shape == Shape::roughness) return roughness_heights(surface.roughness, grid);
  const ShapeKind& kind = kind_of(surface.shape);
  const double c = std::cos(surface.angle);
  const double s = std::sin(surface.angle);
  const ArrayXd from_2 = ArrayXd::NullaryExpr(grid.n2, [&](Index j) { return grid.x2(j); }) - surface.at[1];
  ArrayXd gap(grid.cells());
  ArrayXd along(grid.n2);
  ArrayXd across(grid.n2);
  for (Index i = 0; i < grid.n1; ++i) {
    const double from_1 = grid.x1(i) - surface.at[0];
    along = c * from_1 + s * from_2;
    across = c * from_2 - s * from_1;
    kind.gap(surface, along, across, gap.segment(i * grid.n2, grid.n2));
  }
  return gap;
}

}  // namespace

bool is_measured(const Surface& surface) { return kind_of(surface.shape).gap == nullptr; }

const Surface* find_height_map(const std::vector<Surface>& surfaces) {
  const auto found = std::find_if(surfaces.begin(), surfaces.end(),
                                  [](const Surface& surface) { return surface.shape == Shape::height_map; });
  return found == surfaces.end() ? nullptr : &*found;
}

std::vector<Surface> with_heights(std::vector<Surface> surfaces) {
  for (Surface& surface : surfaces) {
    if (surface.shape == Shape::height_map && surface.map.heights.size() == 0)
      surface.map.heights = read_heights(surface);
  }
  return surfaces;
}

std::optional<Grid> height_map_grid(const std::vector<Surface>& surfaces) {
  const Surface* const first = find_height_map(surfaces);
  if (first == nullptr) return std::nullopt;
  for (const Surface& surface : surfaces) {
    if (surface.shape != Shape::height_map) continue;
    const auto& heights = surface.map.heights;
    if (heights.rows() != first->map.heights.rows() || heights.cols() != first->map.heights.cols() ||
        surface.map.spacing != first->map.spacing) {
      throw InputError(
          surface.map.file.string(),
          fmt::format("{} x {} heights, {} x {} apart; allowed: {} x {}, {} x {} apart, as in {}",
                      heights.rows(), heights.cols(), surface.map.spacing[0], surface.map.spacing[1],
                      first->map.heights.rows(), first->map.heights.cols(), first->map.spacing[0],
                      first->map.spacing[1], first->map.file.string()));
    }
  }
  return Grid{first->map.heights.rows(), first->map.heights.cols(), first->map.spacing[0],
              first->map.spacing[1]};
}

std::optional<std::array<double, 2>> expected_half_sides(const std::vector<Surface>& surfaces,
                                                         Combine combine, double load,
                                                         double effective_modulus) {
  if (surfaces.size() > 1 && combine == Combine::sum) return std::nullopt;
  std::array<double, 2> half_sides{};
  for (const Surface& surface : surfaces) {
    if (is_measured(surface)) return std::nullopt;
    const auto semi_axes = kind_of(surface.shape).contact(surface, load, effective_modulus);
    const auto about_axis = box_of_ellipse(semi_axes, surface.angle);
    for (std::size_t i = 0; i < 2; ++i) {
      half_sides[i] = std::max(half_sides[i], std::abs(surface.at[i]) + about_axis[i]);
    }
  }
  return half_sides;
}

std::array<double, 2> half_sides_below(const std::vector<Surface>& surfaces, Combine combine, double depth) {
  const bool nearest = combine == Combine::nearest;
  std::array<double, 2> half_sides{};
  if (!nearest) half_sides.fill(std::numeric_limits<double>::infinity());
  for (const Surface& surface : surfaces) {
    constexpr double kEverywhere = std::numeric_limits<double>::infinity();
    std::array<double, 2> about_axis{kEverywhere, kEverywhere};
    if (!is_measured(surface)) {
      about_axis = box_of_ellipse(kind_of(surface.shape).below(surface, depth), surface.angle);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const double half_side = std::abs(surface.at[i]) + about_axis[i];
      half_sides[i] = nearest ? std::max(half_sides[i], half_side) : std::min(half_sides[i], half_side);
    }
  }
  return half_sides;
}

bool is_hertzian(const std::vector<Surface>& surfaces) {
  const Shape shape = surfaces.front().shape;
  return surfaces.size() == 1 && (shape == Shape::sphere || shape == Shape::ellipsoid);
}

std::optional<std::array<double, 2>> hertzian_radii(const std::vector<Surface>& surfaces) {
  const Surface& surface = surfaces.front();
  if (!is_hertzian(surfaces) || surface.at != std::array{0.0, 0.0}) return std::nullopt;
  const auto radii = paraboloid_radii(surface);
  if (surface.angle != 0.0 && radii[0] != radii[1]) return std::nullopt;
  return radii;
}

Surface to_dimensionless(Surface surface, double unit) {
  for (double* const length : lengths(surface)) *length = to_dimensionless(*length, unit);
  surface.coefficient = to_dimensionless(surface.coefficient, std::pow(unit, 1.0 - surface.exponent));
  surface.map.heights =
      surface.map.heights.unaryExpr([unit](double height) { return to_dimensionless(height, unit); });
  return surface;
}

ArrayXd gap_field(const std::vector<Surface>& surfaces, Combine combine, const Grid& grid) {
  ArrayXd gap = gap_field(surfaces.front(), grid);
  for (std::size_t i = 1; i < surfaces.size(); ++i) {
    const ArrayXd other = gap_field(surfaces[i], grid);
    if (combine == Combine::sum) {
      gap += other;
    } else {
      gap = gap.min(other);
    }
  }
  if (std::any_of(surfaces.begin(), surfaces.end(), is_measured)) gap -= gap.minCoeff();
  return gap;
}

}  // namespace slipstick::solver
