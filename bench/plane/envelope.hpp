#pragma once

#include <cstddef>
#include <optional>
#include <vector>

/// The ways to an answer that are optimal in time and error (the Pareto front).
namespace slipstick::bench {

/// One way. A NaN is worse than any number.
struct Way {
  double seconds = 0.0;
  double error = 0.0;
};

/// Indices of the ways that no other way beats, quickest first. A way beats another if it is at least as
/// quick and as good, and better in one of the two; of equal ways none beats another.
std::vector<std::size_t> pareto_front(const std::vector<Way>& ways);

/// The quickest way with at most this error; none if no way is as good.
std::optional<std::size_t> quickest_to(const std::vector<Way>& ways, double error);

}  // namespace slipstick::bench
