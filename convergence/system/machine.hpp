#pragma once

#include <filesystem>
#include <string>

/// What the operating system has beside the C++ library, here and in run_program.hpp. linux/ has it from the
/// kernel; portable/ does without, in builds with SLIPSTICK_PORTABLE.
namespace slipstick::convergence {

/// The program that this process runs, on Linux whatever becomes of its file meanwhile; empty: nobody says.
std::filesystem::path own_program();

/// Its file; empty likewise.
std::filesystem::path own_program_file();

/// "unknown" where nobody says.
std::string processor_name();

/// Whether this build starts other programs.
bool starts_programs();

}  // namespace slipstick::convergence
