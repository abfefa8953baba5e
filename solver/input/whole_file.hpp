#pragma once

#include <concepts>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

/// The one way in which files are written.
namespace slipstick::solver {

/// Writes a file's content to a stream; `draft` is the stream's name.
using WriteNamed = std::function<void(std::FILE*, const std::filesystem::path& draft)>;

/// Replaces a file atomically, also if this process is killed or the machine stops: `write` fills a draft in the same
/// folder, which is flushed to the disk and renamed. The next writer of the file reuses the draft of a killed process.
/// Links are followed; devices and pipes, such as /dev/stdout, are written to directly. Throws InputError with the
/// system's reason and a remedy if the file cannot be written; the old file then stays.
void write_whole_named_file(const std::filesystem::path& file, const WriteNamed& write);
/// The same without the draft's name.
template <std::invocable<std::FILE*> Write>
void write_whole_file(const std::filesystem::path& file, const Write& write) {
  write_whole_named_file(file, [&](std::FILE* stream, const std::filesystem::path&) { write(stream); });
}
void write_whole_file(const std::filesystem::path& file, std::string_view content);
/// The same for a file of the program's own: a link or a pipe of this name is replaced.
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

/// "cannot be written: No space left on device; ...": the system's text for errno, and a remedy.
std::string why_not_written(int error);

}  // namespace slipstick::solver
