#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "solver/elasticity/inverse_symbol.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/grid/packet.hpp"
#include "solver/grid/packing.hpp"
#include "solver/grid/sweep.hpp"
#include "solver/newton/extension.hpp"

namespace slipstick::solver {

/// The directions in which each cell's traction may change once its state is fixed: any in a stick cell,
/// along its circle in a slip cell, none outside. On such fields the linearised problem is K + stiffness, and
///
///   projector * scale * (inverse symbol) * scale * projector + shift * projector
///
/// approximates its inverse. The two terms reproduce 1/(1/xi + stiffness), the symbol of the inverse where
/// the stiffness varies slowly, at the wave numbers xi = P and P/12, in many spots P/48, with P the mean of
/// the inverse symbol along the free direction. With only one term the error would be the ratio of the largest to the
/// smallest wave number where the stiffness is large.
///
/// Stiffness and preconditioner may be inexact, the directions not: a component of the slip that no traction
/// can change would otherwise bound the residual from below.
struct TangentSpace {
  using Field = Eigen::ArrayXd;

  /// For vectors (2 components) or scalars (1) on the contact cells. At first no scalar is free and no vector
  /// on a line: linearise() counts the cells that change.
  TangentSpace(Index components, const Sweep& cells)
      : f1(cells.size()),
        f2(components == 2 ? cells.size() : 0),
        stiffness(f2.size()),
        scale(f2.size()),
        shift(f2.size()),
        free(cells),
        low_over_mean_(cells.is_ragged() ? 1.0 / 48.0 : 1.0 / 12.0) {
    for (Field* const field : {&f1, &f2}) clear(cells, *field);
    for (Eigen::ArrayXf* const field : {&stiffness, &scale, &shift}) clear(cells, *field);
  }

  /// Without contact cells among `cells`.
  TangentSpace(Index components, Index cells) : TangentSpace(components, Sweep(cells)) {}

  Index components() const { return f2.size() > 0 ? 2 : 1; }

  /// A cell that does not move, or moves freely.
  void set(Index cell, bool free) {
    f1[cell] = components() == 1 && free ? 1.0 : 0.0;
    if (components() == 1) return;
    f2[cell] = 0.0;
    stiffness[cell] = free ? 0.0F : kLeastStiffness;
    scale[cell] = 1.0F;
    shift[cell] = 0.0F;
  }

  /// A cell that moves along the unit vector (f1, f2) against the stiffness `along`; mean: of the inverse
  /// symbol along (f1, f2).
  void set_line(Index cell, double along1, double along2, double along, double mean) {
    const double low = low_over_mean_ * mean;
    const double alpha = 1.0 / ((1.0 + along * low) * (1.0 + along * mean));
    f1[cell] = along1;
    f2[cell] = along2;
    stiffness[cell] = std::max(static_cast<float>(along), kLeastStiffness);
    scale[cell] = static_cast<float>(std::sqrt(alpha));
    shift[cell] = static_cast<float>(alpha * along * low * mean);
  }

  /// True if a vector moves along a line, or not at all.
  bool on_line(Index cell) const { return stiffness[cell] > 0.0F; }

  /// Sets `free`, after all cells have been set.
  void find_free() {
    const bool vectors = components() == 2;
    free.assign([&](Index i) { return f1[i] != 0.0 || (vectors && (f2[i] != 0.0 || !on_line(i))); });
  }

  /// Projects v onto the space, in some cells.
  void project(Index first, Index last, Field& v) const {
    const Index n = f1.size();
    if (components() == 1) {
      v.segment(first, last - first) *= f1.segment(first, last - first);
      return;
    }
    Packet::each(first, last, [&]<typename Value>(Index i, Value) {
      if (any_on_line<Value>(i)) put(v, i, projected(i, get<Value>(v, i), get<Value>(v, i + n)));
    });
  }
  /// The projection of (v1, v2), in one cell or in two.
  template <typename Value>
  std::array<Value, 2> projected(Index i, Value v1, Value v2) const {
    if (!any_on_line<Value>(i)) return {v1, v2};
    const auto along1 = get<Value>(f1, i);
    const auto along2 = get<Value>(f2, i);
    const Value along = along1 * v1 + along2 * v2;
    const auto on_line = get<Value>(stiffness, i) > 0.0;
    return {on_line ? along * along1 : v1, on_line ? along * along2 : v2};
  }
  /// True if one of these cells moves along a line. Most neighbours stick together.
  template <typename Value>
  bool any_on_line(Index i) const {
    return on_line(i) || (sizeof(Value) > sizeof(double) && on_line(i + 1));
  }
  /// Values of a field from i on, as many as the type has.
  template <typename Value, typename Values>
  static Value get(const Values& field, Index i) {
    return Packet::get<Value>(field.data() + i);
  }
  /// A vector's components in v, from cell i on.
  template <typename Value>
  void put(Field& v, Index i, const std::array<Value, 2>& components) const {
    Packet::put(v.data() + i, components[0]);
    Packet::put(v.data() + i + f1.size(), components[1]);
  }

  /// z = scale * r in some cells, for an r in the space
  void load(Index first, Index last, const Field& r, Field& z) const {
    const Index n = last - first;
    if (components() == 1) {
      z.segment(first, n) = r.segment(first, n);
      return;
    }
    Packet::each(first, last, [&]<typename Value>(Index i, Value) {
      const auto scaling = get<Value>(scale, i);
      put<Value>(z, i, {scaling * get<Value>(r, i), scaling * get<Value>(r, i + f1.size())});
    });
  }

  /// y = projector * scale * z + shift * r in some cells, for an r in the space; y may be z.
  void complete(Index first, Index last, const Field& z, const Field& r, Field& y) const {
    const Index n = f1.size();
    if (components() == 1) {
      for (Index i = first; i < last; ++i) y[i] = z[i];
      return;
    }
    Packet::each(first, last, [&]<typename Value>(Index i, Value) {
      const auto scaling = get<Value>(scale, i);
      const auto shifting = get<Value>(shift, i);
      const auto [y1, y2] = projected<Value>(i, scaling * get<Value>(z, i), scaling * get<Value>(z, i + n));
      put<Value>(y, i, {y1 + shifting * get<Value>(r, i), y2 + shifting * get<Value>(r, i + n)});
    });
  }

  Field f1, f2;                 ///< unit vector of a cell on a line, else zero; scalars have only f1: 1 where free
  Eigen::ArrayXf stiffness;     ///< lambda = |s|/(mu p) in slip cells, above zero; zero in stick cells
  Eigen::ArrayXf scale, shift;  ///< of the preconditioner
  Sweep free;                   ///< the cells that may move

 private:
  static constexpr float kLeastStiffness = std::numeric_limits<float>::min();
  double low_over_mean_;
};

/// The linearised problem's matrix, K + stiffness, on the tangent space.
struct TangentOperator {
  using Field = TangentSpace::Field;

  LinearOperator& op;
  const TangentSpace& space;
  Packing& packing;

  const Sweep& cells() const { return space.free; }

  /// The two parts of y = projector (K + stiffness) x in the cells that are free; x is zero in others.
  void transform(const Field& x, Field& y) { op.apply_own(x, y, packing); }
  void store(Index first, Index last, const Field& x, Field& y) const {
    if (space.components() == 1) return;
    const Index n = space.f1.size();
    Packet::each(first, last, [&]<typename Value>(Index i, Value) {
      const auto get = [](const auto& field, Index at) { return TangentSpace::get<Value>(field, at); };
      const Value stiffness = get(space.stiffness, i);
      space.put(
          y, i,
          space.projected<Value>(i, get(y, i) + stiffness * get(x, i), get(y, i + n) + stiffness * get(x, i + n)));
    });
  }
};

/// Its preconditioner; what it returns lies in the tangent space.
struct TangentPreconditioner {
  using Field = TangentSpace::Field;

  InverseSymbol& symbol;
  const TangentSpace& space;
  Packing& packing;
  Extension* extension = nullptr;

  const Sweep& cells() const { return space.free; }

  /// The three parts of y = M r; the first and the last work cell by cell.
  void load(Index first, Index last, const Field& r, Field& z) const { space.load(first, last, r, z); }
  void transform(Field& z) {
    packing.on_grid(z, z, [&](const Field&, Field& field) {
      if (extension != nullptr) extension->extend(field);
      symbol.apply(std::span(field.data(), static_cast<std::size_t>(field.size())));
      if (extension != nullptr) extension->collect(field);
    });
  }
  void store(Index first, Index last, const Field& r, const Field& z, Field& y) const {
    space.complete(first, last, z, r, y);
  }
  void project(Index first, Index last, Field& y) const { space.project(first, last, y); }
};

}  // namespace slipstick::solver
