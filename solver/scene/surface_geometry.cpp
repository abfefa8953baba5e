#include "solver/scene/surface_geometry.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/bracketed_root.hpp"
#include "solver/scene/hertz_pressure.hpp"
#include "solver/scene/roughness.hpp"
#include "solver/scene/scene_keys.hpp"
#include "solver/scene/to_dimensionless.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using std::numbers::pi;

/// Radii of curvature of a sphere or an ellipsoid, along its own axes.
std::array<double, 2> paraboloid_radii(const Surface& surface) {
  if (surface.shape == Shape::sphere) return {surface.radius, surface.radius};
  return {surface.radius_1, surface.radius_2};
}

/// Heights over a grid of cells as a field over it.
ArrayXd as_field(const Eigen::ArrayXXd& heights) {
  const Eigen::ArrayXXd by_x2 = heights.transpose();  // column-major: x2 runs fastest
  return by_x2.reshaped();
}

Eigen::ArrayXXd read_heights(const Surface& surface) {
  const Eigen::ArrayXXd heights = read_height_map(surface.file);
  const Grid grid{heights.rows(), heights.cols(), surface.spacing[0], surface.spacing[1]};
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) {
      if (std::isfinite(heights(i, j))) continue;
      throw InputError(surface.file.string(),
                       fmt::format("row {}, column {} (x1 = {:.6g}, x2 = {:.6g}): no height; allowed: a "
                                   "finite number at every point",
                                   i + 1, j + 1, grid.x1(i), grid.x2(j)));
    }
  }
  return (heights - heights.minCoeff()) * surface.height_unit;
}

/// Sneddon 1965: W = 2 E* integral_0^a r^2 f'(r)/sqrt(a^2 - r^2) dr for a gap f = coefficient r^exponent.
double power_contact_radius(const Surface& surface, double load, double effective_modulus) {
  const double n = surface.exponent;
  const double integral = 0.5 * std::sqrt(pi) * std::tgamma(0.5 * n + 1.0) / std::tgamma(0.5 * n + 1.5);
  return std::pow(load / (2.0 * effective_modulus * surface.coefficient * n * integral), 1.0 / (n + 1.0));
}

/// The same with f = (r - b)^2/(2 R) beyond the flat radius b. The contact reaches further than the flat
/// face, but not by more than the radius of a sphere R under the same load.
double rounded_punch_contact_radius(const Surface& surface, double load, double effective_modulus) {
  const double b = surface.flat_radius;
  const auto carried = [&](double a) {
    const double s = b / a;
    const double c = std::sqrt(1.0 - s * s);
    return 2.0 * effective_modulus * a * a / surface.corner_radius *
           (a * c * (1.0 - c * c / 3.0) - 0.5 * b * (std::acos(s) + s * c));
  };
  const double reach = std::cbrt(0.75 * load * surface.corner_radius / effective_modulus);
  return bracketed_root([&](double a) { return carried(a) / load - 1.0; }, b, b + reach);
}

/// Half the sides of the rectangle about an ellipse that is turned.
std::array<double, 2> box_of_ellipse(double semi_axis_1, double semi_axis_2, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {std::hypot(c * semi_axis_1, s * semi_axis_2), std::hypot(s * semi_axis_1, c * semi_axis_2)};
}

/// Half the sides of the rectangle, along x1 and x2, about the shape's own axis.
std::optional<std::array<double, 2>> half_sides_about_axis(const Surface& surface, double load,
                                                           double effective_modulus) {
  const auto square = [](double radius) { return std::array{radius, radius}; };
  switch (surface.shape) {
    case Shape::sphere:
    case Shape::ellipsoid: {
      const auto radii = paraboloid_radii(surface);
      const HertzContact contact = hertz_contact(load, radii[0], radii[1], effective_modulus);
      return box_of_ellipse(contact.semi_axis_1, contact.semi_axis_2, surface.angle);
    }
    case Shape::cone:  // Sneddon 1965: W = (pi/2) E* a^2 slope
      return square(std::sqrt(2.0 * load / (pi * effective_modulus * surface.slope)));
    case Shape::flat_punch:
      return square(surface.radius);
    case Shape::rounded_punch:
      return square(rounded_punch_contact_radius(surface, load, effective_modulus));
    case Shape::power:
      return square(power_contact_radius(surface, load, effective_modulus));
    case Shape::height_map:
    case Shape::roughness:
      return std::nullopt;
  }
  throw std::logic_error("unknown shape");
}

/// Half the sides of the rectangle about the shape's own axis within which its gap is below a depth.
std::array<double, 2> half_sides_below(const Surface& surface, double depth) {
  const auto square = [](double radius) { return std::array{radius, radius}; };
  switch (surface.shape) {
    case Shape::sphere:
    case Shape::ellipsoid: {
      const auto radii = paraboloid_radii(surface);
      return box_of_ellipse(std::sqrt(2.0 * radii[0] * depth), std::sqrt(2.0 * radii[1] * depth),
                            surface.angle);
    }
    case Shape::cone:
      return square(depth / surface.slope);
    case Shape::flat_punch:
      return square(surface.radius);
    case Shape::rounded_punch:
      return square(surface.flat_radius + std::sqrt(2.0 * surface.corner_radius * depth));
    case Shape::power:
      return square(std::pow(depth / surface.coefficient, 1.0 / surface.exponent));
    case Shape::height_map:
    case Shape::roughness:
      return square(std::numeric_limits<double>::infinity());
  }
  throw std::logic_error("unknown shape");
}

/// height(along, across, row) writes the heights over a row of the shape's own coordinates.
template <typename Height>
ArrayXd by_rows(const Surface& surface, const Grid& grid, const Height& height) {
  const double c = std::cos(surface.angle);
  const double s = std::sin(surface.angle);
  const ArrayXd from_2 = ArrayXd::NullaryExpr(grid.n2, [&](Index j) { return grid.x2(j); }) - surface.at[1];
  ArrayXd heights(grid.cells());
  ArrayXd along(grid.n2);
  ArrayXd across(grid.n2);
  for (Index i = 0; i < grid.n1; ++i) {
    const double from_1 = grid.x1(i) - surface.at[0];
    along = c * from_1 + s * from_2;
    across = c * from_2 - s * from_1;
    height(along, across, heights.segment(i * grid.n2, grid.n2));
  }
  return heights;
}

/// height(r) gives the heights at distances from the axis.
template <typename Height>
ArrayXd by_distance(const Surface& surface, const Grid& grid, const Height& height) {
  ArrayXd r(grid.n2);
  return by_rows(surface, grid, [&](const ArrayXd& along, const ArrayXd& across, auto row) {
    r = (along.square() + across.square()).sqrt();
    row = height(r);
  });
}

ArrayXd gap_field(const Surface& surface, const Grid& grid) {
  switch (surface.shape) {
    case Shape::sphere:
    case Shape::ellipsoid: {
      const auto radii = paraboloid_radii(surface);
      return by_rows(surface, grid, [&](const ArrayXd& along, const ArrayXd& across, auto row) {
        row = along.square() / (2.0 * radii[0]) + across.square() / (2.0 * radii[1]);
      });
    }
    case Shape::cone:
      return by_distance(surface, grid, [&](const ArrayXd& r) { return (surface.slope * r).eval(); });
    case Shape::flat_punch:
      return by_distance(surface, grid, [&](const ArrayXd& r) {
        return (r >= surface.inner_radius && r <= surface.radius)
            .select(ArrayXd::Zero(r.size()),
                    ArrayXd::Constant(r.size(), std::numeric_limits<double>::infinity()))
            .eval();
      });
    case Shape::rounded_punch:
      return by_distance(surface, grid, [&](const ArrayXd& r) {
        return ((r - surface.flat_radius).max(0.0).square() / (2.0 * surface.corner_radius)).eval();
      });
    case Shape::power:
      return by_distance(surface, grid, [&](const ArrayXd& r) {
        return (surface.coefficient * r.pow(surface.exponent)).eval();
      });
    case Shape::height_map:
      return as_field(surface.heights);
    case Shape::roughness:
      return roughness_heights(surface.roughness, grid);
  }
  throw std::logic_error("unknown shape");
}

}  // namespace

bool is_measured(const Surface& surface) {
  return surface.shape == Shape::height_map || surface.shape == Shape::roughness;
}

const Surface* find_height_map(const std::vector<Surface>& surfaces) {
  const auto found = std::find_if(surfaces.begin(), surfaces.end(),
                                  [](const Surface& surface) { return surface.shape == Shape::height_map; });
  return found == surfaces.end() ? nullptr : &*found;
}

std::vector<Surface> with_heights(std::vector<Surface> surfaces) {
  for (Surface& surface : surfaces) {
    if (surface.shape == Shape::height_map && surface.heights.size() == 0)
      surface.heights = read_heights(surface);
  }
  return surfaces;
}

std::optional<Grid> height_map_grid(const std::vector<Surface>& surfaces) {
  const Surface* const first = find_height_map(surfaces);
  if (first == nullptr) return std::nullopt;
  for (const Surface& surface : surfaces) {
    if (surface.shape != Shape::height_map) continue;
    const auto& heights = surface.heights;
    if (heights.rows() != first->heights.rows() || heights.cols() != first->heights.cols() ||
        surface.spacing != first->spacing) {
      throw InputError(
          surface.file.string(),
          fmt::format("{} x {} heights, {} x {} apart; allowed: {} x {}, {} x {} apart, as in {}",
                      heights.rows(), heights.cols(), surface.spacing[0], surface.spacing[1],
                      first->heights.rows(), first->heights.cols(), first->spacing[0], first->spacing[1],
                      first->file.string()));
    }
  }
  return Grid{first->heights.rows(), first->heights.cols(), first->spacing[0], first->spacing[1]};
}

std::optional<std::array<double, 2>> expected_half_sides(const std::vector<Surface>& surfaces,
                                                         Combine combine, double load,
                                                         double effective_modulus) {
  if (surfaces.size() > 1 && combine == Combine::sum) return std::nullopt;
  std::array<double, 2> half_sides{};
  for (const Surface& surface : surfaces) {
    const auto about_axis = half_sides_about_axis(surface, load, effective_modulus);
    if (!about_axis) return std::nullopt;
    for (std::size_t i = 0; i < 2; ++i) {
      half_sides[i] = std::max(half_sides[i], std::abs(surface.at[i]) + (*about_axis)[i]);
    }
  }
  return half_sides;
}

std::array<double, 2> half_sides_below(const std::vector<Surface>& surfaces, Combine combine, double depth) {
  const bool nearest = combine == Combine::nearest;
  std::array<double, 2> half_sides{};
  if (!nearest) half_sides.fill(std::numeric_limits<double>::infinity());
  for (const Surface& surface : surfaces) {
    const auto about_axis = half_sides_below(surface, depth);
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
  for (const ShapeNumber& number : shape_numbers()) {
    if (number.unit == "m") number.of(surface) = to_dimensionless(number.of(surface), unit);
  }
  for (double* const length : {&surface.inner_radius, &surface.at[0], &surface.at[1], &surface.spacing[0],
                               &surface.spacing[1], &surface.roughness.shortest, &surface.roughness.period}) {
    *length = to_dimensionless(*length, unit);
  }
  surface.coefficient = to_dimensionless(surface.coefficient, std::pow(unit, 1.0 - surface.exponent));
  surface.heights =
      surface.heights.unaryExpr([unit](double height) { return to_dimensionless(height, unit); });
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
