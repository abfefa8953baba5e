#pragma once

#include <cstddef>
#include <string>

namespace slipstick::solver {

/// Parts of a dotted key, at most. No key that is read has more than five; keys nest 256 deep at most.
inline constexpr std::size_t kMaxKeyParts = 32;

/// The line of the first key of a TOML text that is too long; 0: there is none. toml++ destroys tables in
/// tables recursively: keys of a million parts would overrun the stack. The dots between parts are counted,
/// outside of strings; the parts of keys around a table in braces add to those of the keys in it.
std::ptrdiff_t line_of_long_key(const std::string& text);

}  // namespace slipstick::solver
