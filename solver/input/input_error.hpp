#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace slipstick::solver {

/// Largest number of characters of a value that a message shows.
inline constexpr std::size_t kMaxShown = 200;

/// An error of the caller's input: file, key, value and allowed values.
class InputError : public std::invalid_argument {
 public:
  InputError(const std::string& file, const std::string& key, const std::string& value, const std::string& allowed);
  /// A complaint about a file as a whole.
  InputError(const std::string& file, const std::string& complaint);
};

}  // namespace slipstick::solver
