#include "solver/cache/solve_cache.hpp"

#include <algorithm>
#include <cfenv>

namespace slipstick::solver {

SolveCache::SolveCache(double max_bytes)
    : max_bytes_(max_bytes), bound_(max_bytes), rounding_(std::fegetround()) {}

void SolveCache::begin_solve(double room) {
  ++solve_;
  const int rounding = std::fegetround();
  if (std::exchange(rounding_, rounding) != rounding) {
    entries_.clear();
    bytes_ = 0.0;
  }
  bound_ = std::min(max_bytes_, room);
  make_room();
}

SolveCache::Thing SolveCache::take(const CacheKey& key) {
  const auto found = std::ranges::find(entries_, key, &Entry::key);
  if (found == entries_.end()) return {};
  if (found->solve != solve_) seconds_saved_ += found->thing.seconds;
  bytes_ -= found->bytes;
  Thing thing = std::move(found->thing);
  entries_.erase(found);
  return thing;
}

void SolveCache::keep(CacheKey key, Thing thing, double bytes) {
  bytes += static_cast<double>(key.size());
  bytes_ += bytes;
  entries_.push_front({std::move(key), std::move(thing), bytes, solve_});
  make_room();
}

void SolveCache::make_room() {
  while (!entries_.empty() && !(bytes_ <= bound_)) {
    bytes_ -= entries_.back().bytes;
    entries_.pop_back();
  }
}

}  // namespace slipstick::solver
