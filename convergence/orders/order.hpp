#pragma once

#include <string>
#include <vector>

#include "convergence/orders/mesh_sequence.hpp"

namespace slipstick::convergence {

/// p of error = C size^p with its 95 % confidence interval, and whether to believe it.
struct Order {
  double value;  ///< NaN where none was fitted
  double low;
  double high;
  double constant;  ///< C, signed: the error at size 1
  OrderVerdict verdict;
  std::string why;                 ///< one sentence, for a person
  std::vector<double> sizes = {};  ///< of the meshes that it was fitted to, coarsest first
};

/// How far an order may be from the expected one on meshes that one can afford, where the next term of the
/// error is still there.
inline constexpr double kOrderMargin = 0.1;

/// A wider interval, on either side of the order, does not distinguish whole orders.
inline constexpr double kWidestHalf = 0.5;

/// Least squares of log |error| against log size over the meshes whose error is distinguished from its noise
/// and scatter. errors: signed, in any order of the meshes. expected: the order that theory gives; NaN where
/// it gives none, and then the verdict is preasymptotic at best. The interval is Student's. Where all meshes
/// have several grids whose spread explains the residuals (chi squared, 95 %), it follows from the spread,
/// and meshes have weights by their spread; otherwise from the residuals, with equal weights. The effect of
/// the noise on the order is added. Throws as coarsest_first().
///
/// Verdict, the first that holds:
/// - too_few: fewer than three meshes have a number, or an error above noise;
/// - floor: the finest error is lost in noise or scatter, or has stopped falling;
/// - oscillatory: the sign changes, other than once before the three finest meshes (the meshes before that
///   take no part), or the size rises on one mesh and falls on another;
/// - preasymptotic: the order between the two finest meshes is not the order of all, to kOrderMargin, and a
///   curvature is significant at 95 % (or there are too few meshes to say);
/// - superconvergent: the interval lies above expected + kOrderMargin;
/// - preasymptotic: the interval is wider than kWidestHalf on a side, or ends below expected - kOrderMargin;
/// - asymptotic.
Order fit_order(const std::vector<MeshSample>& errors, double expected);

/// The verdict by the interval of a fitted order where nothing else speaks against it: superconvergent,
/// preasymptotic or asymptotic, with the reason.
Order judged_by_interval(Order order, double expected);

}  // namespace slipstick::convergence
