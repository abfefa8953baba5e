#pragma once

#include <cstring>

#include "solver/grid/grid.hpp"

/// Vectors of 16 bytes, which every processor of the 64-bit families has: GCC's and Clang's extension, for
/// the few loops in which compilers do not find the exchange of neighbours by themselves.
namespace slipstick::solver {

/// Two values in double precision, four in single: one or two complex numbers.
template <typename Real>
struct Packet {
  using Vector [[gnu::vector_size(16)]] = Real;
  static constexpr Index kSize = 16 / static_cast<Index>(sizeof(Real));

  static Vector load(const Real* from) {
    Vector packet;
    std::memcpy(&packet, from, sizeof(packet));
    return packet;
  }
  /// Values that are a stride apart.
  static Vector gather(const Real* from, Index stride) {
    if constexpr (kSize == 2) {
      return Vector{from[0], from[stride]};
    } else {
      return Vector{from[0], from[stride], from[2 * stride], from[3 * stride]};
    }
  }
  static void store(Real* to, Vector packet) { std::memcpy(to, &packet, sizeof(packet)); }

  /// (a, b, a, b)
  static Vector alternating(Real a, Real b) {
    if constexpr (kSize == 2) {
      return Vector{a, b};
    } else {
      return Vector{a, b, a, b};
    }
  }
  /// Each complex number's real part in place of its imaginary part.
  static Vector exchanged(Vector p) {
    if constexpr (kSize == 2) {
      return __builtin_shufflevector(p, p, 1, 0);
    } else {
      return __builtin_shufflevector(p, p, 1, 0, 3, 2);
    }
  }

  /// Of samples x + i y, those of even number and those of odd number, the latter from the last to the first.
  struct Halves {
    Vector even;
    Vector odd;
  };
  static Halves split(Vector x, Vector y) {
    if constexpr (kSize == 2) {
      return {__builtin_shufflevector(x, y, 0, 2), __builtin_shufflevector(x, y, 1, 3)};
    } else {
      return {__builtin_shufflevector(x, y, 0, 4, 2, 6), __builtin_shufflevector(x, y, 3, 7, 1, 5)};
    }
  }
  /// What x and y were.
  static Vector real_part(const Halves& halves) {
    if constexpr (kSize == 2) {
      return __builtin_shufflevector(halves.even, halves.odd, 0, 2);
    } else {
      return __builtin_shufflevector(halves.even, halves.odd, 0, 6, 2, 4);
    }
  }
  static Vector imaginary_part(const Halves& halves) {
    if constexpr (kSize == 2) {
      return __builtin_shufflevector(halves.even, halves.odd, 1, 3);
    } else {
      return __builtin_shufflevector(halves.even, halves.odd, 1, 7, 3, 5);
    }
  }
};

}  // namespace slipstick::solver
