#include "solver/input/input_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "solver/input/input_error.hpp"

namespace slipstick::solver {
namespace {

/// A regular file open for reading. Opening does not block on a pipe without a writer.
class InputFile {
 public:
  InputFile(const std::filesystem::path& file, std::uintmax_t largest, const std::string& allowed)
      : file_(file),
        allowed_(allowed),
        largest_(largest),
        descriptor_(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~InputFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  void require_regular() const {
    struct stat status {};
    if (descriptor_ < 0 || fstat(descriptor_, &status) != 0) fail(std::generic_category().message(errno));
    if (S_ISDIR(status.st_mode)) fail("it is a folder");
    if (!S_ISREG(status.st_mode)) fail("it is a device or a pipe");
    if (static_cast<std::uintmax_t>(status.st_size) > largest_) fail_for_size();
  }

  /// Reads to the end, or `most` bytes and some: a file may grow meanwhile, and files of the system have no size.
  std::string read(std::uintmax_t most) const {
    struct stat status {};
    std::string text;
    if (fstat(descriptor_, &status) == 0) text.reserve(std::min<std::uintmax_t>(status.st_size, most));
    std::array<char, 1 << 16> buffer;
    for (;;) {
      const ssize_t size = ::read(descriptor_, buffer.data(), buffer.size());
      if (size < 0 && errno == EINTR) continue;
      if (size < 0) fail(std::generic_category().message(errno));
      text.append(buffer.data(), static_cast<std::size_t>(size));
      if (size == 0 || text.size() >= most) return text;
      if (text.size() > largest_) fail_for_size();
    }
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(file_.string(), fmt::format("cannot be read: {}; allowed: {}", reason, allowed_));
  }
  [[noreturn]] void fail_for_size() const {
    throw InputError(file_.string(),
                     fmt::format("is larger than {} MiB; allowed: {} of at most that size", largest_ >> 20, allowed_));
  }

  const std::filesystem::path& file_;
  const std::string& allowed_;
  std::uintmax_t largest_;
  int descriptor_;
};

/// The control character with which a text begins, and its bytes in UTF-8; {0, 1}: none. Control characters
/// are C0 without line feed and tab, C1, and Unicode's that change the direction of text or end a line.
std::pair<unsigned, std::size_t> steering(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[i])) : 0U;
  };
  const auto between = [](unsigned low, unsigned x, unsigned high) { return low <= x && x <= high; };
  const unsigned c = byte(0);
  if ((c < ' ' && c != '\n' && c != '\t') || c == 0x7f) return {c, 1};
  const unsigned two = (c & 0x1fU) << 6U | (byte(1) & 0x3fU);
  if (c == 0xc2 && between(0x80, two, 0x9f)) return {two, 2};
  if (c == 0xd8 && two == 0x61c) return {two, 2};
  const unsigned three = (c & 0xfU) << 12U | (byte(1) & 0x3fU) << 6U | (byte(2) & 0x3fU);
  const bool turns = between(0x200e, three, 0x200f) || between(0x2028, three, 0x202e) || between(0x2066, three, 0x2069);
  if (c == 0xe2 && byte(2) != 0 && turns) return {three, 3};
  return {0, 0};
}

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

void require_input_file(const std::filesystem::path& file, std::uintmax_t largest, const std::string& allowed) {
  InputFile(file, largest, allowed).require_regular();
}

std::string read_input_file(const std::filesystem::path& file, std::uintmax_t largest, const std::string& allowed,
                            std::uintmax_t most) {
  const InputFile input(file, largest, allowed);
  input.require_regular();
  return input.read(most);
}

bool lies_within(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code error;
  const auto way = std::filesystem::relative(std::filesystem::absolute(file), std::filesystem::absolute(folder), error);
  return !error && !way.empty() && *way.begin() != "..";
}

std::string printable(std::string_view text) {
  std::string printable;
  for (std::size_t i = 0; i < text.size();) {
    const auto [character, bytes] = steering(text.substr(i));
    if (bytes == 0) {
      printable += text[i];
    } else {
      printable += character < 0x100 ? fmt::format("\\x{:02x}", character) : fmt::format("\\u{:04x}", character);
    }
    i += std::max<std::size_t>(1, bytes);
  }
  return printable;
}

std::string shown(std::string_view text) {
  std::string printable;
  for (const char c : text.substr(0, kMaxShown)) {
    const bool plain = c >= ' ' && c <= '~';
    printable += plain ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  return text.size() > kMaxShown ? printable + "..." : printable;
}

InputError::InputError(const std::string& file, const std::string& key, const std::string& value,
                       const std::string& allowed)
    : std::invalid_argument(fmt::format("{}: {} = {}: allowed: {}", printable(cut(file, kMaxComplaint)),
                                        printable(cut(key, kMaxShown)), printable(cut(value, kMaxShown)), allowed)) {}

InputError::InputError(const std::string& file, const std::string& complaint)
    : std::invalid_argument(
          fmt::format("{}: {}", printable(cut(file, kMaxComplaint)), printable(cut(complaint, kMaxComplaint)))) {}

}  // namespace slipstick::solver
