#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace slipstick::solver {

/// Sizes in bytes above which a file is taken for a mistake. People write settings, where a history of ten
/// thousand steps fills one megabyte.
inline constexpr std::uintmax_t kLargestSettings = std::uintmax_t{4} << 20;
/// The result of a history of ten thousand steps. A parsed JSON needs up to 25 times the bytes of its text.
inline constexpr std::uintmax_t kLargestJson = std::uintmax_t{128} << 20;
/// Tables of numbers as text: all columns of a contact of five million cells.
inline constexpr std::uintmax_t kLargestTextTable = std::uintmax_t{1} << 30;
/// HDF5 files; only the requested datasets are read.
inline constexpr std::uintmax_t kLargestHdf5 = std::uintmax_t{16} << 30;

/// Throws InputError, naming the file and `allowed` ("a TOML file"), for a folder, a device, a pipe, a file
/// that is missing or may not be read, and one of more than `largest` bytes.
void require_input_file(const std::filesystem::path& file, std::uintmax_t largest, const std::string& allowed);

/// The bytes of such a file, or about the first `most`. Throws as above.
std::string read_input_file(const std::filesystem::path& file, std::uintmax_t largest, const std::string& allowed,
                            std::uintmax_t most = UINTMAX_MAX);

/// Whether a file lies in a folder or below, or would; links are followed.
bool lies_within(const std::filesystem::path& file, const std::filesystem::path& folder);

/// A text that does not steer what shows it: control characters other than tab and end of line as \xNN, those
/// of Unicode that turn the direction of text or end a line as \uNNNN.
std::string printable(std::string_view text);

/// The beginning of a file's text, as a message shows it: bytes other than printable ASCII as \xNN.
std::string shown(std::string_view text);

}  // namespace slipstick::solver
