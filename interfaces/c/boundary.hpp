#pragma once

#include <locale.h>

#include <cfenv>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "interfaces/c/slipstick.h"

/// Where C++ ends: every function of slipstick.h does its work inside guarded().
namespace slipstick::c {

/// Thrown where the caller asked for an end.
struct Stopped {};

/// What slipstick_message() gives to the calling thread from now on, cut to its length. Does not allocate.
void set_message(const char* message) noexcept;
const char* message() noexcept;

/// The status of the exception being handled, which becomes the message.
int status_of_exception() noexcept;

/// As long as it lives, the calling thread, and those that it starts, read numbers as C writes them, whatever
/// the caller's locale, and no floating-point exception is trapped, whatever the caller traps.
class PlainNumbers {
 public:
  PlainNumbers() noexcept;
  ~PlainNumbers();
  PlainNumbers(const PlainNumbers&) = delete;
  PlainNumbers& operator=(const PlainNumbers&) = delete;

 private:
  locale_t before_;
  std::fenv_t traps_{};
};

/// The status that the work returns, SLIPSTICK_OK if it returns none, or that of the exception that it
/// throws.
template <class Work>
int guarded(const Work& work) noexcept {
  const PlainNumbers plain;
  try {
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      return SLIPSTICK_OK;
    } else {
      return work();
    }
  } catch (...) {
    return status_of_exception();
  }
}

/// Throws std::invalid_argument naming the argument where it is null.
inline void require(const void* argument, const char* name) {
  if (argument == nullptr) throw std::invalid_argument(std::string(name) + " = NULL; allowed: a pointer");
}

}  // namespace slipstick::c
