#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

#include "solver/tangent_space.hpp"

/// What tractions a cell may carry: the sets over which the contact's energy is minimised. Each knows its
/// projection, and the tangent space of the natural map q = P(q - rho s).
namespace slipstick::solver {

/// c.P(y + x direction) and its derivative by x.
struct LoadAlong {
  double load = 0.0;
  double slope = 0.0;
};

/// Pressures that do not pull: p_i >= 0 where the bodies can touch, p_i = 0 elsewhere.
class PositivePressures {
 public:
  static constexpr Index kComponents = 1;

  /// reachable: 1 where the bodies can touch, 0 elsewhere.
  explicit PositivePressures(const Eigen::ArrayXd& reachable) : reachable_(reachable) {}

  Index cells() const { return reachable_.size(); }

  void project(Eigen::ArrayXd& p) const { p = reachable_ * p.max(0.0); }

  template <typename Direction>
  LoadAlong load_along(const Eigen::ArrayXd& y, const Direction& direction, double x,
                       const Eigen::ArrayXd& c) const {
    LoadAlong sum;
    for (Index i = 0; i < y.size(); ++i) {
      const auto along = static_cast<double>(direction[i]);
      const double p = y[i] + x * along;
      if (!(p > 0.0) || reachable_[i] == 0.0) continue;
      sum.load += c[i] * p;
      sum.slope += c[i] * along;
    }
    return sum;
  }

  /// Sum of p times the opening above its least value: how far the energy can fall by moving load to where
  /// the surfaces are closest. opening: K p + h, without the approach.
  double gap(const Eigen::ArrayXd& p, const Eigen::ArrayXd& opening, const Eigen::ArrayXd&, double) const {
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

  template <typename Direction>
  LoadAlong load_along(const Eigen::ArrayXd& y, const Direction& direction, double x,
                       const Eigen::ArrayXd& c) const {
    const Index n = cells();
    LoadAlong sum;
    for (Index i = 0; i < n; ++i) {
      if (bound_[i] == 0.0) continue;
      const auto w1 = static_cast<double>(direction[i]);
      const auto w2 = static_cast<double>(direction[i + n]);
      const double z1 = y[i] + x * w1;
      const double z2 = y[i + n] + x * w2;
      const double c_z = c[i] * z1 + c[i + n] * z2;
      const double c_w = c[i] * w1 + c[i + n] * w2;
      const double square = z1 * z1 + z2 * z2;
      if (square <= bound_[i] * bound_[i]) {
        sum.load += c_z;
        sum.slope += c_w;
      } else {
        const double factor = bound_[i] / std::sqrt(square);
        sum.load += factor * c_z;
        sum.slope += factor * (c_w - c_z * (z1 * w1 + z2 * w2) / square);
      }
    }
    return sum;
  }

  /// Sum of s.q + mu p |s| with s = displacement - twist * rotation; see Certificate.
  double gap(const Eigen::ArrayXd& q, const Eigen::ArrayXd& displacement, const Eigen::ArrayXd& rotation,
             double twist) const {
    const Index n = cells();
    double sum = 0.0;
    for (Index i = 0; i < n; ++i) {
      if (bound_[i] == 0.0) continue;
      const double s1 = displacement[i] - twist * rotation[i];
      const double s2 = displacement[i + n] - twist * rotation[i + n];
      sum += s1 * q[i] + s2 * q[i + n] + bound_[i] * std::sqrt(s1 * s1 + s2 * s2);
    }
    return sum;
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
