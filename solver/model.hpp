#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "solver/hertz_pressure.hpp"
#include "solver/scene.hpp"

namespace slipstick::solver {

/// Something that a scene lets the model leave out, and why its answer does not change by that.
struct Omission {
  std::string what;
  std::string why;
};

/// A scene made dimensionless: lengths over one cell's size along x1, stresses over the combined shear
/// modulus G, so that the same scene in other units gives the same digits.
struct Model {
  double length_unit;  ///< m
  double stress_unit;  ///< Pa
  Grid grid;
  ElasticPair pair;
  double friction;
  std::optional<double> normal_load;
  Eigen::ArrayXd gap;  ///< undeformed, one value a cell; infinite where the bodies cannot touch
  std::optional<HertzContact> hertz;  ///< of a sphere or an ellipsoid
  bool pressure_coupling;             ///< K13, K23 enter
  std::vector<Omission> left_out;

  double force_unit() const { return stress_unit * length_unit * length_unit; }
  double moment_unit() const { return force_unit() * length_unit; }
};

/// A value over its unit, as models hold it: rounded to 40 bits. Twelve digits are more than any scene's data
/// have, and the roundings that came in with the scene's units, which conjugate gradients would amplify, are
/// gone.
double over_unit(double value, double unit);

/// Throws InputError for a height map that cannot be used and for cells that do not fit in memory.
Model make_model(const Scene& scene);

/// Memory that solving the scene takes, in bytes, operators and fields.
double predicted_bytes(const Scene& scene, const Grid& grid, bool pressure_coupling);

}  // namespace slipstick::solver
