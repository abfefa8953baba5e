#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

#include "solver/newton/load_balance.hpp"
#include "solver/newton/tangent_space.hpp"

/// The sets of admissible tractions, over which the contact's energy is minimised, with their projection P
/// and the tangent space of the natural map q = P(q - rho s).
namespace slipstick::solver {

/// Relative rounding error of displacements: transforms round by some eps, loads are balanced to 1e-14.
inline constexpr double kGapUnits = 16.0 * std::numeric_limits<double>::epsilon();

/// True if a gap is within a tolerance, or within its rounding if that is larger; false for NaN.
inline bool is_certified(double gap, double rounding, double tolerance) {
  return gap <= tolerance || (gap <= rounding && std::isfinite(rounding));
}

/// A product of small convex sets, one for each cell: projection, duality gap and linearised natural map. For
/// LoadBalance it also has the loads of its projection along given fields, loads_along(y, w, x, c).
template <class Set>
concept AdmissibleSet = requires(const Set& set, const Eigen::ArrayXd& s, Eigen::ArrayXd& q, double rho,
                                 const std::array<double, 2>& mean, TangentSpace& space) {
  { Set::kComponents } -> std::convertible_to<Index>;  // values a cell: 1 or 2
  { set.cells() } -> std::same_as<Index>;
  { set.sweep() } -> std::same_as<const Sweep&>;                  // contact cells: sets other than {0}
  {set.project(q)};                                               // the nearest admissible q
  { set.gap(q, s) } -> std::same_as<double>;                      // bounds the energy above its least
  { set.gap_rounding(s, s, &s) } -> std::same_as<double>;         // rounding error of the gap
  { set.linearise(q, rho, mean, space) } -> std::same_as<Index>;  // cells that changed their state
  {set.add_jump(s, s, q)};                                        // onto the natural map's face of the set
};

/// p_i >= 0 in the contact cells, p_i = 0 elsewhere.
class PositivePressures {
 public:
  static constexpr Index kComponents = 1;

  explicit PositivePressures(Sweep cells) : sweep_(std::move(cells)) {}
  /// In the cells where a field is not zero.
  PositivePressures(const Grid& grid, const Eigen::ArrayXd& reachable) : PositivePressures(Sweep(grid, reachable)) {}
  explicit PositivePressures(const Eigen::ArrayXd& reachable) : PositivePressures(Sweep(reachable)) {}

  Index cells() const { return sweep_.size(); }
  const Sweep& sweep() const { return sweep_; }

  void project(Eigen::ArrayXd& p) const;

  template <int M, typename Direction>
  LoadsAlong<M> loads_along(const Eigen::ArrayXd& y, const std::array<const Direction*, M>& w,
                            const Eigen::Vector<double, M>& x, const std::array<const MotionField*, M>& c) const;

  /// Sum of p times the opening above its least value: how far the energy can fall by moving load to where
  /// the surfaces are closest. opening: K p + h, less any approach.
  double gap(const Eigen::ArrayXd& p, const Eigen::ArrayXd& opening) const;

  /// Zero: tolerances of pressures are far above the rounding of their gap.
  static double gap_rounding(const Eigen::ArrayXd&, const Eigen::ArrayXd&, const Eigen::ArrayXd*) { return 0.0; }

  /// The state of each cell by the natural map at z = p - rho s: free where z > 0.
  Index linearise(const Eigen::ArrayXd& z, double, const std::array<double, 2>&, TangentSpace& space) const;

  /// step += the jump of each cell onto the face of its set that the natural map selects.
  void add_jump(const Eigen::ArrayXd& z, const Eigen::ArrayXd& p, Eigen::ArrayXd& step) const;

 private:
  Sweep sweep_;
};

/// Tractions within Coulomb's bound: |q_i| <= mu p_i.
class FrictionDiscs {
 public:
  static constexpr Index kComponents = 2;

  /// bound: mu p of each cell; it is not owned.
  FrictionDiscs(const Grid& grid, const Eigen::ArrayXd& bound) : FrictionDiscs(Sweep(grid, bound), bound) {}
  explicit FrictionDiscs(const Eigen::ArrayXd& bound) : FrictionDiscs(Sweep(bound), bound) {}
  /// cells: where the bound is not zero.
  FrictionDiscs(Sweep cells, const Eigen::ArrayXd& bound) : bound_(bound), sweep_(std::move(cells)) {}

  Index cells() const { return bound_.size(); }
  const Sweep& sweep() const { return sweep_; }

  void project(Eigen::ArrayXd& q) const;

  template <int M, typename Direction>
  LoadsAlong<M> loads_along(const Eigen::ArrayXd& y, const std::array<const Direction*, M>& w,
                            const Eigen::Vector<double, M>& x, const std::array<const MotionField*, M>& c) const;

  /// Sum of s.q + mu p |s|; see Certificate.
  double gap(const Eigen::ArrayXd& q, const Eigen::ArrayXd& slip) const;

  /// Sum over cells of max over |q + d| <= mu p of -s.d - k |d|^2/2: see Certificate. k = 0 gives the gap.
  double energy_error(const Eigen::ArrayXd& q, const Eigen::ArrayXd& slip, double k) const;

  /// Rounding error of the gap: each slip is a difference of displacements, which are known to kGapUnits.
  /// displacement: K q; reference: the other displacement in the slip, ConvexProgram::g, or null.
  double gap_rounding(const Eigen::ArrayXd& slip, const Eigen::ArrayXd& displacement,
                      const Eigen::ArrayXd* reference = nullptr) const;

  /// Stick where |z| <= mu p. Elsewhere q moves along its circle, against the stiffness (|z| - mu p)/(rho mu
  /// p), which equals |s|/(mu p) once slip opposes traction.
  Index linearise(const Eigen::ArrayXd& z, double rho, const std::array<double, 2>& mean, TangentSpace& space) const;

  void add_jump(const Eigen::ArrayXd& z, const Eigen::ArrayXd& q, Eigen::ArrayXd& step) const;

 private:
  const Eigen::ArrayXd& bound_;
  Sweep sweep_;
};

}  // namespace slipstick::solver
