#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace slipstick::convergence {

/// A file of the project: where it was installed beside the program, or in the source tree it was built from.
std::filesystem::path project_file(const std::filesystem::path& relative);

/// Runs a script of reports/ and waits. Throws std::runtime_error if no suitable Python was found when the
/// program was built, or if the script fails; the message begins with `done`: what is not lost by that.
void run_report_script(const std::string& script, const std::vector<std::string>& arguments,
                       const std::string& done);

}  // namespace slipstick::convergence
