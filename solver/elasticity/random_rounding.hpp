#pragma once

#include <cfenv>
#include <cstdint>
#include <memory>

#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

/// An operator with random rounding, drawn from the seed: each displacement changes by up to an ulp of the
/// largest one, and after each application the thread rounds either upward or downward until the next. Digits
/// that agree for many seeds do not depend on compiler, processor or order of sums (Parker 1997, Monte Carlo
/// arithmetic; Vignes 2004, random rounding).
std::unique_ptr<LinearOperator> rounded_at_random(std::unique_ptr<LinearOperator> op,
                                                  const BlockKernel& kernel, std::uint64_t seed);

/// Restores this thread's rounding direction at the end; optionally sets another one first.
class KeptRounding {
 public:
  KeptRounding() : found_(std::fegetround()) {}
  explicit KeptRounding(int direction) : KeptRounding() { std::fesetround(direction); }
  ~KeptRounding() { std::fesetround(found_); }
  KeptRounding(const KeptRounding&) = delete;
  KeptRounding& operator=(const KeptRounding&) = delete;

 private:
  int found_;
};

}  // namespace slipstick::solver
