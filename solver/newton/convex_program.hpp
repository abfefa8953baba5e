#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "solver/newton/load_balance.hpp"

namespace slipstick::solver {

/// minimise q.Kq/2 + g.q - sum of multiplier_k c_k.q over the admissible q: with c_k.q = load_k for each
/// condition that is imposed, which finds its multiplier, and with a given multiplier for the others. g, of
/// as many values as q, and motions are not owned. Values [first, last) are of one row.
struct ConvexProgram {
  const Eigen::ArrayXd* g = nullptr;  ///< null: zero
  std::vector<Condition> imposed;     ///< at most kMaxConditions, with those that follow
  struct Given {
    const MotionField* c;
    double multiplier;
  };
  std::vector<Given> given = {};
  /// An energy of the states before, whose errors this one inherits: where rounding keeps the gap from the
  /// tolerance over q.Kq/2, over this one will do.
  double energy_before = 0.0;
  /// Gives a field the symmetry that the answer has, which raises no energy, for that is convex; empty: none.
  std::function<void(Eigen::ArrayXd& q)> symmetrise = {};

  /// The part of the values [first, last) in the energy of q with the displacement u = K q; the imposed
  /// conditions' part, which is constant, left out.
  double energy(Index first, Index last, const Eigen::ArrayXd& q, const Eigen::ArrayXd& u) const;

  /// y = q - length * gradient at u = K q in the values [first, last), without the imposed conditions' part.
  void descend(Index first, Index last, const Eigen::ArrayXd& q, const Eigen::ArrayXd& u, double length,
               Eigen::ArrayXd& y) const;

  /// The gradient at u = K q, the slip of a contact, in the values [first, last): s = u + g - sum of
  /// multiplier_k c_k. multipliers: of the imposed conditions.
  void write_slip(Index first, Index last, const Eigen::ArrayXd& u, const Coefficients& multipliers,
                  Eigen::ArrayXd& s) const;
};

}  // namespace slipstick::solver
