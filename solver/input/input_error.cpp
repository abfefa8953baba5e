#include "solver/input/input_error.hpp"

#include <fmt/core.h>

#include "solver/input/input_file.hpp"

namespace slipstick::solver {
namespace {

/// Characters of a complaint that a message shows.
constexpr std::size_t kMaxComplaint = 2000;

/// A character of several bytes stays whole.
std::string cut(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  // In UTF-8 all bytes of a character but the first are 10xxxxxx.
  constexpr unsigned char kContinues = 0x80;
  constexpr unsigned char kContinuesMask = 0xC0;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & kContinuesMask) == kContinues) --most;
  return text.substr(0, most) + "...";
}

}  // namespace

InputError::InputError(const std::string& file, const std::string& key, const std::string& value,
                       const std::string& allowed)
    : std::invalid_argument(fmt::format("{}: {} = {}: allowed: {}", printable(cut(file, kMaxComplaint)),
                                        printable(cut(key, kMaxShown)), printable(cut(value, kMaxShown)),
                                        allowed)) {}

InputError::InputError(const std::string& file, const std::string& complaint)
    : std::invalid_argument(fmt::format("{}: {}", printable(cut(file, kMaxComplaint)),
                                        printable(cut(complaint, kMaxComplaint)))) {}

}  // namespace slipstick::solver
