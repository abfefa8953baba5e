#pragma once

#include <cmath>

#include "solver/newton/coefficients.hpp"

namespace slipstick::solver {

/// First and last s of the smoothing |v| -> sqrt(|v|^2 + s^2), for v of the order of 1.
struct Smoothing {
  double first;
  double least;
};

/// Minimises a sum of lengths |v| of vectors that are linear in a few variables. The sum is convex, but has
/// flat parts and kinks at which Newton's method fails, so that it is smoothed to sqrt(|v|^2 + s^2):
///
/// 1. A Newton step on the smoothed sum, halved until the sum falls (Armijo).
/// 2. If the Newton decrement is small against s, which bounds the smoothing error, or no step lowers the
///    sum: s falls tenfold.
/// 3. Again from 1, until done(point, s) or s is below the last one.
///
/// evaluate(point, step, s): the Point at a step of the variables from `point`, with the members `smoothed`,
/// the sum, and its derivatives `gradient` and `hessian`.
template <class Point, class Evaluate, class Done>
Point minimise_smoothed(const Point& start, const Smoothing& smoothing, const Evaluate& evaluate, const Done& done) {
  constexpr double kReduction = 0.1;
  constexpr double kSettled = 0.01;
  constexpr double kRounding = 1e-15;
  constexpr int kMaxSteps = 200;    // four times what has been seen
  constexpr int kMaxHalvings = 33;  // of a Newton step, which a flat stretch makes long
  constexpr double kArmijo = 1e-4;

  double s = smoothing.first;
  const Coefficients none = Coefficients::Zero(start.gradient.size());
  Point at = evaluate(start, none, s);
  for (int step_count = 0; step_count < kMaxSteps && !done(at, s) && !(s < smoothing.least); ++step_count) {
    Coefficients step = none;
    double decrement = 0.0;
    if (step.size() > 0) {
      CoefficientMatrix hessian = at.hessian;
      hessian.diagonal().array() += kRounding * hessian.trace();
      step = -SmallCholesky(hessian).solve(at.gradient);
      decrement = -at.gradient.dot(step);
    }
    const bool settled = decrement <= kSettled * s + kRounding;
    bool lower = false;
    for (int halvings = 0; !settled && !lower && halvings <= kMaxHalvings; ++halvings) {
      const double part = std::ldexp(1.0, -halvings);
      const Point next = evaluate(at, part * step, s);
      lower = next.smoothed <= at.smoothed - kArmijo * part * decrement;
      if (lower) at = next;
    }
    if (lower) continue;
    s *= kReduction;
    at = evaluate(at, settled ? step : none, s);
  }
  return at;
}

}  // namespace slipstick::solver
