#pragma once

#include <functional>
#include <string>

/// Reports of an iteration, while it runs and at its end.
namespace slipstick::solver {

/// Called once per iteration: operator applications (or iterations) so far, and the relative gap (the
/// relative change of the tractions in fixed-point methods). An empty one is never called.
using Progress = std::function<void(long count, double error)>;

/// Counts of the safeguards that Newton's method has used.
struct Safeguards {
  int second_solves = 0;   ///< of a linear problem, without the loads of cells that jump onto their set
  int halvings = 0;        ///< of a step that did not lower the energy
  int gradient_steps = 0;  ///< because no part of a Newton step lowered the energy
  int breakdowns = 0;      ///< of conjugate gradients
  std::string breakdown;   ///< the first of them, with its number; empty: none

  Safeguards& operator+=(const Safeguards& other) {
    second_solves += other.second_solves;
    halvings += other.halvings;
    gradient_steps += other.gradient_steps;
    breakdowns += other.breakdowns;
    if (breakdown.empty()) breakdown = other.breakdown;
    return *this;
  }
};

}  // namespace slipstick::solver
