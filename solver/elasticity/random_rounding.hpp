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

/// Keeps how this thread rounds, or sets it, and restores in the end what it found.
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
