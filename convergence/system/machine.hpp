#pragma once

#include <filesystem>
#include <string>

/// Services of the operating system that the C++ library lacks, here and in run_program.hpp. linux/ uses the
/// kernel; portable/, for builds with SLIPSTICK_PORTABLE, uses only the C++ library.
namespace slipstick::convergence {

/// Path of the running executable, empty if unknown. On Linux the path works even after its file was replaced
/// or removed.
std::filesystem::path own_program();

/// The file of the executable as it was named when it started, empty if unknown.
std::filesystem::path own_program_file();

/// Model name of the processor; "unknown" if the system has none.
std::string processor_name();

/// Whether this build starts other programs.
bool starts_programs();

}  // namespace slipstick::convergence
