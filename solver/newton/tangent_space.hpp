#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>

#include "solver/grid/sweep.hpp"
#include "solver/newton/extension.hpp"
#include "solver/operator/inverse_symbol.hpp"
#include "solver/operator/linear_operator.hpp"

namespace slipstick::solver {

/// Where each cell's traction may move once its state is fixed, with what that adds to the operator there:
/// freely in a stick cell, along its circle in a slip cell, not at all outside. On fields of that kind the
/// linearised problem is K + stiffness, and
///
///   scale * projector * (inverse symbol) * projector * scale + shift * projector
///
/// is close to its inverse. The two terms reproduce 1/(1/xi + stiffness), the symbol of the inverse where the
/// stiffness varies slowly, at the wave numbers xi = P and P/12, P the mean of the inverse symbol along the
/// free direction; one term alone is wrong by the ratio of the largest to the smallest wave number where the
/// stiffness is large.
///
/// Real is the precision of the inner iteration.
template <typename Real>
struct TangentSpace {
  using Field = Eigen::Array<Real, Eigen::Dynamic, 1>;

  /// Of vectors (2 components) or scalars (1), on the grid of some cells that may carry traction. Nothing is
  /// free: a linearisation counts the cells that change.
  TangentSpace(Index components, const Sweep& cells)
      : a11(cells.size()),
        a12(components == 2 ? cells.size() : 0),
        a22(a12.size()),
        stiffness(a12.size()),
        scale(a12.size()),
        shift(a12.size()),
        free(cells) {
    for (Field* const field : {&a11, &a12, &a22, &stiffness, &scale, &shift}) clear(cells, *field);
  }

  /// On so many cells, none of which may carry any.
  TangentSpace(Index components, Index cells) : TangentSpace(components, Sweep(Field::Zero(cells))) {}

  Index components() const { return a12.size() > 0 ? 2 : 1; }

  /// A cell that does not move, or moves freely.
  void set(Index cell, bool free) {
    a11[cell] = Real(free);
    if (components() == 1) return;
    a22[cell] = Real(free);
    a12[cell] = stiffness[cell] = shift[cell] = Real(0);
    scale[cell] = Real(1);
  }

  /// A cell that moves along the unit vector (f1, f2) against a stiffness; mean: that of the inverse symbol
  /// along it.
  void set_line(Index cell, double f1, double f2, double along, double mean) {
    constexpr double kLowOverMean = 1.0 / 12.0;
    const double low = kLowOverMean * mean;
    const double alpha = 1.0 / ((1.0 + along * low) * (1.0 + along * mean));
    a11[cell] = static_cast<Real>(f1 * f1);
    a12[cell] = static_cast<Real>(f1 * f2);
    a22[cell] = static_cast<Real>(f2 * f2);
    stiffness[cell] = static_cast<Real>(along);
    scale[cell] = static_cast<Real>(std::sqrt(alpha));
    shift[cell] = static_cast<Real>(alpha * along * low * mean);
  }

  /// Finds the cells where something is free, after these were set.
  void find_free() {
    const bool vectors = components() == 2;
    free.assign(a11.size(), [&](Index i) { return a11[i] != Real(0) || (vectors && a22[i] != Real(0)); });
  }

  /// z = projector * scale * r, in some cells
  void restrict_to(Index first, Index last, const Field& r, Field& z) const {
    const Index n = a11.size();
    if (components() == 1) {
      for (Index i = first; i < last; ++i) z[i] = r[i];
      return;
    }
    for (Index i = first; i < last; ++i) {
      const Real r1 = scale[i] * r[i];
      const Real r2 = scale[i] * r[i + n];
      z[i] = a11[i] * r1 + a12[i] * r2;
      z[i + n] = a12[i] * r1 + a22[i] * r2;
    }
  }

  /// y = projector * (scale * z + shift * projector * r), in some cells. Projected once only, what rounding
  /// leaves of the part of r across the lines would enter r.y to first order, and no residual could fall
  /// below the root of its rounding.
  void complete(Index first, Index last, const Field& z, const Field& r, Field& y) const {
    const Index n = a11.size();
    if (components() == 1) {
      for (Index i = first; i < last; ++i) y[i] = z[i];
      return;
    }
    for (Index i = first; i < last; ++i) {
      const Real r1 = a11[i] * r[i] + a12[i] * r[i + n];
      const Real r2 = a12[i] * r[i] + a22[i] * r[i + n];
      const Real y1 = scale[i] * z[i] + shift[i] * r1;
      const Real y2 = scale[i] * z[i + n] + shift[i] * r2;
      y[i] = a11[i] * y1 + a12[i] * y2;
      y[i + n] = a12[i] * y1 + a22[i] * y2;
    }
  }

  static double bytes(Index components, double cells) {
    return (components == 2 ? 6.0 : 1.0) * sizeof(Real) * cells;
  }

  Field a11, a12, a22;  ///< the projector, symmetric
  Field stiffness;      ///< lambda = |s|/(mu p) in slip cells
  Field scale, shift;   ///< of the preconditioner
  Sweep free;           ///< over the cells where the projector is not zero
};

/// The linearised problem's matrix, K + stiffness, on the tangent space.
template <typename Real>
struct TangentOperator {
  using Field = typename TangentSpace<Real>::Field;

  Operator<Real>& op;
  const TangentSpace<Real>& space;

  const Sweep& cells() const { return space.free; }

  /// Kd in the cells that are free; d is zero in others. Returns d.Kd.
  double apply(const Field& d, Field& Kd) {
    op.apply_own(d, Kd);
    const Index n = space.a11.size();
    const auto& stiffness = space.stiffness;
    return space.free.template sum<double>([&](Index first, Index last, double& sum) {
      if (space.components() == 1) {
        for (Index i = first; i < last; ++i) sum += static_cast<double>(d[i]) * static_cast<double>(Kd[i]);
        return;
      }
      for (Index i = first; i < last; ++i) {
        Kd[i] += stiffness[i] * d[i];
        Kd[i + n] += stiffness[i] * d[i + n];
        sum += static_cast<double>(d[i]) * static_cast<double>(Kd[i]) +
               static_cast<double>(d[i + n]) * static_cast<double>(Kd[i + n]);
      }
    });
  }
};

/// Its preconditioner; what it returns lies in the tangent space.
template <typename Real>
struct TangentPreconditioner {
  using Field = typename TangentSpace<Real>::Field;

  InverseSymbol<Real>& symbol;
  const TangentSpace<Real>& space;
  Extension<Real>* extension = nullptr;

  const Sweep& cells() const { return space.free; }

  /// The three parts of y = M r, of which the first and the last go cell by cell.
  void load(Index first, Index last, const Field& r, Field& z) const { space.restrict_to(first, last, r, z); }
  void transform(Field& z) {
    if (extension != nullptr) extension->extend(z);
    symbol.apply(std::span(z.data(), static_cast<std::size_t>(z.size())));
    if (extension != nullptr) extension->gather(z);
  }
  void store(Index first, Index last, const Field& r, const Field& z, Field& y) const {
    space.complete(first, last, z, r, y);
  }
};

}  // namespace slipstick::solver
