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

/// Asks the system for large pages (2 MiB) for the first 512 MiB of the heap, which are addresses and take memory
/// once they are written; and keeps freed blocks in this process: all of this part, and others of up to 16 MiB.
/// Without both, a tenth of a solve is spent on mapping pages and finding them. Reserves nothing where addresses or
/// data of the process are limited. For glibc on Linux; does nothing elsewhere. Called at program start.
void prepare_heap();

/// "512 MiB", "1.5 GiB": three digits.
std::string bytes_text(double bytes);

/// Bytes that may be taken: the limit, or the available memory where there is no limit.
double memory_within(std::optional<double> limit);

}  // namespace slipstick::solver
