#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Text in files that others read.
namespace slipstick::convergence {

/// GitHub cuts a comment off above 64 kB.
inline constexpr std::size_t kMaxMarkdown = 64000;

/// The same bytes where they are UTF-8; U+FFFD for what is not.
std::string as_utf8(const std::string& bytes);

/// Text in XML, between tags or in an attribute: what is markup is escaped, and what XML cannot hold
/// replaced: control characters as printable() has them, what is not UTF-8 by U+FFFD.
std::string xml_text(std::string_view text);

/// A word as a shell takes it, in quotes where it needs them.
std::string shell_word(const std::string& text);

/// Text of users in Markdown, in a cell too: it stays what it is, and is no link, image, mention of a person
/// or an issue, format or HTML; control characters as in XML.
std::string markdown_text(std::string_view text);

/// Markdown of this program's own in a cell of a table.
std::string markdown_cell(std::string_view text);

}  // namespace slipstick::convergence
