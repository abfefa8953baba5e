#pragma once

#include <filesystem>

namespace slipstick::convergence {

/// What the command line calls this program; empty before main() has told.
std::filesystem::path& named_program();

}  // namespace slipstick::convergence
