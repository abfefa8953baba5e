#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "solver/stresses/subsurface_stresses.hpp"

/// Fatigue parameters of a cycle of stresses at a point, which passes through a few states. Pa; tension is
/// positive. States between the given ones are not seen.
namespace slipstick::solver {

using Tensor = Eigen::Matrix3d;

/// Shear stress that alternates, and the hydrostatic stress with it. The amplitude tensor of a state is its
/// deviator less the centre of the smallest ball that holds all deviators, by the Frobenius norm; its shear
/// stress is half of its largest less its smallest principal value.
struct DangVan {
  double value;             ///< largest over the states of shear + alpha hydrostatic
  double shear;             ///< at the state of that
  double hydrostatic_mean;  ///< of the smallest and the largest one
  double hydrostatic_largest;
};
/// Dang Van, Griveau and Message (1989), "On a new multiaxial fatigue limit criterion". alpha >= 0; zero
/// gives the largest amplitude of the shear stress. Error: rounding.
DangVan dang_van(std::span<const Tensor> states, double alpha);

/// The plane with the largest sum of the amplitude of its shear stress and k times its largest normal stress.
/// The amplitude is the radius of the smallest circle that holds the plane's shear stresses.
struct Findley {
  double value;
  double shear;                  ///< amplitude, Pa
  double normal_stress;          ///< largest
  std::array<double, 3> normal;  ///< of the plane; its sign is free
};
/// Findley (1959), "A theory for the effect of mean stress on fatigue of metals under combined torsion and
/// axial load or bending". k >= 0. The search over planes by bisection leaves out only planes that cannot
/// have more: the error is at most 1e-5 of the largest shear amplitude plus k times the largest shear stress.
/// Empty where no plane has more than `above`.
std::optional<Findley> findley(std::span<const Tensor> states, double k, double above);

/// Coefficients of the parameters to compute; none: not computed.
struct FatigueCoefficients {
  std::optional<double> dang_van;  ///< alpha
  std::optional<double> findley;   ///< k
  bool any() const { return dang_van || findley; }
};

/// The largest parameters over all points, and where: x1, x2 and depth, m.
struct LargestFatigue {
  template <typename Parameter>
  struct Place {
    Parameter found{-std::numeric_limits<double>::infinity(), {}, {}, {}};
    std::array<double, 3> at{};
  };
  Place<DangVan> shear;  ///< alpha = 0
  Place<DangVan> dang_van;
  Place<Findley> findley;

  /// The states of a cycle at one depth.
  void include(std::span<const StressPlane> states, const FatigueCoefficients& asked, const Grid& grid);
};

}  // namespace slipstick::solver
