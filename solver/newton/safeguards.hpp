#pragma once

#include <string>

namespace slipstick::solver {

/// What Newton's method had to do beside its plain steps, and how often.
struct Safeguards {
  int second_solves = 0;   ///< of a linear problem, without the loads of cells that jump onto their set
  int halvings = 0;        ///< of a step that did not lower the energy
  int gradient_steps = 0;  ///< where no part of a Newton step did
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
