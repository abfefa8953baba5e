#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "convergence/results/result_parts.hpp"

/// The one place where JSON that others wrote is read, and JSON is written.
namespace slipstick::convergence {

/// Levels of brackets in brackets. Results have ten or so; copying and writing JSON recurses, on a stack that
/// holds some ten thousand.
inline constexpr std::size_t kMaxJsonLevels = 200;

/// The value that a text holds. Throws InputError, naming `source` and what is allowed, for what is no JSON
/// or nested deeper than kMaxJsonLevels. Keys keep their order, except where an object has thousands.
Json parse_json(const std::string& text, const std::string& source, const std::string& allowed);

/// The same of a file of at most kLargestJson bytes.
Json read_json(const std::filesystem::path& file, const std::string& allowed);

/// Null where there is no regular file that can be read so.
Json find_json(const std::filesystem::path& file);

/// JSON as text, indented by so many blanks, -1: on one line. Names of files need not be UTF-8, JSON is: what
/// is not becomes U+FFFD.
std::string json_text(const Json& json, int indent = -1);

}  // namespace slipstick::convergence
