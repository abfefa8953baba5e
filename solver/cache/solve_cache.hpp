#pragma once

#include <chrono>
#include <exception>
#include <list>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace slipstick::solver {

/// All that a thing depends on, value by value: things that differ in a bit of it have different keys.
class CacheKey {
 public:
  /// what: the kind of thing.
  explicit CacheKey(std::string what) : bytes_(std::move(what)) {}

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T> CacheKey& add(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  CacheKey& add(std::span<const double> values) {
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    return add(values.size());
  }

  std::size_t size() const { return bytes_.size(); }
  bool operator==(const CacheKey&) const = default;

 private:
  std::string bytes_;
};

/// Keeps operators of a grid and solved pressures for the next solve that needs the same. Cached objects are
/// bit-identical to new ones. Where there is no room for all, the cache drops the one that was not needed for
/// longest. It serves one solve at a time.
class SolveCache {
 public:
  /// Bytes. Below this size the memory check is skipped.
  static constexpr double kDefaultBytes = 32.0 * 0x1p20;

  explicit SolveCache(double max_bytes = kDefaultBytes);

  /// A solve begins, and leaves `room` bytes for the cache. Objects that were made under another rounding go:
  /// FFTW's plans share their tables of sines, so that old plans would change the digits of new ones.
  void begin_solve(double room);

  struct Thing {
    std::shared_ptr<void> thing;  ///< null: there is none
    double seconds = 0.0;         ///< that making it took
  };
  Thing take(const CacheKey& key);
  void keep(CacheKey key, Thing thing, double bytes);

  /// Seconds that making the things took which came from earlier solves: this solve alone would have taken so
  /// much longer.
  double seconds_saved() const { return seconds_saved_; }

 private:
  struct Entry {
    CacheKey key;
    Thing thing;
    double bytes;
    long solve;  ///< the last that had it
  };

  void make_room();

  std::list<Entry> entries_;  ///< the last one kept first
  double max_bytes_;
  double bound_;  ///< in this solve
  double bytes_ = 0.0;
  double seconds_saved_ = 0.0;
  long solve_ = 0;
  int rounding_;  ///< how numbers are rounded
};

/// Times work as if nothing had been made for other solves.
class Stopwatch {
 public:
  explicit Stopwatch(const SolveCache* cache) : cache_(cache) {}

  /// Seconds since the last call, or since construction.
  double lap() {
    const auto now = Clock::now();
    const double before = std::exchange(saved_, saved());
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count() + saved_ - before;
  }

 private:
  using Clock = std::chrono::steady_clock;
  double saved() const { return cache_ != nullptr ? cache_->seconds_saved() : 0.0; }

  const SolveCache* cache_;
  Clock::time_point start_ = Clock::now();
  double saved_ = saved();
};

/// A thing from a cache, or made where it has none; the cache has it afterwards.
template <typename T>
class Cached {
 public:
  Cached() = default;
  /// cache: null for none. make: returns a std::unique_ptr<T>; bytes: those of a T, about.
  template <typename Make>
  Cached(std::shared_ptr<SolveCache> cache, CacheKey key, const Make& make, double bytes)
      : cache_(std::move(cache)), key_(std::move(key)), bytes_(bytes) {
    if (cache_) found_ = cache_->take(key_);
    if (found_.thing) return;
    Stopwatch watch(cache_.get());
    found_.thing = std::shared_ptr<T>(make());
    found_.seconds = watch.lap();
  }
  ~Cached() {
    if (!cache_ || !found_.thing || std::uncaught_exceptions() > 0) return;  // in the middle of some work
    try {
      cache_->keep(std::move(key_), std::move(found_), bytes_);
    } catch (const std::bad_alloc&) {  // then it is made again
    }
  }
  Cached(Cached&&) noexcept = default;
  Cached& operator=(Cached&&) = delete;

  T& operator*() const { return *static_cast<T*>(found_.thing.get()); }
  T* operator->() const { return &**this; }

 private:
  std::shared_ptr<SolveCache> cache_;
  CacheKey key_{""};
  SolveCache::Thing found_;
  double bytes_ = 0.0;
};

}  // namespace slipstick::solver
