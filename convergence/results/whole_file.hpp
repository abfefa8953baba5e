#pragma once

#include <filesystem>
#include <string_view>

namespace slipstick::convergence {

/// Writes a file so that it is either the old one or the whole new one, whenever this process is killed: a
/// draft beside it takes its place. What is no plain file, /dev/stdout for one, or lies where no draft can be
/// made is written to as it is. Drafts of the same file that killed processes left go. Throws
/// std::runtime_error, naming the file, if it cannot be written.
void write_whole_file(const std::filesystem::path& file, std::string_view content);

}  // namespace slipstick::convergence
