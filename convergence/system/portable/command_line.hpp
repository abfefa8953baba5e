#pragma once

#include <filesystem>

namespace slipstick::convergence {

/// The first word of the command line, set by die_with_parent(); empty before.
std::filesystem::path& named_program();

}  // namespace slipstick::convergence
