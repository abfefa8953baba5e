#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

/// The one way in which files are written.
namespace slipstick::solver {

/// Writes a file so that it is either the old one or the whole new one, whenever this process is killed or
/// the machine stops: `write` fills a draft beside it, which goes to the disk and then takes its place. A
/// killed process leaves its draft, which the next writer of the file takes over. A link stays one; what is
/// no plain file, /dev/stdout for one, is written to as it is. Throws InputError where the file cannot be
/// written, with the system's reason and what to do; the file is then the old one.
void write_whole_file(const std::filesystem::path& file, const std::function<void(std::FILE*)>& write);
/// The same; `write` is told the draft's name too.
using WriteNamed = std::function<void(std::FILE*, const std::filesystem::path& draft)>;
void write_whole_named_file(const std::filesystem::path& file, const WriteNamed& write);
void write_whole_file(const std::filesystem::path& file, std::string_view content);
/// The same of a name that is the program's own: what is no plain file there, a link or a pipe, is replaced.
void replace_whole_file(const std::filesystem::path& file, std::string_view content);

/// Where the links of a name lead. Links of the system, such as /dev/stdout, stay: they lead to no name.
std::filesystem::path behind_links(std::filesystem::path file);

/// Makes a folder and those above it. Throws as above.
void make_folder(const std::filesystem::path& folder);

/// Throws as above for a folder that is missing or read-only.
void require_writable(const std::filesystem::path& folder);

/// Throws as above where no file can be written: for a folder, and in one that is missing or read-only. To be
/// asked before a long solve.
void require_place_for(const std::filesystem::path& file);

/// "cannot be written: No space left on device; ...": what a number of the system (errno) says, and what to
/// do.
std::string why_not_written(int error);

}  // namespace slipstick::solver
