#include "convergence/results/json_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace {

/// Whether a regular file has this content.
bool has_content(const std::filesystem::path& file, const std::string& content) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  try {
    return solver::read_input_file(file, solver::kLargestTextTable, "a regular file") == content;
  } catch (const solver::InputError&) {
    return false;
  }
}

/// Keys of one object that are read in their order, which costs the square of their number: 10 ms.
constexpr std::size_t kMaxOrderedKeys = 2000;

/// The size of a text of JSON in two directions.
struct Extent {
  std::size_t levels = 0;
  std::size_t keys = 0;  ///< of the object that has most
};

/// Counts brackets and colons outside of strings; right up to the first fault of a text that is no JSON.
Extent extent_of(const std::string& text) {
  Extent extent;
  std::vector<std::size_t> keys{0};  // of all open objects, the text around them first
  bool quoted = false;
  for (std::size_t i = 0; i < text.size() && extent.levels <= kMaxJsonLevels; ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted) {
      if (c == '\\') ++i;
    } else if (c == '{' || c == '[') {
      keys.push_back(0);
      extent.levels = std::max(extent.levels, keys.size() - 1);
    } else if ((c == '}' || c == ']') && keys.size() > 1) {
      keys.pop_back();
    } else if (c == ':') {
      extent.keys = std::max(extent.keys, ++keys.back());
    }
  }
  return extent;
}

}  // namespace

Json parse_json(const std::string& text, const std::string& source, const std::string& allowed) {
  const Extent extent = extent_of(text);
  if (extent.levels > kMaxJsonLevels) {
    throw solver::InputError(
        source, fmt::format("brackets in brackets, more than {} deep; allowed: {}", kMaxJsonLevels, allowed));
  }
  try {
    return extent.keys > kMaxOrderedKeys ? Json(nlohmann::json::parse(text)) : Json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw solver::InputError(source,
                             fmt::format("is not JSON ({}); allowed: {}", solver::shown(error.what()), allowed));
  }
}

Json read_json(const std::filesystem::path& file, const std::string& allowed) {
  return parse_json(solver::read_input_file(file, solver::kLargestJson, allowed), file.string(), allowed);
}

Json find_json(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  try {
    return read_json(file, "a result");
  } catch (const solver::InputError&) {
    return {};
  }
}

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void write_json_file(const std::filesystem::path& file, const Json& json) {
  const std::string content = json_text(json, 1) + "\n";
  if (!has_content(file, content)) solver::write_whole_file(file, content);
}

}  // namespace slipstick::convergence
