#pragma once

#include <locale.h>

#include <cfenv>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "interfaces/c/slipstick.h"

/// The boundary between C and C++: every function of slipstick.h does its work inside guarded().
namespace slipstick::c {

/// Thrown if the caller's progress function stops the solve.
struct Stopped {};

/// Sets the calling thread's message for slipstick_message(), cut to its length. Does not allocate.
void set_message(const char* message) noexcept;
const char* message() noexcept;

/// The status of the exception being handled, which becomes the message.
int status_of_exception() noexcept;

/// During its life the calling thread, and the threads that it starts, read numbers in the C locale, and
/// floating-point exceptions are not trapped, whatever the caller has set.
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

/// Returns the status of the work (SLIPSTICK_OK if it is void), or the status of its exception.
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
