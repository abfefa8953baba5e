#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <concepts>
#include <cstdlib>
#include <string>
#include <type_traits>
#include <utility>

/// Mutated sources use these macros and functions. All mutants are compiled into one program;
/// SLIPSTICK_MUTANT=17 switches on the 17th. SLIPSTICK_REACHED names a file with one byte for each mutant,
/// which becomes 1 when its place is reached.
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
  static const Switch chosen;  // at the first use: objects of other units may be constructed before main
  if (chosen.reached != nullptr && static_cast<std::size_t>(mutant) < chosen.mutants)
    chosen.reached[mutant] = 1;
  return chosen.mutant == mutant;
}

/// The value. An Eigen expression is evaluated, since its type encodes the computation.
template <class T>
auto plain(T&& value) {
  if constexpr (requires { value.eval(); }) {
    return value.eval();
  } else {
    return std::decay_t<T>(std::forward<T>(value));
  }
}

/// The result of `original`, or of `mutated` if the mutant is switched on. Mutants of strings would
/// change wording only.
template <class Mutated, class Original>
auto choose(int mutant, Mutated mutated, Original original) {
  using Value = decltype(original());
  static_assert(std::same_as<decltype(mutated()), Value> ||
                (std::is_arithmetic_v<decltype(mutated())> && std::is_arithmetic_v<Value>));
  static_assert(!std::same_as<Value, std::string>);
  return on(mutant) ? static_cast<Value>(mutated()) : original();
}

}  // namespace slipstick::mutation
