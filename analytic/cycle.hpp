#pragma once

#include <vector>

#include "analytic/axisymmetric.hpp"
#include "analytic/torsion.hpp"

/// A contact whose twisting moment goes up and down while its normal load stays. Each reversal lets the whole
/// contact stick again and slip starts anew at the edge, against a friction that works through twice the
/// range: the branch from a reversal is the first-loading curve enlarged twice (Masing's rule), in twist and
/// in traction, and exact here (Deresiewicz 1954 for the sphere). Dimensionless as in torsion.hpp, energies
/// over (mu W)^2/(G a). Moments are signed and |M| < M_lim; a moment outside, or NaN, is a std::domain_error.
namespace slipstick::analytic {

/// A contact somewhere along its history.
struct CycleState {
  double moment_ratio;       ///< M/M_lim
  double moment;             ///< M/(mu W a)
  double twist;              ///< G a^2 phi/(mu W)
  double stick_ratio;        ///< front of the newest branch's slip, over a; what older ones left may lie within
  double tangent_stiffness;  ///< (dM/dphi)/(G a^3) on going on; that of full stick on turning back
  double dissipated;         ///< energy lost since the first loading began
};

/// A contact with its memory of moments: the reversals that no later excursion has reached again. A branch
/// that reaches the previous reversal closes a loop, deletes both reversals and continues along the outer
/// branch; beyond the largest |M| reached it is the first-loading curve. Everything but the energy lost is a
/// function of moment_ratio() and turning_points(), to the last bit.
///
/// The twist is the twist without slip, which has no memory, plus the effect of slip, an integral
/// of a positive function for each branch. So a residual twist keeps its digits however small the load: the
/// error is its own rounding and some 1e-15 of the largest branch's slip part. Tractions do cancel: error
/// some 1e-15 of the largest branch's.
class LoadingHistory {
 public:
  /// Unloaded and never loaded. The profile must outlive the history.
  explicit LoadingHistory(const Profile& profile = hertz_profile()) : profile_(&profile) {}

  /// Monotonely on to a moment.
  void load_to(double moment_ratio);

  CycleState state() const;
  /// Circumferential traction q/(mu p0), signed, at radius r/a in [0, 1]. Throws std::domain_error outside,
  /// and where it is infinite (at the edge of a flat punch).
  double traction(double radius) const;

  double moment_ratio() const { return moment_ratio_; }
  /// The reversals in memory, the oldest and farthest first, as M/M_lim.
  const std::vector<double>& turning_points() const { return turning_points_; }

  /// The state on a branch is the state at its start plus `weight` times the first loading to `amplitude`.
  struct Branch {
    double weight;
    double amplitude;
  };
  /// All branches: first loadings whose sum, with these weights, is the state.
  std::vector<Branch> branches() const;

 private:
  Branch branch(std::size_t index) const;

  bool turns_towards(double moment_ratio) const;
  bool closes_loop_at(double moment_ratio) const;
  void close_loop();

  const Profile* profile_;
  std::vector<double> turning_points_;
  double moment_ratio_ = 0;
  double lost_in_closed_loops_ = 0;
};

/// The states from no load through each of the turning points (M/M_lim), these included: `points_per_branch` (at least
/// 1, or std::domain_error) on each branch beyond its start, closer towards its ends, where the curve bends.
std::vector<CycleState> loading_curve(const std::vector<double>& turning_points, int points_per_branch,
                                      const Profile& profile = hertz_profile());

/// Energy lost in a cycle between M and -M, the area of the loop in the plane of moment and twist: four times the loss
/// of the first loading to M, since slip on either branch is twice as large. Relative error below 1e-14, plus the
/// effect of an ulp of the argument. Zero while everything sticks, as under a flat punch up to its full_stick().
double energy_lost_per_cycle(double moment_ratio, const Profile& profile = hertz_profile());
/// The same from the state of first loading, for loads that a ratio does not resolve; to a given relative
/// error. A larger error reduces the time for a tabulated profile to a tenth.
double energy_lost_per_cycle(const TorsionState& state, const Profile& profile = hertz_profile(),
                             double relative = 1e-14);

/// The limit of energy_lost_per_cycle for small moments: (9/64) (W/(p0 a^2))/(-H'(1)) (M/(mu W a))^3, for a
/// sphere (3/16) (M/(mu W a))^3; the cube of the amplitude is Deresiewicz's result (1954). Throws
/// std::domain_error where H does not end with a finite slope: under a flat punch small moments lose nothing.
double energy_lost_per_small_cycle(double moment_ratio, const Profile& profile = hertz_profile());

}  // namespace slipstick::analytic
