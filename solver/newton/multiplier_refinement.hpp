#pragma once

#include <optional>
#include <span>

#include "solver/newton/conjugate_gradients.hpp"

namespace slipstick::solver {

/// Some steps towards A w = c for each condition; returns c_k.w_l, d(load)/d(multiplier) of the linear
/// problem. Its error is of second order in that of w.
template <typename Real, LinearMap<Real> Map, SplitMap<Real> Preconditioner>
CoefficientMatrix tangent_stiffness(Map& map, Preconditioner& preconditioner, CgFields<Real> conditions,
                                    int iterations, CgWorkspace<Real>& work, CgField<Real>& r,
                                    std::span<CgField<Real>> w) {
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    r = *conditions[k];
    w[k].setZero();
    projected_cg<Real>(map, preconditioner, {}, r, {.reduction = 0.0, .max_iterations = iterations}, work,
                       w[k]);
  }
  const CoefficientMatrix products =
      CgConstraints<Real>::products_with(map.cells(), conditions, w.first(conditions.size()));
  return 0.5 * (products + products.transpose());
}

/// What to add to the multipliers of the first conditions so that they are right to second order: those of a
/// Newton step along the tangent fields w, from w.r and w.c; r: the linear problem's residual at the
/// multipliers so far. Empty where the conditions depend on each other.
template <typename Real>
std::optional<Coefficients> multiplier_correction(const CoefficientMatrix& stiffness,
                                                  std::span<const CgField<Real>> w, const CgField<Real>& r,
                                                  const Sweep& cells, Index count) {
  const SmallCholesky factor(CoefficientMatrix(stiffness.topLeftCorner(count, count)));
  if (!factor.is_definite()) return std::nullopt;
  Coefficients products(count);
  for (Index k = 0; k < count; ++k) {
    products[k] = cells.sum<double>([&](Index first, Index last, double& sum) {
      sum += dot(cells.size(), first, last, r, w[static_cast<std::size_t>(k)]);
    });
  }
  return Coefficients(-factor.solve(products));
}

}  // namespace slipstick::solver
