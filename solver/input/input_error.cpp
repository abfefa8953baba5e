#include "solver/input/input_error.hpp"

#include <fmt/core.h>

namespace slipstick::solver {
namespace {

/// Characters of a complaint that a message shows.
constexpr std::size_t kMaxComplaint = 2000;

/// A character of several bytes stays whole.
std::string cut(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  constexpr unsigned char kContinues = 0x80;
  constexpr unsigned char kContinuesMask = 0xC0;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & kContinuesMask) == kContinues) --most;
  return text.substr(0, most) + "...";
}

/// What a file says must not steer the terminal that shows it.
std::string harmless(const std::string& text) {
  constexpr char kDelete = 0x7f;
  std::string printable;
  for (const char c : text) {
    const bool steers = (static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t') || c == kDelete;
    printable += steers ? fmt::format("\\x{:02x}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return printable;
}

}  // namespace

InputError::InputError(const std::string& file, const std::string& key, const std::string& value,
                       const std::string& allowed)
    : std::invalid_argument(fmt::format("{}: {} = {}: allowed: {}", file, harmless(cut(key, kMaxShown)),
                                        harmless(cut(value, kMaxShown)), allowed)) {}

InputError::InputError(const std::string& file, const std::string& complaint)
    : std::invalid_argument(fmt::format("{}: {}", file, harmless(cut(complaint, kMaxComplaint)))) {}

}  // namespace slipstick::solver
