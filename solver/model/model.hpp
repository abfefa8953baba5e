#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/elasticity.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/grid/reduction.hpp"
#include "solver/scene/hertz_pressure.hpp"
#include "solver/scene/scene.hpp"
#include "solver/scene/to_dimensionless.hpp"

namespace slipstick::solver {

/// A unit of length, m. It belongs to the grid and the law that are counted in it: a Dimensionless takes it
/// with them, and nothing can put another one in its place.
class LengthUnit {
 public:
  LengthUnit(const LengthUnit&) = default;
  operator double() const { return metres_; }  // NOLINT(google-explicit-constructor): a number in m

 private:
  friend struct Dimensionless;
  explicit LengthUnit(double metres) : metres_(metres) {}
  LengthUnit& operator=(const LengthUnit&) = default;

  double metres_;
};

/// A scene made dimensionless, on a grid: lengths over one cell's size along x1, stresses over the combined
/// shear modulus G, so that the same scene in other units gives the same digits.
struct Dimensionless {
  explicit Dimensionless(double metres = 1.0) : length_unit(metres) {}

  /// The same bodies on another grid, in m, whose cells are the unit of length; a map of friction gives each
  /// cell the factor of the nearest one. centre: of that grid in the scene's coordinates, m.
  Dimensionless on_grid(const Grid& in_m, const std::array<double, 2>& centre) const;

  LengthUnit length_unit;
  double stress_unit = 1.0;  ///< Pa
  Grid grid{};
  ElasticPair pair{};  ///< the bodies, or the layers that are bonded to them
  SharedLaw law;       ///< of the bodies, their coatings and the layer between them
  FrictionLaw friction;
  bool hertzian = false;           ///< the pressure is Hertz's, wherever the body stands, up to the mesh
  bool pressure_coupling = false;  ///< K13, K23 enter

  /// The grid in m.
  Grid grid_in_m() const {
    return {grid.n1, grid.n2, grid.h1 * length_unit, grid.h2 * length_unit, grid.quadrant, grid.ranks};
  }
  double force_unit() const { return stress_unit * length_unit * length_unit; }
  double moment_unit() const { return force_unit() * length_unit; }
};

/// The problem that is solved for a scene on its own grid.
struct Model : Dimensionless {
  using Dimensionless::Dimensionless;

  std::optional<double> normal_load;       ///< the largest of the scene's steps
  Eigen::ArrayXd gap;                      ///< undeformed, one value a cell; infinite where the bodies cannot touch
  std::optional<HertzContact> hertz;       ///< where Hertz's theory holds as it stands, hertzian_radii, under that load
  bool shear_coupling = false;             ///< K31 and K32 enter too
  bool forces = false;                     ///< some step brings a tangential force or displacement
  Reduction pressure_part;                 ///< of the grid, on which the pressure is found
  int threads = 1;                         ///< that solve it
  std::shared_ptr<SolveCache> cache = {};  ///< of its operators; empty: none
};

/// How the model's displacements are computed on a part of its grid.
Elasticity elasticity(const Scene& scene, const Model& model, const Reduction& part);

}  // namespace slipstick::solver
