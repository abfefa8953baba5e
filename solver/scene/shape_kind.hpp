#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "solver/input/setting_key.hpp"
#include "solver/scene/surface.hpp"

/// The properties of each shape: one row of the table in shape_kind.cpp.
namespace slipstick::solver {

/// A shape's word, and the formulas of its undeformed gap. Consistent units. The formulas are null where the
/// shape has no axis: of height maps and of roughness.
struct ShapeKind {
  std::string word;
  Shape shape;
  /// Writes the gap at points along and across the shape's first axis; infinite where the bodies cannot
  /// touch.
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

}  // namespace slipstick::solver
