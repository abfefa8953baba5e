#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "solver/hertz_pressure.hpp"
#include "solver/reduction.hpp"
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
  Reduction pressure_part;            ///< of the grid, on which the pressure is found
  std::vector<Omission> left_out;

  double force_unit() const { return stress_unit * length_unit * length_unit; }
  double moment_unit() const { return force_unit() * length_unit; }
};

/// A value over its unit, as models hold it: rounded to 40 bits. Twelve digits are more than any scene's data
/// have, and the roundings that came in with the scene's units, which conjugate gradients would amplify, are
/// gone.
double over_unit(double value, double unit);

/// The part of the grid on which tractions are found under a pressure, and what that leaves out.
Reduction traction_part(const Scene& scene, Model& model, const Eigen::ArrayXd& pressure);

/// How the model's displacements are computed on a part of its grid.
Elasticity elasticity(const Scene& scene, const Model& model, const Reduction& part);

/// Throws InputError for a height map that cannot be used and for cells that do not fit in memory.
Model make_model(const Scene& scene);

/// Memory that solving the scene takes, in bytes: operators, workspaces, fields.
struct Memory {
  double solver;  ///< operators and workspaces of the larger of the two problems, Solution::bytes
  double fields;  ///< the model's and the solution's, on the whole grid
  double total() const { return solver + fields; }
};
Memory predicted_memory(const Scene& scene, const Model& model);

}  // namespace slipstick::solver
