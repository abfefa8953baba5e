#pragma once

#include <stdexcept>
#include <string>

namespace slipstick::solver {

/// Something the caller got wrong, with where it stands, what it says and what is allowed.
class InputError : public std::invalid_argument {
 public:
  InputError(const std::string& file, const std::string& key, const std::string& value,
             const std::string& allowed);
  /// A complaint about a file as a whole.
  InputError(const std::string& file, const std::string& complaint);
};

}  // namespace slipstick::solver
