#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Text in files that others read.
namespace slipstick::convergence {

/// GitHub cuts a comment off above 64 kB.
inline constexpr std::size_t kMaxMarkdown = 64000;

/// The text with U+FFFD for each byte that is not UTF-8.
std::string as_utf8(const std::string& bytes);

/// Text in XML, between tags or in an attribute: markup is escaped; control characters are replaced as by
/// printable(), bytes that are not UTF-8 by U+FFFD.
std::string xml_text(std::string_view text);

/// A word of a shell command, quoted where necessary.
std::string shell_word(const std::string& text);

/// A user's text in Markdown, in a cell too: nothing in it becomes a link, an image, a mention of a person or
/// an issue, formatting or HTML; control characters as in XML.
std::string markdown_text(std::string_view text);

/// This program's own Markdown in a cell of a table.
std::string markdown_cell(std::string_view text);

}  // namespace slipstick::convergence
