#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "solver/grid/grid.hpp"
#include "solver/input/setting_key.hpp"
#include "solver/scene/surface.hpp"

/// The properties of each shape, one row of the table in surface_geometry.cpp, and of surfaces of several shapes.
namespace slipstick::solver {

/// A shape's word, and the formulas of its undeformed gap. Consistent units. The formulas are null where the
/// shape has no axis: of height maps and of roughness.
struct ShapeKind {
  std::string word;
  Shape shape;
  /// Writes the gap at points along and across the shape's first axis; infinite where the bodies cannot touch.
  void (*gap)(const Surface& surface, const Eigen::ArrayXd& along, const Eigen::ArrayXd& across,
              Eigen::Ref<Eigen::ArrayXd> gap);
  /// Semi-axes of the contact's ellipse under a normal load, on a pair of effective modulus E*.
  std::array<double, 2> (*contact)(const Surface& surface, double load, double effective_modulus);
  /// Semi-axes of the ellipse within which the gap is below a depth.
  std::array<double, 2> (*below)(const Surface& surface, double depth);
};
const ShapeKind& kind_of(Shape shape);
/// Radii of curvature of a sphere or an ellipsoid, along its own axes.
std::array<double, 2> paraboloid_radii(const Surface& surface);
const Words<Shape>& shape_words();
/// Words of the shapes that have an axis.
std::vector<std::string> words_with_axis();

/// A number that some shapes require, and its place in Surface.
struct ShapeNumber {
  std::string name;  ///< of its key in [upper] and [[upper.shape]]
  std::string unit;
  Range allowed;
  std::string meaning;
  std::vector<Shape> shapes;
  double Surface::*own = nullptr;
  double Roughness::*rough = nullptr;  ///< where it is none of Surface's own

  bool belongs_to(Shape shape) const;
  template <typename Body>  // Surface, const or not
  auto& of(Body& surface) const {
    return own != nullptr ? surface.*own : surface.roughness.*rough;
  }
};
/// All of them: they are read, validated and made dimensionless by this table.
const std::vector<ShapeNumber>& shape_numbers();

/// Every number of a surface that is a length.
std::vector<double*> lengths(Surface& surface);

/// Whether the heights have no level of their own: of height maps and of roughness.
bool is_measured(const Surface& surface);

/// The first height map among them; null if there is none.
const Surface* find_height_map(const std::vector<Surface>& surfaces);

/// The surfaces with the heights of their files. Throws InputError for a file that cannot be read or misses
/// points, with their place.
std::vector<Surface> with_heights(std::vector<Surface> surfaces);

/// The grid of the height maps that have been read, if there are any. Throws InputError where two disagree.
std::optional<Grid> height_map_grid(const std::vector<Surface>& surfaces);

/// Half the sides of a rectangle about the origin that the contact under a load W is expected to fill;
/// nothing where that is not known before solving: of sums, and of roughness.
std::optional<std::array<double, 2>> expected_half_sides(const std::vector<Surface>& surfaces, Combine combine,
                                                         double load, double effective_modulus);

/// Half the sides of a rectangle about the origin beyond which the gap, its least value taken as 0, is
/// nowhere below a depth; infinite where that is not known: of roughness, of height maps.
std::array<double, 2> half_sides_below(const std::vector<Surface>& surfaces, Combine combine, double depth);

/// Whether Hertz's theory holds, up to where the contact stands and how it is turned: of one sphere or ellipsoid.
bool is_hertzian(const std::vector<Surface>& surfaces);

/// Radii of curvature along x1 and x2 where Hertz's theory holds as it stands: of one sphere or ellipsoid at
/// the origin, its axes along the grid's.
std::optional<std::array<double, 2>> hertzian_radii(const std::vector<Surface>& surfaces);

/// The same surface in another unit of length, its numbers rounded as to_dimensionless does.
Surface to_dimensionless(Surface surface, double unit);

/// Undeformed gap at cell centres, infinite where the bodies cannot touch. With height maps and roughness,
/// whose level means nothing, the least gap is 0.
Eigen::ArrayXd gap_field(const std::vector<Surface>& surfaces, Combine combine, const Grid& grid);

}  // namespace slipstick::solver
