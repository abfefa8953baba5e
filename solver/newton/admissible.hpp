#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solver/newton/load_balance.hpp"
#include "solver/newton/tangent_space.hpp"

/// What tractions a cell may carry: the sets over which the contact's energy is minimised. Each knows its
/// projection, and the tangent space of the natural map q = P(q - rho s).
namespace slipstick::solver {

/// Whether a gap is within a tolerance, or within its rounding where that is larger. NaN is not.
inline bool is_certified(double gap, double rounding, double tolerance) {
  return gap <= tolerance || (gap <= rounding && std::isfinite(rounding));
}

/// Pressures that do not pull: p_i >= 0 where the bodies can touch, p_i = 0 elsewhere.
class PositivePressures {
 public:
  static constexpr Index kComponents = 1;

  /// reachable: 1 where the bodies can touch, 0 elsewhere.
  explicit PositivePressures(const Eigen::ArrayXd& reachable) : reachable_(reachable) {}

  Index cells() const { return reachable_.size(); }

  void project(Eigen::ArrayXd& p) const { p = reachable_ * p.max(0.0); }

  template <int M, typename Direction>
  LoadsAlong<M> loads_along(const Eigen::ArrayXd& y, const std::array<const Direction*, M>& w,
                            const Eigen::Vector<double, M>& x,
                            const std::array<const Eigen::ArrayXd*, M>& c) const {
    static_assert(M == 1, "the approach is a pressure's only condition");
    LoadsAlong<M> sum;
    for (Index i = 0; i < y.size(); ++i) {
      const auto along = static_cast<double>((*w[0])[i]);
      const double p = y[i] + x[0] * along;
      if (!(p > 0.0) || reachable_[i] == 0.0) continue;
      sum.load[0] += (*c[0])[i] * p;
      sum.slope(0, 0) += (*c[0])[i] * along;
    }
    return sum;
  }

  /// Sum of p times the opening above its least value: how far the energy can fall by moving load to where
  /// the surfaces are closest. opening: K p + h, less any approach.
  double gap(const Eigen::ArrayXd& p, const Eigen::ArrayXd& opening) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (Index i = 0; i < p.size(); ++i) {
      if (reachable_[i] != 0.0 && !(opening[i] >= lowest)) lowest = opening[i];
    }
    double sum = 0.0;
    for (Index i = 0; i < p.size(); ++i) sum += p[i] * (opening[i] - lowest);
    return sum;
  }

  /// State of each cell by the natural map at z = p - rho s.
  template <typename Real>
  Index linearise(const Eigen::ArrayXd& z, double, const std::array<double, 2>&,
                  TangentSpace<Real>& space) const {
    Index changed = 0;
    for (Index i = 0; i < z.size(); ++i) {
      const bool contact = z[i] > 0.0 && reachable_[i] != 0.0;
      changed += (space.a11[i] != Real(0)) != contact;
      space.set(i, contact);
    }
    return changed;
  }

  /// step += what brings each cell onto the face of its set on which the natural map puts it.
  void add_jump(const Eigen::ArrayXd& z, const Eigen::ArrayXd& p, Eigen::ArrayXd& step) const {
    for (Index i = 0; i < z.size(); ++i) {
      if (!(z[i] > 0.0)) step[i] -= p[i];
    }
  }

 private:
  const Eigen::ArrayXd& reachable_;
};

/// Tractions within Coulomb's bound: |q_i| <= mu p_i.
class FrictionDiscs {
 public:
  static constexpr Index kComponents = 2;

  explicit FrictionDiscs(const Eigen::ArrayXd& bound) : bound_(bound) {}

  Index cells() const { return bound_.size(); }

  void project(Eigen::ArrayXd& q) const {
    const Index n = cells();
    for (Index i = 0; i < n; ++i) {
      const double size = std::sqrt(q[i] * q[i] + q[i + n] * q[i + n]);
      if (!(size > bound_[i])) continue;
      const double factor = bound_[i] / size;
      q[i] *= factor;
      q[i + n] *= factor;
    }
  }

  template <int M, typename Direction>
  LoadsAlong<M> loads_along(const Eigen::ArrayXd& y, const std::array<const Direction*, M>& w,
                            const Eigen::Vector<double, M>& x,
                            const std::array<const Eigen::ArrayXd*, M>& c) const {
    const Index n = cells();
    LoadsAlong<M> sum;
    std::array<std::array<double, 2>, M> along{};
    std::array<std::array<double, 2>, M> weight{};
    for (Index i = 0; i < n; ++i) {
      const double bound = bound_[i];
      if (bound == 0.0) continue;
      double z1 = y[i];
      double z2 = y[i + n];
      for (std::size_t k = 0; k < M; ++k) {
        along[k] = {static_cast<double>((*w[k])[i]), static_cast<double>((*w[k])[i + n])};
        weight[k] = {(*c[k])[i], (*c[k])[i + n]};
        z1 += x[static_cast<int>(k)] * along[k][0];
        z2 += x[static_cast<int>(k)] * along[k][1];
      }
      // P(z) = factor z, and its derivative takes out what is along z where that is cut to the bound.
      const double square = z1 * z1 + z2 * z2;
      const bool cut = square > bound * bound;
      const double size = cut ? std::sqrt(square) : bound;
      const double factor = cut ? bound / size : 1.0;
      for (std::size_t k = 0; k < M; ++k) {
        const auto row = static_cast<int>(k);
        const double c_z = weight[k][0] * z1 + weight[k][1] * z2;
        sum.load[row] += factor * c_z;
        for (std::size_t l = 0; l < M; ++l) {
          double slope = weight[k][0] * along[l][0] + weight[k][1] * along[l][1];
          if (cut) slope -= c_z * (along[l][0] * z1 + along[l][1] * z2) / square;
          sum.slope(row, static_cast<int>(l)) += factor * slope;
        }
      }
      sum.potential += cut ? bound * (size - 0.5 * bound) : 0.5 * square;
      sum.carried += std::min(square, bound * bound);
      sum.square += std::max(square, bound * bound);
    }
    return sum;
  }

  /// Sum of s.q + mu p |s|; see Certificate.
  double gap(const Eigen::ArrayXd& q, const Eigen::ArrayXd& slip) const {
    const Index n = cells();
    double sum = 0.0;
    for (Index i = 0; i < n; ++i) {
      if (bound_[i] == 0.0) continue;
      sum += slip[i] * q[i] + slip[i + n] * q[i + n] +
             bound_[i] * std::sqrt(slip[i] * slip[i] + slip[i + n] * slip[i + n]);
    }
    return sum;
  }

  /// Sum of the most that -s.d - k|d|^2/2 can be for |q + d| <= mu p, k > 0: see Certificate. With k = 0 it
  /// is the gap.
  double energy_error(const Eigen::ArrayXd& q, const Eigen::ArrayXd& slip, double k) const {
    if (k == 0.0) return gap(q, slip);
    const Index n = cells();
    double sum = 0.0;
    for (Index i = 0; i < n; ++i) {
      if (bound_[i] == 0.0) continue;
      double d1 = -slip[i] / k;
      double d2 = -slip[i + n] / k;
      const double size = std::sqrt((q[i] + d1) * (q[i] + d1) + (q[i + n] + d2) * (q[i + n] + d2));
      if (size > bound_[i]) {
        d1 = (q[i] + d1) * bound_[i] / size - q[i];
        d2 = (q[i + n] + d2) * bound_[i] / size - q[i + n];
      }
      sum -= slip[i] * d1 + slip[i + n] * d2 + 0.5 * k * (d1 * d1 + d2 * d2);
    }
    return sum;
  }

  /// What rounding of slips and tractions does to the gap: each slip is a difference of displacements, each
  /// product one of numbers that are right to some units of rounding. displacement: K q.
  double gap_rounding(const Eigen::ArrayXd& slip, const Eigen::ArrayXd& displacement) const {
    constexpr double kUnits = 16.0;  // of transforms, and of loads, which are balanced to 1e-14
    const Index n = cells();
    const auto size = [n](const Eigen::ArrayXd& v) {
      return (v.head(n).square() + v.tail(n).square()).sqrt();
    };
    return kUnits * std::numeric_limits<double>::epsilon() *
           (bound_ * (size(slip) + 2.0 * size(displacement))).sum();
  }

  /// Stick where |z| <= mu p. Elsewhere q turns along its circle, against the stiffness (|z| - mu p)/(rho mu
  /// p), which is |s|/(mu p) where slip is opposed to traction already.
  template <typename Real>
  Index linearise(const Eigen::ArrayXd& z, double rho, const std::array<double, 2>& mean,
                  TangentSpace<Real>& space) const {
    const Index n = cells();
    Index changed = 0;
    for (Index i = 0; i < n; ++i) {
      const double size = std::sqrt(z[i] * z[i] + z[i + n] * z[i + n]);
      const bool slip = size > bound_[i];
      if (bound_[i] == 0.0) {
        space.set(i, false);
        continue;
      }
      changed += slip != (space.stiffness[i] > Real(0));
      if (!slip) {
        space.set(i, true);
        continue;
      }
      const double f1 = -z[i + n] / size;
      const double f2 = z[i] / size;
      space.set_line(i, f1, f2, (size - bound_[i]) / (rho * bound_[i]),
                     f1 * f1 * mean[0] + f2 * f2 * mean[1]);
    }
    return changed;
  }

  void add_jump(const Eigen::ArrayXd& z, const Eigen::ArrayXd& q, Eigen::ArrayXd& step) const {
    const Index n = cells();
    for (Index i = 0; i < n; ++i) {
      const double size = std::sqrt(z[i] * z[i] + z[i + n] * z[i + n]);
      if (!(size > bound_[i])) continue;
      const double e1 = z[i] / size;
      const double e2 = z[i + n] / size;
      const double jump = bound_[i] - (q[i] * e1 + q[i + n] * e2);
      step[i] += jump * e1;
      step[i + n] += jump * e2;
    }
  }

 private:
  const Eigen::ArrayXd& bound_;
};

}  // namespace slipstick::solver
