#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "convergence/results/result_parts.hpp"

/// JSON files and texts are read and written here only.
namespace slipstick::convergence {

/// Levels of nested brackets. Results have about ten; copying and writing JSON recurses, and the stack holds
/// some ten thousand levels.
inline constexpr std::size_t kMaxJsonLevels = 200;

/// The value of a text. Throws InputError, with `source` and `allowed` in its message, for a text that is not
/// JSON or nested deeper than kMaxJsonLevels. Keys keep their order, except where an object has thousands.
Json parse_json(const std::string& text, const std::string& source, const std::string& allowed);

/// The value of a file of at most kLargestJson bytes.
Json read_json(const std::filesystem::path& file, const std::string& allowed);

/// The same; null where there is no regular file, or it holds no JSON.
Json find_json(const std::filesystem::path& file);

/// JSON as text, indented by `indent` blanks; -1: on one line. Bytes that are not UTF-8, as in names of
/// files, become U+FFFD.
std::string json_text(const Json& json, int indent = -1);

/// Writes JSON as write_whole_file() does; a file that has this content already keeps its time.
void write_json_file(const std::filesystem::path& file, const Json& json);

}  // namespace slipstick::convergence
