#pragma once

#include <exception>
#include <string>
#include <string_view>

/// Output of the program's commands: files that options name, and standard output.
namespace slipstick::convergence {

/// Throws InputError, naming the option, where no file can be written at the path; an empty path is none. To
/// be asked before a long solve.
void require_output(const std::string& option, const std::string& path);

/// Writes the file that an option names, as solver::write_whole_file() does; without a path does nothing.
/// Throws InputError naming option and path where it cannot be written.
void write_option_file(const std::string& option, const std::string& path, const std::string& text);

/// The message of an exception; where memory, threads or processes ran out also what to do.
std::string failure_text(const std::exception& error);

/// Makes the numbers of standard input, output and error those of no other file where they are closed: what
/// is written to a closed standard output fails. To be called first.
void hold_standard_streams();

/// A text for people: printable, and without commands to a CI server, such as ::error or ##vso[, which names
/// and reasons in it might hold: their first character is \xNN.
std::string plain_text(std::string_view text);

/// Throws InputError where the text cannot be written, with the system's reason.
void write_standard_output(std::string_view text);

}  // namespace slipstick::convergence
