#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <concepts>
#include <cstdlib>
#include <functional>
#include <type_traits>
#include <utility>

/// What mutated sources are made of. All mutants are compiled into one program, and SLIPSTICK_MUTANT=17
/// switches on the 17th; SLIPSTICK_REACHED names a file with one byte for each mutant, which becomes 1 when
/// its place is reached.
namespace slipstick::mutation {

struct Switch {
  int mutant = 0;                    ///< 0: none
  unsigned char* reached = nullptr;  ///< shared with the processes that this one starts
  std::size_t mutants = 0;

  Switch() {
    if (const char* number = std::getenv("SLIPSTICK_MUTANT")) mutant = std::atoi(number);
    const char* file = std::getenv("SLIPSTICK_REACHED");
    const int descriptor = file == nullptr ? -1 : open(file, O_RDWR | O_CLOEXEC);
    struct stat status {};
    if (descriptor < 0 || fstat(descriptor, &status) != 0) return;
    mutants = static_cast<std::size_t>(status.st_size);
    void* bytes = mmap(nullptr, mutants, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    if (bytes != MAP_FAILED) reached = static_cast<unsigned char*>(bytes);
    close(descriptor);
  }
};

inline bool on(int mutant) {
  static const Switch chosen;  // when it is first asked for: objects of other units may be made before main
  if (chosen.reached != nullptr && static_cast<std::size_t>(mutant) < chosen.mutants)
    chosen.reached[mutant] = 1;
  return chosen.mutant == mutant;
}

/// An Eigen expression is evaluated, since its type says what is computed.
template <class T>
auto plain(T&& value) {
  if constexpr (requires { value.eval(); }) {
    return value.eval();
  } else {
    return std::decay_t<T>(std::forward<T>(value));
  }
}
template <class T>
using Plain = decltype(plain(std::declval<T>()));

template <class Mutated, class Original>
concept CanReplace = std::same_as<Plain<Mutated>, Plain<Original>> ||
    (std::is_arithmetic_v<Plain<Mutated>>&& std::is_arithmetic_v<Plain<Original>>);

/// The first of two terms alone. Of strings it would change wording only.
struct First {
  template <class Left, class Right>
  requires requires(Left left) {
    left.eval();
  } || std::is_arithmetic_v<std::decay_t<Left>> Left operator()(Left&& left, Right&&) const {
    return std::forward<Left>(left);
  }
};

/// A comparison of whole numbers: of others `<` and `<=` differ nowhere.
template <class Comparison>
struct OfWhole : Comparison {
  template <class Left, class Right>
  requires std::integral<std::decay_t<Left>> && std::integral<std::decay_t<Right>>
  bool operator()(Left&& left, Right&& right) const {
    return Comparison::operator()(std::forward<Left>(left), std::forward<Right>(right));
  }
};

/// Stands between two operands, `a + Operator<std::plus<>, std::minus<>>{17} + b`, and so keeps precedence.
template <class Original, class Mutated>
struct Operator {
  int mutant;
};

template <class Left, class Original, class Mutated>
struct Half {
  Left&& left;
  int mutant;

  template <class Right>
  requires CanReplace<std::invoke_result_t<Mutated, Left, Right>, std::invoke_result_t<Original, Left, Right>>
  auto with(Right&& right) && -> Plain<std::invoke_result_t<Original, Left, Right>> {
    using Result = Plain<std::invoke_result_t<Original, Left, Right>>;
    if (on(mutant))
      return static_cast<Result>(plain(Mutated{}(std::forward<Left>(left), std::forward<Right>(right))));
    return plain(Original{}(std::forward<Left>(left), std::forward<Right>(right)));
  }
};

#define SLIPSTICK_BETWEEN(sign)                                                                   \
  template <class Left, class Original, class Mutated>                                            \
  Half<Left, Original, Mutated> operator sign(Left&& left, Operator<Original, Mutated> between) { \
    return {std::forward<Left>(left), between.mutant};                                            \
  }                                                                                               \
  template <class Left, class Original, class Mutated, class Right>                               \
  requires requires(Half<Left, Original, Mutated> half, Right && right) {                         \
    std::move(half).with(std::forward<Right>(right));                                             \
  }                                                                                               \
  auto operator sign(Half<Left, Original, Mutated>&& half, Right&& right) {                       \
    return std::move(half).with(std::forward<Right>(right));                                      \
  }
SLIPSTICK_BETWEEN(+)
SLIPSTICK_BETWEEN(-)
SLIPSTICK_BETWEEN(*)
SLIPSTICK_BETWEEN(/)
SLIPSTICK_BETWEEN(<)
SLIPSTICK_BETWEEN(<=)
SLIPSTICK_BETWEEN(>)
SLIPSTICK_BETWEEN(>=)
SLIPSTICK_BETWEEN(==)
SLIPSTICK_BETWEEN(!=)
#undef SLIPSTICK_BETWEEN

/// `-x` as `minus{17}->*x`, which binds nearly as closely; mutated: `x`.
struct minus {
  int mutant;
};
template <class T>
requires CanReplace<T, decltype(-std::declval<T>())>
auto operator->*(minus sign, T&& value) -> Plain<decltype(-std::declval<T>())> {
  if (on(sign.mutant)) return std::forward<T>(value);
  return plain(-std::forward<T>(value));
}

/// `!x` as `negation{17}->*x`; mutated: `x`.
struct negation {
  int mutant;
};
template <class T>
bool operator->*(negation sign, T&& value) {
  return on(sign.mutant) ? static_cast<bool>(value) : !static_cast<bool>(value);
}

/// A literal; mutated: twice as large, or one more where it is whole, or not.
template <class T>
T constant(int mutant, T value) {
  if (!on(mutant)) return value;
  if constexpr (std::same_as<T, bool>) return !value;
  if constexpr (std::floating_point<T>) return value == T(0) ? T(1) : 2 * value;
  return static_cast<T>(value + 1);
}

/// The index 0 or 1; mutated: the other.
inline int index(int mutant, int value) { return on(mutant) ? 1 - value : value; }

/// std::min or std::max; mutated: the other.
template <bool kLeast>
struct Extreme {
  int mutant;

  template <class... T>
  requires requires(T&&... values) { std::min(std::forward<T>(values)...); }
  auto operator()(T&&... values) const {
    return kLeast != on(mutant) ? std::min(std::forward<T>(values)...) : std::max(std::forward<T>(values)...);
  }
  template <class T>
  T operator()(std::initializer_list<T> values) const {
    return kLeast != on(mutant) ? std::min(values) : std::max(values);
  }
};

}  // namespace slipstick::mutation
