#include "interfaces/c/boundary.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <new>

namespace slipstick::c {
namespace {

thread_local std::array<char, 4096> last_message{};

}  // namespace

void set_message(const char* message) noexcept {
  const std::size_t length = std::min(std::strlen(message), last_message.size() - 1);
  std::memcpy(last_message.data(), message, length);
  last_message[length] = '\0';
}

const char* message() noexcept { return last_message.data(); }

PlainNumbers::PlainNumbers() noexcept {
  static const locale_t plain = newlocale(LC_NUMERIC_MASK, "C", nullptr);
  before_ = uselocale(plain);
  std::feholdexcept(&traps_);
}

PlainNumbers::~PlainNumbers() {
  std::fesetenv(&traps_);
  uselocale(before_);
}

int status_of_exception() noexcept {
  const auto failed = [](const char* message, int status) {
    set_message(message);
    return status;
  };
  try {
    throw;
  } catch (const Stopped&) {
    return failed("stopped by the caller's progress function", SLIPSTICK_STOPPED);
  } catch (const std::invalid_argument& error) {
    return failed(error.what(), SLIPSTICK_BAD_INPUT);
  } catch (const std::domain_error& error) {
    return failed(error.what(), SLIPSTICK_BAD_INPUT);
  } catch (const std::bad_alloc&) {
    return failed("memory is used up", SLIPSTICK_NO_MEMORY);
  } catch (const std::exception& error) {
    return failed(error.what(), SLIPSTICK_FAILED);
  } catch (...) {
    return failed("an unknown exception", SLIPSTICK_FAILED);
  }
}

}  // namespace slipstick::c

const char* slipstick_version(void) { return SLIPSTICK_VERSION; }
const char* slipstick_message(void) { return slipstick::c::message(); }
