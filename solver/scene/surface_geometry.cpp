#include "solver/scene/surface_geometry.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

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
using Axes = std::array<double, 2>;

Axes circle(double radius) { return {radius, radius}; }

using Gap = Eigen::Ref<ArrayXd>;

/// Writes the points' distances from the axis where their gap will stand.
void write_distance(const ArrayXd& along, const ArrayXd& across, Gap r) {
  r = (along.square() + across.square()).sqrt();
}

void paraboloid_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  const auto [radius_1, radius_2] = paraboloid_radii(s);
  gap = along.square() / (2.0 * radius_1) + across.square() / (2.0 * radius_2);
}
Axes paraboloid_contact(const Surface& s, double load, double effective_modulus) {
  const auto [radius_1, radius_2] = paraboloid_radii(s);
  const HertzContact contact = hertz_contact(load, radius_1, radius_2, effective_modulus);
  return {contact.semi_axis_1, contact.semi_axis_2};
}
Axes paraboloid_below(const Surface& s, double depth) {
  const auto [radius_1, radius_2] = paraboloid_radii(s);
  return {std::sqrt(2.0 * radius_1 * depth), std::sqrt(2.0 * radius_2 * depth)};
}

void cone_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  write_distance(along, across, gap);
  gap *= s.slope;
}
/// Sneddon 1965: W = (pi/2) E* a^2 slope.
Axes cone_contact(const Surface& s, double load, double effective_modulus) {
  return circle(std::sqrt(2.0 * load / (pi * effective_modulus * s.slope)));
}
Axes cone_below(const Surface& s, double depth) { return circle(depth / s.slope); }

void flat_punch_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  write_distance(along, across, gap);
  gap = (gap >= s.inner_radius && gap <= s.radius)
            .select(ArrayXd::Zero(gap.size()), ArrayXd::Constant(gap.size(), std::numeric_limits<double>::infinity()));
}
Axes flat_punch_contact(const Surface& s, double /*load*/, double /*effective_modulus*/) { return circle(s.radius); }
Axes flat_punch_below(const Surface& s, double /*depth*/) { return circle(s.radius); }

void rounded_punch_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  write_distance(along, across, gap);
  gap = (gap - s.flat_radius).max(0.0).square() / (2.0 * s.corner_radius);
}
/// Sneddon 1965: W = 2 E* integral_0^a r^2 f'(r)/sqrt(a^2 - r^2) dr for a gap f, here (r - b)^2/(2 R) beyond
/// the flat radius b. The contact reaches further than the flat face, but not by more than the radius of a
/// sphere R under the same load.
Axes rounded_punch_contact(const Surface& surface, double load, double effective_modulus) {
  const double b = surface.flat_radius;
  const auto carried = [&](double a) {
    const double s = b / a;
    const double c = std::sqrt(1.0 - s * s);
    return 2.0 * effective_modulus * a * a / surface.corner_radius *
           (a * c * (1.0 - c * c / 3.0) - 0.5 * b * (std::acos(s) + s * c));
  };
  const double reach = std::cbrt(0.75 * load * surface.corner_radius / effective_modulus);
  return circle(bracketed_root([&](double a) { return carried(a) / load - 1.0; }, b, b + reach));
}
Axes rounded_punch_below(const Surface& s, double depth) {
  return circle(s.flat_radius + std::sqrt(2.0 * s.corner_radius * depth));
}

void power_gap(const Surface& s, const ArrayXd& along, const ArrayXd& across, Gap gap) {
  write_distance(along, across, gap);
  gap = s.coefficient * gap.pow(s.exponent);
}
/// Sneddon's integral of the gap coefficient r^exponent.
Axes power_contact(const Surface& s, double load, double effective_modulus) {
  const double n = s.exponent;
  const double integral = 0.5 * std::sqrt(pi) * std::tgamma(0.5 * n + 1.0) / std::tgamma(0.5 * n + 1.5);
  return circle(std::pow(load / (2.0 * effective_modulus * s.coefficient * n * integral), 1.0 / (n + 1.0)));
}
Axes power_below(const Surface& s, double depth) { return circle(std::pow(depth / s.coefficient, 1.0 / s.exponent)); }

const std::array kKinds{
    ShapeKind{"sphere", Shape::sphere, paraboloid_gap, paraboloid_contact, paraboloid_below},
    ShapeKind{"ellipsoid", Shape::ellipsoid, paraboloid_gap, paraboloid_contact, paraboloid_below},
    ShapeKind{"cone", Shape::cone, cone_gap, cone_contact, cone_below},
    ShapeKind{"flat_punch", Shape::flat_punch, flat_punch_gap, flat_punch_contact, flat_punch_below},
    ShapeKind{"rounded_punch", Shape::rounded_punch, rounded_punch_gap, rounded_punch_contact, rounded_punch_below},
    ShapeKind{"power", Shape::power, power_gap, power_contact, power_below},
    ShapeKind{"height_map", Shape::height_map, nullptr, nullptr, nullptr},
    ShapeKind{"roughness", Shape::roughness, nullptr, nullptr, nullptr}};

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

std::array<double, 2> paraboloid_radii(const Surface& s) {
  return s.shape == Shape::sphere ? circle(s.radius) : Axes{s.radius_1, s.radius_2};
}

const ShapeKind& kind_of(Shape shape) { return *std::ranges::find(kKinds, shape, &ShapeKind::shape); }

const Words<Shape>& shape_words() {
  static const Words<Shape> words = [] {
    Words<Shape> made;
    for (const ShapeKind& kind : kKinds) made.emplace_back(kind.word, kind.shape);
    return made;
  }();
  return words;
}

std::vector<std::string> words_with_axis() {
  std::vector<std::string> words;
  for (const ShapeKind& kind : kKinds) {
    if (kind.gap != nullptr) words.push_back(kind.word);
  }
  return words;
}

bool ShapeNumber::belongs_to(Shape shape) const { return std::ranges::find(shapes, shape) != shapes.end(); }

const std::vector<ShapeNumber>& shape_numbers() {
  using Name = const char*;
  const auto own = [](Name name, Name unit, const Range& allowed, Name meaning, std::vector<Shape> shapes,
                      double Surface::*at) {
    return ShapeNumber{name, unit, allowed, meaning, std::move(shapes), at, nullptr};
  };
  const auto rough = [](Name name, Name unit, const Range& allowed, Name meaning, double Roughness::*at) {
    return ShapeNumber{name, unit, allowed, meaning, {Shape::roughness}, nullptr, at};
  };
  static const std::vector<ShapeNumber> numbers{
      own("radius", "m", kPositive, "Radius of the sphere, or of the punch's face.", {Shape::sphere, Shape::flat_punch},
          &Surface::radius),
      own("radius_1", "m", kPositive, "Radius of curvature along the ellipsoid's first axis.", {Shape::ellipsoid},
          &Surface::radius_1),
      own("radius_2", "m", kPositive, "Radius of curvature along its second axis.", {Shape::ellipsoid},
          &Surface::radius_2),
      own("slope", "", kPositive, "Gap over radius.", {Shape::cone}, &Surface::slope),
      own("flat_radius", "m", kPositive, "Radius of the flat face.", {Shape::rounded_punch}, &Surface::flat_radius),
      own("corner_radius", "m", kPositive,
          "Radius of curvature beyond the face, where the gap is (r - flat_radius)^2/(2 corner_radius).",
          {Shape::rounded_punch}, &Surface::corner_radius),
      own("exponent", "", kExponent, "The gap is coefficient r^exponent.", {Shape::power}, &Surface::exponent),
      own("coefficient", "m^(1 - exponent)", kPositive, "Factor of that power.", {Shape::power}, &Surface::coefficient),
      rough("hurst", "", kHurst, "Hurst's exponent: the power of a wave vector k goes like |k|^(-2 (1 + hurst)).",
            &Roughness::hurst),
      rough("rms_slope", "", kPositive, "Root mean square of the gradient's length, over a period.",
            &Roughness::rms_slope),
      rough("longest", "m", kPositive, "Longest wavelength.", &Roughness::longest)};
  return numbers;
}

std::vector<double*> lengths(Surface& surface) {
  std::vector<double*> found{&surface.inner_radius,    &surface.at[0],          &surface.at[1],
                             &surface.map.spacing[0],  &surface.map.spacing[1], &surface.roughness.shortest,
                             &surface.roughness.period};
  for (const ShapeNumber& number : shape_numbers()) {
    if (number.unit == "m") found.push_back(&number.of(surface));
  }
  return found;
}

bool is_measured(const Surface& surface) { return kind_of(surface.shape).gap == nullptr; }

const Surface* find_height_map(const std::vector<Surface>& surfaces) {
  const auto found = std::ranges::find(surfaces, Shape::height_map, &Surface::shape);
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
      throw InputError(surface.map.file.string(),
                       fmt::format("{} x {} heights, {} x {} apart; allowed: {} x {}, {} x {} apart, as in {}",
                                   heights.rows(), heights.cols(), surface.map.spacing[0], surface.map.spacing[1],
                                   first->map.heights.rows(), first->map.heights.cols(), first->map.spacing[0],
                                   first->map.spacing[1], first->map.file.string()));
    }
  }
  return Grid{first->map.heights.rows(), first->map.heights.cols(), first->map.spacing[0], first->map.spacing[1]};
}

std::optional<std::array<double, 2>> expected_half_sides(const std::vector<Surface>& surfaces, Combine combine,
                                                         double load, double effective_modulus) {
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
  surface.map.heights = surface.map.heights.unaryExpr([unit](double height) { return to_dimensionless(height, unit); });
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
