#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Text in files that others read.
namespace slipstick::convergence {

/// GitHub cuts a comment off above 64 kB.
inline constexpr std::size_t kMaxMarkdown = 64000;

/// Text in XML, between tags or in an attribute: what is markup is escaped, control characters, which XML
/// cannot hold, are left out.
std::string xml_text(std::string_view text);

/// A word as a shell takes it, in quotes where it needs them.
std::string shell_word(const std::string& text);

/// Text in a cell of a Markdown table.
std::string markdown_cell(std::string_view text);

}  // namespace slipstick::convergence
