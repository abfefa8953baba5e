#include "bench/plane/envelope.hpp"

#include <algorithm>
#include <cmath>

namespace slipstick::bench {
namespace {

bool is_number(const Way& way) { return std::isfinite(way.seconds) && std::isfinite(way.error); }

/// At least as quick and as good, and better in one of the two.
bool beats(const Way& a, const Way& b) {
  return a.seconds <= b.seconds && a.error <= b.error && (a.seconds < b.seconds || a.error < b.error);
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<Way>& ways) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const auto beats_it = [&](const Way& other) { return is_number(other) && beats(other, ways[i]); };
    if (is_number(ways[i]) && std::ranges::none_of(ways, beats_it)) front.push_back(i);
  }
  std::ranges::stable_sort(front, {}, [&](std::size_t way) { return ways[way].seconds; });
  return front;
}

std::optional<std::size_t> quickest_to(const std::vector<Way>& ways, double error) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (!is_number(ways[i]) || !(ways[i].error <= error)) continue;
    if (!best || ways[i].seconds < ways[*best].seconds) best = i;
  }
  return best;
}

}  // namespace slipstick::bench
