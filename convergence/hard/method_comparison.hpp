#pragma once

#include <string>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

/// How another method's answer stands beside a certified one to the same discrete problem: it agrees, or it
/// is refused, or not converged and says so; or it calls itself converged with slip that does not oppose
/// traction, or with another answer.
enum class MethodVerdict { agrees, refused, not_converged, other_direction, other_answer };
std::string to_string(MethodVerdict verdict);

struct ComparedAnswer {
  MethodVerdict verdict;
  std::string reason;  ///< of all but those that agree
  Json numbers;        ///< what the verdict rests on, with the work; empty where nothing was solved
};

/// `certified` and `other` are results of `solve`. An answer agrees within 1 % of twist, moment and energy.
/// Without a certified answer any other is another one.
ComparedAnswer compare_answer(const Json& certified, const Json& other);

}  // namespace slipstick::convergence
