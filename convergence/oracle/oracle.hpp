#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "analytic/axisymmetric.hpp"
#include "analytic/torsion.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

struct ContactPlace {
  std::array<double, 2> centre;       ///< m, of the axis
  double axis_ratio = 1.0;            ///< of an elliptic contact: its semi-axis at `angle` over the other
  double angle = 0.0;                 ///< rad, from x1
  std::array<double, 2> direction{};  ///< of the shear tractions; zero: around the axis
};

struct NormalContact {
  std::shared_ptr<const analytic::Profile> profile;
  double reference_pressure;  ///< Pa, the profile's p0
  double peak_pressure;       ///< Pa; infinite under a cone and a flat punch
  double approach;            ///< m
};

/// The largest shear tractions and loads.
struct FrictionLimit {
  /// Profile of the friction bound, over reference_bound; under Coulomb's law the pressure's profile.
  std::shared_ptr<const analytic::Profile> bound;
  double reference_bound = 0.0;  ///< Pa: mu p0 under Coulomb's law
  double force = 0.0;            ///< N, that slides the contact along a line: mu W under Coulomb's law
  double moment_limit;           ///< N m
};

/// The exact answer for an axisymmetric scene, in the scene's units (SI): the normal contact of its indenter (Hertz,
/// Love, Boussinesq, Sneddon, Ciavarella), in torsion about its own axis (Lubkin 1951; Jaeger 1995) or under a
/// tangential force (Cattaneo 1938, Mindlin 1949; exact where nu = 0), or pressed with friction against another
/// material (Goodman 1962, Spence 1968: only the stick ratio). For an ellipsoid the normal contact (Hertz 1882), its
/// limit moment, and the loads and motions that the scene imposes. Unknown numbers are NaN.
struct Oracle {
  ContactPlace place;
  NormalContact normal;
  FrictionLimit friction;
  double contact_radius;                 ///< m; of an ellipse the radius of the circle of equal area
  double moment;                         ///< N m
  double twist_angle;                    ///< rad
  std::array<double, 2> force{};         ///< N
  std::array<double, 2> displacement{};  ///< m
  double stick_radius;                   ///< m; the contact radius where everything sticks
  double dissipated;                     ///< J, in this step
  analytic::TorsionState state;
  double relative_uncertainty;  ///< largest relative difference from the theory's numbers

  /// Shear traction in Pa at a distance from the axis in m: along place.direction, or around the axis where
  /// that is zero. Empty: not known.
  std::function<double(double radius)> shear;

  /// Why it says nothing of friction but the limit moment; empty where it says more.
  std::string only_normal;

  /// Radius in m of a place, given in m from the axis: its distance; for an ellipse the radius of the circle
  /// with the area of the similar ellipse through the place.
  double radius(double y1, double y2) const;

  /// Semi-axes of the contact, m; both are the radius of a circle.
  double longer_semi_axis() const;
  double shorter_semi_axis() const;

  /// Pressure and shear traction at a radius in m; zero outside the contact. A cone's
  /// pressure is infinite on the axis; no traction is.
  double pressure(double radius) const;
  double traction(double radius) const;
};

/// The oracle, or why there is none. A load given as a ratio is the same ratio of the exact limit moment.
struct OracleAnswer {
  std::optional<Oracle> oracle;
  std::string reason;
  bool out_of_range = false;  ///< there is an exact solution, but not at this load: gross slip, or nearly
};

/// An exact theory: gives the answer at the end of each step of a scene, one after another.
using ExactTheory = std::function<OracleAnswer(const solver::Step&)>;

/// An exact theory, followed through the steps of a scene.
class ExactHistory {
 public:
  explicit ExactHistory(ExactTheory theory) : theory_(std::move(theory)) {}

  /// The answer at the end of the next step. None after one that left the range of the theory.
  OracleAnswer advance(const solver::Step& step);

 private:
  ExactTheory theory_;
  bool left_ = false;
};

/// The theory that holds for a scene; one that always answers with a reason where none does.
ExactHistory exact_history(const solver::Scene& scene);

/// The answer at the end of a scene's first step.
OracleAnswer find_oracle(const solver::Scene& scene);

}  // namespace slipstick::convergence
