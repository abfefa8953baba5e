#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "solver/input/input_error.hpp"

/// How much memory a solve may take.
namespace slipstick::solver {

/// A scene needs more memory than it may take.
class OutOfMemory : public InputError {
 public:
  using InputError::InputError;
};

/// Bytes that can be had without swapping: of the machine, and of each control group around this process that
/// has a limit. Infinite where nothing says. `root` stands before /proc and /sys.
double available_memory(const std::filesystem::path& root = "/");

/// Keeps freed blocks of up to some MiB in this process, where the C library has a setting for it: returning
/// pages to the system and mapping them again takes a tenth of a quick solve. Called at program start.
void keep_freed_blocks();

/// "512 MiB", "1.5 GiB": three digits.
std::string bytes_text(double bytes);

/// Bytes that may be taken: the limit, or the available memory where there is no limit.
double memory_within(std::optional<double> limit);

}  // namespace slipstick::solver
