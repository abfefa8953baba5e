#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "solver/stresses/subsurface_stresses.hpp"

/// Fatigue parameters of a cycle of stresses at a point, which passes through a few states. Pa; tension is
/// positive. States between the given ones are not seen.
namespace slipstick::solver {

using Tensor = Eigen::Matrix3d;

/// Shear stress that alternates, with the hydrostatic stress. The amplitude of a state is its deviator less
/// the centre of the smallest ball that holds all deviators, by the Frobenius norm; its shear stress is half
/// of its largest less its smallest principal value.
struct DangVan {
  double value = -std::numeric_limits<double>::infinity();  ///< largest shear + alpha hydrostatic
  double shear = 0.0;                                       ///< at the state of that
  double hydrostatic_mean = 0.0;                            ///< of the smallest and the largest one
  double hydrostatic_largest = 0.0;
};
/// Dang Van, Griveau and Message (1989), "On a new multiaxial fatigue limit criterion". alpha >= 0; zero
/// gives the largest amplitude of the shear stress. Error: rounding.
DangVan dang_van(std::span<const Tensor> states, double alpha);

/// The plane with the largest sum of the amplitude of its shear stress and k times its largest normal stress.
/// The amplitude is the radius of the smallest circle that holds the plane's shear stresses.
struct Findley {
  double value = -std::numeric_limits<double>::infinity();
  double shear = 0.0;            ///< amplitude
  double normal_stress = 0.0;    ///< largest
  std::array<double, 3> normal;  ///< of the plane; its sign is free
};
/// Findley (1959), "A theory for the effect of mean stress on fatigue of metals under combined torsion and
/// axial load or bending". k >= 0. The error is at most 1e-5 of the bounds of the shear stress's amplitude
/// plus k times the shear stress. Only planes that have more than `best` change it.
void find_plane(std::span<const Tensor> states, double k, Findley& best);

/// Coefficients of the parameters to compute; none: not computed.
struct FatigueCoefficients {
  std::optional<double> dang_van;  ///< alpha
  std::optional<double> findley;   ///< k
  bool any() const { return dang_van || findley; }
};

/// The largest parameters over all points, and where: x1, x2 and depth, m.
struct LargestFatigue {
  DangVan dang_van;
  Findley findley;
  std::array<double, 3> dang_van_at{}, findley_at{};

  /// The states of a cycle at one depth.
  void include(std::span<const StressPlane> states, const FatigueCoefficients& asked, const Grid& grid);
};

}  // namespace slipstick::solver
