#pragma once

#include <exception>
#include <string>
#include <string_view>

/// Output of the program's commands: files that options name, and standard output.
namespace slipstick::convergence {

/// Throws InputError, naming the option, where no file can be written at the path; an empty path is valid.
/// Commands call it before a long solve.
void require_output(const std::string& option, const std::string& path);

/// Writes the file that an option names, as solver::write_whole_file() does; without a path does nothing.
/// Throws InputError naming option and path where it cannot be written.
void write_option_file(const std::string& option, const std::string& path, const std::string& text);

/// Adds a text to the end of the file that an option names, as $GITHUB_STEP_SUMMARY needs it; a missing file
/// is made. Otherwise as write_option_file().
void append_option_file(const std::string& option, const std::string& path, const std::string& text);

/// The message of an exception; where memory, threads or processes ran out also what to do.
std::string failure_text(const std::exception& error);

/// Opens /dev/null for each of standard input, output and error that is closed, so that no other file gets
/// its number; writing to a closed standard output fails. main() calls it first.
void hold_standard_streams();

/// A text for people: printable, and without commands to a CI server, such as ::error or ##vso[, which names
/// and reasons might contain: their first character becomes \xNN.
std::string plain_text(std::string_view text);

/// Throws InputError where the text cannot be written, with the system's reason.
void write_standard_output(std::string_view text);

}  // namespace slipstick::convergence
