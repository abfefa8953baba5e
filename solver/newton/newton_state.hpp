#pragma once

#include <Eigen/Core>
#include <utility>

#include "solver/elasticity/linear_operator.hpp"
#include "solver/newton/admissible.hpp"
#include "solver/newton/convex_program.hpp"
#include "solver/newton/safeguards.hpp"

namespace slipstick::solver {

/// Energies are compared up to this part of them, their rounding.
inline constexpr double kEnergyRounding = 1e-13;

/// A field that may be the next q, with its displacement K q.
struct Trial {
  Eigen::ArrayXd q, u;
};

/// The state of Newton's method for a convex program: the displacement of its field q, the multipliers, the
/// argument of the natural map, and the energy. q itself belongs to the caller. Compiled for both sets.
template <AdmissibleSet Set>
class NewtonState {
 public:
  using ArrayXd = Eigen::ArrayXd;
  static constexpr bool kIsScalar = Set::kComponents == 1;

  /// packing: of all fields. rho: step length of the natural map. No argument is owned.
  NewtonState(const Set& set, const ConvexProgram& program, LinearOperator& op, Packing& packing, double rho);

  const Set& set() const { return set_; }
  const ConvexProgram& program() const { return program_; }
  const LoadBalance<Set>& balance() const { return balance_; }
  LinearOperator& op() const { return op_; }
  Packing& packing() const { return packing_; }
  double rho() const { return rho_; }
  /// q - rho s with the slip s, which the natural map projects.
  const ArrayXd& y() const { return y_; }
  const Coefficients& multipliers() const { return multipliers_; }
  double energy() const { return energy_; }
  /// Values of a field.
  Index size() const { return Set::kComponents * set_.cells(); }

  /// work(first, last) for the values of the contact cells.
  template <typename Work>
  void each(const Work& work) const {
    set_.sweep().each([&](Index first, Index last) {
      for (Index start = 0; start < size(); start += set_.cells()) work(start + first, start + last);
    });
  }
  /// The sum of work(first, last) over them.
  template <typename Work>
  double sum(const Work& work) const {
    return set_.sweep().template sum<double>([&](Index first, Index last, double& sum) {
      for (Index start = 0; start < size(); start += set_.cells()) sum += work(start + first, start + last);
    });
  }

  /// Starts at the projection of q onto the set, with the imposed loads if a multiplier restores them.
  /// multipliers: guesses, or empty.
  void enter(ArrayXd& q, const Coefficients& multipliers);
  /// The multipliers by the natural map, and y. False if no multiplier restores the loads.
  bool find_multipliers(const ArrayXd& q);
  void set_multipliers(const Coefficients& multipliers) { multipliers_ = multipliers; }
  /// The gap over q.Kq/2, NaN unless that is positive. slip: overwritten by the slip of q.
  double relative_gap(const ArrayXd& q, ArrayXd& slip);
  /// True if the last gap of relative_gap(), over the larger of q's and earlier states' energies, is within a
  /// tolerance or its rounding. slip: as relative_gap() left it.
  bool is_certified(double tolerance, const ArrayXd& slip) const;

  /// slip = K q + g - multipliers c in the values [first, last) of one row.
  void write_slip(Index first, Index last, ArrayXd& slip) const {
    program_.write_slip(first, last, u_, multipliers_, slip);
  }
  /// y = q - length * gradient, without the imposed conditions' part.
  void descend(const ArrayXd& q, double length, ArrayXd& y) const;

  /// Projects the trial and replaces q by it, or by the point of least energy between them. False, with q
  /// unchanged, if the energy does not fall.
  bool accept(ArrayXd& q, Trial& trial, Safeguards& safeguards);

  /// The slip of q, zero outside the contact cells; call it before take_displacement().
  ArrayXd take_slip();
  ArrayXd take_displacement() { return std::move(u_); }

 private:
  void symmetrise(ArrayXd& q) const;
  double energy_of(const ArrayXd& q, const ArrayXd& u) const;
  double least_energy_at(const ArrayXd& q, const Trial& trial) const;
  void shorten(const ArrayXd& q, Trial& trial, double part) const;

  const Set& set_;
  const ConvexProgram& program_;
  LinearOperator& op_;
  Packing& packing_;
  LoadBalance<Set> balance_;
  double rho_;
  ArrayXd u_, y_;
  Coefficients multipliers_;
  double energy_ = 0.0;   ///< of q
  double elastic_ = 0.0;  ///< its q.u/2, and
  double gap_ = 0.0;      ///< its gap, both from relative_gap()
};

extern template class NewtonState<FrictionDiscs>;
extern template class NewtonState<PositivePressures>;

}  // namespace slipstick::solver
