#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"

/// Drawing is Python's.
namespace slipstick::convergence {

/// A file of the project: where it was installed beside the program, or in the source tree it was built from.
std::filesystem::path project_file(const std::filesystem::path& relative);

/// Runs a script of reports/ and waits. Throws std::runtime_error if no suitable Python was found when the
/// program was built, or if the script fails; the message begins with `done`: what is not lost by that.
void run_report_script(const std::string& script, const std::vector<std::string>& arguments,
                       const std::string& done);

/// Throws InputError unless the ending is one that a figure can have, and its folder exists.
void require_figure_format(const std::filesystem::path& figure);

/// Draws slip and stick, tractions and pressure of a result; write_fields writes its cells to the file it is
/// given. Throws as run_report_script().
void draw_solve(const std::filesystem::path& figure, const Json& result,
                const std::function<void(const std::filesystem::path&)>& write_fields);

/// Draws errors, orders and budget of a study's result. Throws as run_report_script().
void draw_study(const std::filesystem::path& figure, const Json& result);

}  // namespace slipstick::convergence
