#pragma once

#include <cmath>

#include "solver/newton/coefficients.hpp"

namespace slipstick::solver {

/// How far |v| is smoothed to sqrt(|v|^2 + s^2), for v of the size of 1.
struct Smoothing {
  double first;
  double least;
};

/// Newton's method on a sum of lengths |v| of vectors that are linear in a few variables, smoothed less and
/// less: s falls tenfold each time that the decrement has settled to a part of the smoothing error, which is
/// at most s, or gains no more than rounding. Such sums are convex, and flat or kinked where Newton's method
/// alone fails.
///
/// evaluate(point, step, s) returns the Point that lies a step of the variables from a point, with the
/// members `smoothed`, the sum, and its derivatives `gradient` and `hessian`; done(point, s) ends the search.
template <class Point, class Evaluate, class Done>
Point minimise_smoothed(const Point& start, const Smoothing& smoothing, const Evaluate& evaluate,
                        const Done& done) {
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
