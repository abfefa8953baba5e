#include "solver/input/input_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <system_error>

#include "solver/input/input_error.hpp"

namespace slipstick::solver {
namespace {

/// A regular file open for reading. Opening does not wait for somebody to write into a pipe.
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

  /// Reads to the end: a file may grow meanwhile, and files of the system have no size.
  std::string read() const {
    std::string text;
    std::array<char, 1 << 16> buffer;
    for (;;) {
      const ssize_t size = ::read(descriptor_, buffer.data(), buffer.size());
      if (size < 0 && errno == EINTR) continue;
      if (size < 0) fail(std::generic_category().message(errno));
      if (size == 0) return text;
      text.append(buffer.data(), static_cast<std::size_t>(size));
      if (text.size() > largest_) fail_for_size();
    }
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(file_.string(), fmt::format("cannot be read: {}; allowed: {}", reason, allowed_));
  }
  [[noreturn]] void fail_for_size() const {
    throw InputError(file_.string(), fmt::format("is larger than {} MiB; allowed: {} of at most that size",
                                                 largest_ >> 20, allowed_));
  }

  const std::filesystem::path& file_;
  const std::string& allowed_;
  std::uintmax_t largest_;
  int descriptor_;
};

}  // namespace

void require_input_file(const std::filesystem::path& file, std::uintmax_t largest,
                        const std::string& allowed) {
  InputFile(file, largest, allowed).require_regular();
}

std::string read_input_file(const std::filesystem::path& file, std::uintmax_t largest,
                            const std::string& allowed) {
  const InputFile input(file, largest, allowed);
  input.require_regular();
  return input.read();
}

bool lies_within(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code error;
  const auto whole = std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
  if (error) return false;
  const auto around = std::filesystem::weakly_canonical(std::filesystem::absolute(folder), error) / "";
  // The folder's path ends with an empty part, which stands for whatever follows.
  return !error && std::mismatch(whole.begin(), whole.end(), around.begin(), around.end()).second ==
                       std::prev(around.end());
}

std::string printable(std::string_view text) {
  constexpr unsigned char kDelete = 0x7f;
  constexpr unsigned char kUpper = 0xc2;  // before 0x80 to 0x9f in UTF-8: control characters as well
  std::string printable;
  unsigned char before = 0;
  for (const char each : text) {
    const auto c = static_cast<unsigned char>(each);
    const bool steers =
        (c < ' ' && c != '\n' && c != '\t') || c == kDelete || (before == kUpper && c >= 0x80 && c < 0xa0);
    if (steers && before == kUpper) printable.pop_back();
    printable += steers ? fmt::format("\\x{:02x}", c) : std::string(1, each);
    before = c;
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

}  // namespace slipstick::solver
