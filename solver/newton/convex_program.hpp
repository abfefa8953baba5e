#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/newton/load_balance.hpp"

namespace slipstick::solver {

/// minimise q.Kq/2 + g.q - sum of multiplier_k c_k.q over the admissible q. Each imposed condition has a
/// load, c_k.q = load_k, which determines its multiplier; each given one has its multiplier. g, of as many
/// values as q, and motions are not owned. Values [first, last) are of one row.
struct ConvexProgram {
  const Eigen::ArrayXd* g = nullptr;  ///< null: zero
  std::vector<Condition> imposed;     ///< with `given` at most kMaxConditions
  struct Given {
    const MotionField* c;
    double multiplier;
  };
  std::vector<Given> given = {};
  /// An energy of earlier states, whose errors this one inherits: if rounding keeps the gap over q.Kq/2 from
  /// the tolerance, the gap over this energy suffices.
  double energy_before = 0.0;
  /// True if the answer turns into itself under half a turn: iterates are projected onto that symmetry, which
  /// cannot raise the convex energy.
  bool turns_into_itself = false;

  /// The part of the values [first, last) in the energy of q with the displacement u = K q; the imposed
  /// conditions' part, which is constant, left out.
  double energy(Index first, Index last, const Eigen::ArrayXd& q, const Eigen::ArrayXd& u) const {
    const Index n = last - first;
    double sum = 0.5 * (q.segment(first, n) * u.segment(first, n)).sum();
    if (g != nullptr) sum += (q.segment(first, n) * g->segment(first, n)).sum();
    for (const auto& [c, multiplier] : given) {
      sum -= multiplier * c->dot(first, q.segment(first, n));
    }
    return sum;
  }

  /// y = q - length * gradient at u = K q in the values [first, last), without the imposed conditions' part.
  void descend(Index first, Index last, const Eigen::ArrayXd& q, const Eigen::ArrayXd& u, double length,
               Eigen::ArrayXd& y) const {
    const Index n = last - first;
    auto part = y.segment(first, n);
    part = q.segment(first, n) - length * u.segment(first, n);
    if (g != nullptr) part -= length * g->segment(first, n);
    for (const auto& [c, multiplier] : given) c->add_to(part, first, length * multiplier);
  }

  /// The gradient at u = K q, the slip of a contact, in the values [first, last): s = u + g - sum of
  /// multiplier_k c_k. multipliers: of the imposed conditions.
  void write_slip(Index first, Index last, const Eigen::ArrayXd& u, const Coefficients& multipliers,
                  Eigen::ArrayXd& s) const {
    const Index n = last - first;
    auto part = s.segment(first, n);
    part = u.segment(first, n);
    if (g != nullptr) part += g->segment(first, n);
    for (const auto& [c, multiplier] : given) c->add_to(part, first, -multiplier);
    for (std::size_t k = 0; k < imposed.size(); ++k) {
      imposed[k].c->add_to(part, first, -multipliers[static_cast<Index>(k)]);
    }
  }
};

}  // namespace slipstick::solver
