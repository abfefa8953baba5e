#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace slipstick::solver {

enum class Shape { sphere, ellipsoid, cone, flat_punch, rounded_punch, power, height_map, roughness };

/// How several shapes make one surface: their gaps add up, as of a sphere and its roughness; or each point
/// has the nearest of them, as of bodies side by side.
enum class Combine { sum, nearest };

/// An isotropic self-affine random surface: plane waves whose wave vectors are whole multiples of 2 pi/period
/// along x1 and x2, of power proportional to |k|^(-2 (1 + hurst)) between two wavelengths, and of random
/// phase. Lengths in m, or any one unit.
struct Roughness {
  std::uint64_t seed = 0;
  double hurst = 0.0;      ///< above 0, at most 1
  double longest = 0.0;    ///< wavelength
  double shortest = 0.0;   ///< wavelength, at most half the longest: so there are waves between the two
  double rms_slope = 0.0;  ///< of the gradient's length, over a period
  double period = 0.0;     ///< at least the longest wavelength
};

/// A measured surface: one height for each cell, larger where the surface is further away.
struct HeightMap {
  std::filesystem::path file{};
  std::array<double, 2> spacing{};  ///< m, between samples
  double unit = 1.0;                ///< m in one unit of the file's heights
  Eigen::ArrayXXd heights{};        ///< m, the least one 0; see with_heights
};

/// One shape of a body; the members that it uses are set. Lengths in m, or any one unit.
struct Surface {
  Shape shape = Shape::sphere;
  double radius = 0.0;         ///< sphere; flat_punch
  double inner_radius = 0.0;   ///< flat_punch: of the hole that makes it an annulus
  double radius_1 = 0.0;       ///< ellipsoid, radius of curvature along its first axis
  double radius_2 = 0.0;       ///< along its second
  double slope = 0.0;          ///< cone: gap over radius
  double flat_radius = 0.0;    ///< rounded_punch: of the flat face
  double corner_radius = 0.0;  ///< rounded_punch: gap (r - flat_radius)^2/(2 corner_radius) beyond it
  double exponent = 0.0;       ///< power: gap coefficient r^exponent, at least 1
  double coefficient = 0.0;    ///< power: m^(1 - exponent)
  HeightMap map{};
  Roughness roughness{};
  std::array<double, 2> at{};  ///< position of its axis; a height map and a rough surface have none
  double angle = 0.0;          ///< rad, from x1 to its first axis, positive towards x2
  std::string key = {};        ///< of its table in the scene file; empty: a program made it
};

std::string to_string(Shape shape);

}  // namespace slipstick::solver
