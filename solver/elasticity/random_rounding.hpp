#pragma once

#include <cfenv>
#include <cstdint>
#include <memory>

#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

/// An operator that rounds at random, drawn from the seed: each displacement is off by up to an ulp of the
/// largest, and after each application all that is computed, transforms, sums and the rest, is rounded either
/// upward or downward, until the next. Digits of an answer that survive many seeds depend on no compiler,
/// processor or order of sums (Parker 1997, Monte Carlo arithmetic; Vignes 2004, random rounding).
std::unique_ptr<LinearOperator> rounded_at_random(std::unique_ptr<LinearOperator> op,
                                                  const BlockKernel& kernel, std::uint64_t seed);

/// Keeps the direction of rounding that it finds, and restores it in the end.
class KeptRounding {
 public:
  KeptRounding() : found_(std::fegetround()) {}
  ~KeptRounding() { std::fesetround(found_); }
  KeptRounding(const KeptRounding&) = delete;
  KeptRounding& operator=(const KeptRounding&) = delete;

 private:
  int found_;
};

}  // namespace slipstick::solver
