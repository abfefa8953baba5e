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

/// All values that an object depends on. Objects whose values differ in any bit have different keys.
class CacheKey {
 public:
  /// what: the kind of object.
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
  /// Bytes that a cache holds at most, where its owner names no other number.
  static constexpr double kDefaultBytes = 32.0 * 0x1p20;

  explicit SolveCache(double max_bytes = kDefaultBytes);

  /// A solve begins, and leaves `room` bytes for the cache. Objects that were made under another rounding go:
  /// FFTW's plans share their tables of sines, so that old plans would change the digits of new ones.
  void begin_solve(double room);

  struct CachedObject {
    std::shared_ptr<void> object;  ///< null: the cache has none
    double seconds = 0.0;          ///< that it took to make
  };
  CachedObject take(const CacheKey& key);
  void keep(CacheKey key, CachedObject object, double bytes);

  /// Seconds that it took earlier solves to make the objects that this one reused.
  double seconds_saved() const { return seconds_saved_; }

 private:
  struct Entry {
    CacheKey key;
    CachedObject object;
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

/// An object from a cache, or a new one where the cache has none. The destructor gives it to the cache.
template <typename T>
class Cached {
 public:
  Cached() = default;
  /// cache: null for none. make: returns a std::unique_ptr<T>; bytes: approximate size of a T.
  template <typename Make>
  Cached(std::shared_ptr<SolveCache> cache, CacheKey key, const Make& make, double bytes)
      : cache_(std::move(cache)), key_(std::move(key)), bytes_(bytes) {
    if (cache_) found_ = cache_->take(key_);
    if (found_.object) return;
    Stopwatch watch(cache_.get());
    found_.object = std::shared_ptr<T>(make());
    found_.seconds = watch.lap();
  }
  ~Cached() {
    if (!cache_ || !found_.object || std::uncaught_exceptions() > 0) return;  // its state may be inconsistent
    try {
      cache_->keep(std::move(key_), std::move(found_), bytes_);
    } catch (const std::bad_alloc&) {  // the next solve makes it again
    }
  }
  Cached(Cached&&) noexcept = default;
  Cached& operator=(Cached&&) = delete;

  T& operator*() const { return *static_cast<T*>(found_.object.get()); }
  T* operator->() const { return &**this; }

 private:
  std::shared_ptr<SolveCache> cache_;
  CacheKey key_{""};
  SolveCache::CachedObject found_;
  double bytes_ = 0.0;
};

}  // namespace slipstick::solver
