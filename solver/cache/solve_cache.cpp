#include "solver/cache/solve_cache.hpp"

#include <algorithm>
#include <cfenv>

namespace slipstick::solver {

SolveCache::SolveCache(double max_bytes) : max_bytes_(max_bytes), bound_(max_bytes), rounding_(std::fegetround()) {}

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

SolveCache::CachedObject SolveCache::take(const CacheKey& key) {
  const auto found = std::ranges::find(entries_, key, &Entry::key);
  if (found == entries_.end()) return {};
  if (found->solve != solve_) seconds_saved_ += found->object.seconds;
  bytes_ -= found->bytes;
  CachedObject object = std::move(found->object);
  entries_.erase(found);
  return object;
}

void SolveCache::keep(CacheKey key, CachedObject object, double bytes) {
  bytes += static_cast<double>(key.size());
  bytes_ += bytes;
  entries_.push_front({std::move(key), std::move(object), bytes, solve_});
  make_room();
}

void SolveCache::make_room() {
  while (!entries_.empty() && !(bytes_ <= bound_)) {
    bytes_ -= entries_.back().bytes;
    entries_.pop_back();
  }
}

}  // namespace slipstick::solver
