#pragma once

#include <cstddef>
#include <string>

namespace slipstick::solver {

/// Parts of a dotted key, at most. No key that is read has more than five; keys nest 256 deep at most.
inline constexpr std::size_t kMaxKeyParts = 32;

/// The line of the first key of a TOML text that is too long; 0: there is none. toml++ destroys tables in
/// tables recursively: keys of a million parts would overrun the stack. The dots outside of strings are
/// counted; a key inside a table in braces has the parts of the keys around that table too.
std::ptrdiff_t line_of_long_key(const std::string& text);

}  // namespace slipstick::solver
