#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace slipstick::solver {

/// Characters of what a file says that a message shows: a file may be endless.
inline constexpr std::size_t kMaxShown = 200;

/// Something the caller got wrong, with where it stands, what it says and what is allowed.
class InputError : public std::invalid_argument {
 public:
  InputError(const std::string& file, const std::string& key, const std::string& value,
             const std::string& allowed);
  /// A complaint about a file as a whole.
  InputError(const std::string& file, const std::string& complaint);
};

}  // namespace slipstick::solver
