#pragma once

#include <string>
#include <vector>

#include "convergence/orders/order.hpp"

namespace slipstick::convergence {

/// Where a sequence of values leads, without an exact one.
struct Limit {
  double value;        ///< NaN only where there is no finite sample
  double uncertainty;  ///< how far the true limit may be from it; NaN where nothing says
  Order order;         ///< of value - limit; its constant is NaN if the limit is not the limit of its power
  std::string method;  ///< how it was found
};

/// Least-squares grid convergence index of L. Eca and M. Hoekstra, J. Comput. Phys. 262 (2014) 104-130, for
/// four meshes or more; with fewer, richardson_limit().
///
/// Fits value = limit + C size^p twice, all meshes alike and weighted by 1/size, and takes the fit of smaller
/// standard deviation s. For p below 0.5 it takes the best of the fits with the error terms h, h^2, and both,
/// for p above 2 of those with h and h^2. With D = (largest - smallest value)/(meshes - 1), e the fitted
/// error and d the residual of the finest mesh, its uncertainty is F |e| + s + |d| where s < D, with the
/// safety factor F = 1.25 for p from 0.5 to 2.1 and 3 otherwise, and 3 s/D (|e| + s + |d|) where s >= D. The
/// limit of the fit is given that uncertainty, and the noise and scatter of the finest mesh.
///
/// The interval of the order follows from the linearised fit, with meshes - 3 degrees of freedom. Its
/// verdict: as of fit_order(), where values that turn back are oscillatory, values of the finest meshes that
/// are not distinguished are a floor, and an order above the expected one that falls from the second finest
/// three meshes to the finest three is preasymptotic. Throws as coarsest_first().
Limit least_squares_limit(const std::vector<MeshSample>& values, double expected);

/// Richardson's extrapolation from the three finest meshes with the order p they show, whatever the ratios of
/// their sizes. The uncertainty of the limit is F |e|, e being the finest mesh's distance from it, with F as
/// above, plus the effect of noise and scatter of the three values on the limit. Where they show no p between
/// 0.5 and 3, the finest value stands, with three times their range (their earlier rule, Computers & Fluids
/// 38, 2009). Three values leave no freedom to determine an interval from: the order's interval
/// follows from noise and scatter, and its verdict from the agreement with the expected order. From two
/// meshes, the finest value and three times the distance that the expected order gives (Roache 1998).
Limit richardson_limit(const std::vector<MeshSample>& values, double expected);

/// Extrapolation of values whose error is a sum of known powers of the size, as where cells end at a punch's edges
/// (aligned_edge_powers()): with the first `powers`, as many as leave one mesh over, through the finest meshes. The
/// uncertainty is twice the larger of its distances from the same extrapolation without the finest mesh and from the
/// extrapolation with one power less, plus the effect of noise and scatter: 4 of 600 made sequences were off by more,
/// whose corners had other powers (1 + 2 alpha from 1.5 to 1.9). The order is that of value - limit, by fit_order().
/// Fewer than three meshes: least_squares_limit(). Throws as coarsest_first().
Limit expansion_limit(const std::vector<MeshSample>& values, const std::vector<double>& powers, double expected);

}  // namespace slipstick::convergence
