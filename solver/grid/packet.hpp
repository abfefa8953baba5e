#pragma once

#include <array>
#include <cstring>
#include <type_traits>

#include "solver/grid/grid.hpp"

/// Vectors of 16 bytes, which every 64-bit processor has (an extension of GCC and Clang), for the few loops
/// that compilers do not vectorise because neighbours are exchanged.
namespace slipstick::solver {

/// Two values: one complex number.
struct Packet {
  using Vector [[gnu::vector_size(16)]] = double;
  static constexpr Index kSize = 2;

  static Vector load(const double* from) {
    Vector packet;
    std::memcpy(&packet, from, sizeof(packet));
    return packet;
  }
  /// In double precision.
  static Vector load(const float* from) {
    using Floats [[gnu::vector_size(8)]] = float;
    Floats packet;
    std::memcpy(&packet, from, sizeof(packet));
    return __builtin_convertvector(packet, Vector);
  }
  /// Values that are a stride apart.
  static Vector gather(const double* from, Index stride) { return Vector{from[0], from[stride]}; }
  static void store(double* to, Vector packet) { std::memcpy(to, &packet, sizeof(packet)); }

  /// work(i, Vector()) for each two of [first, last), and work(i, double()) for the last one of an odd count.
  /// get() and put() take values of the second argument's type from i on.
  template <typename Work>
  static void each(Index first, Index last, const Work& work) {
    Index i = first;
    for (; i + 1 < last; i += kSize) work(i, Vector{});
    if (i < last) work(i, double{});
  }
  template <typename Value, typename Number>
  static Value get(const Number* from) {
    if constexpr (sizeof(Value) == sizeof(double))
      return *from;
    else
      return load(from);
  }
  static void put(double* to, double value) { *to = value; }
  static void put(double* to, Vector packet) { store(to, packet); }

  /// (a, b)
  static Vector alternating(double a, double b) { return Vector{a, b}; }
  /// Real and imaginary part exchanged.
  static Vector exchanged(Vector p) { return __builtin_shufflevector(p, p, 1, 0); }

  /// The samples x + i y at even places, and those at odd places from the last to the first.
  struct Halves {
    Vector even;
    Vector odd;
  };
  static Halves split(Vector x, Vector y) {
    return {__builtin_shufflevector(x, y, 0, 2), __builtin_shufflevector(x, y, 1, 3)};
  }
  /// x and y again.
  static Vector real_part(const Halves& halves) { return __builtin_shufflevector(halves.even, halves.odd, 0, 2); }
  static Vector imaginary_part(const Halves& halves) { return __builtin_shufflevector(halves.even, halves.odd, 1, 3); }
};

/// sums[k] += w_k.r over n values, all k in one pass.
template <std::size_t K>
void add_dots(const std::array<const float*, K>& w, const double* r, Index n, double* sums) {
  std::array<Packet::Vector, K> pairs{};
  std::array<double, K> last{};
  Packet::each(0, n, [&]<typename Value>(Index i, Value) {
    const auto value = Packet::get<Value>(r + i);
    for (std::size_t k = 0; k < K; ++k) {
      const Value product = Packet::get<Value>(w[k] + i) * value;
      if constexpr (std::is_same_v<Value, double>)
        last[k] = product;
      else
        pairs[k] += product;
    }
  });
  for (std::size_t k = 0; k < K; ++k) sums[k] += pairs[k][0] + pairs[k][1] + last[k];
}

/// y -= sum over k of part_k w_k, for n values.
template <std::size_t K>
void take_out(const std::array<const float*, K>& w, const double* parts, double* y, Index n) {
  Packet::each(0, n, [&]<typename Value>(Index i, Value) {
    auto value = Packet::get<Value>(y + i);
    for (std::size_t k = 0; k < K; ++k) value -= parts[k] * Packet::get<Value>(w[k] + i);
    Packet::put(y + i, value);
  });
}

}  // namespace slipstick::solver
